/* One thing that RM0090 chapter 10 forbids, or that has no sense, by its number; beside them what is allowed. */
#include "dma.h"

extern const uint32_t which;
const uint32_t which __attribute__((section(".rodata.which"))) = 0;

static volatile uint32_t words[4];

static void set_up_with(uint32_t cr)
{
    set_up(5, &TIM_CCR(TIM2, 1), words, 4, cr);
}

static void do_registers(uint32_t number)
{
    switch (number) {
    case 1:
        REG16(DMA1 + 0x14) = 4;
        break;
    case 2:
        (void)REG8(DMA1);
        break;
    case 3:
        DMA_LISR = 0;
        break;
    case 4:
        (void)DMA_LIFCR;
        break;
    case 5:
        DMA_LIFCR = 2;
        break;
    case 6:
        DMA_CR(5) = 1u << 20;
        break;
    case 7:
        DMA_NDTR(5) = 0x10000;
        break;
    case 8:
        DMA_FCR(5) = 1u << 6;
        break;
    case 9:
        (void)REG(DMA1 + 0xD0);
        break;
    case 10:
        RCC_AHB1ENR &= ~(1u << 21);
        (void)DMA_LISR;
        break;
    case 11:
        DMA_FCR(5) = DMA_FCR(5); /* FS is read-only */
        break;
    default:
        break;
    }
}

static void do_enabled(uint32_t number)
{
    set_up_with(CHSEL(3) | CR_WORDS);
    enable(5);
    switch (number) {
    case 20:
        DMA_NDTR(5) = 4;
        break;
    case 21:
        DMA_M0AR(5) = (uint32_t)words;
        break;
    case 22:
        DMA_PAR(5) = 0x40000034;
        break;
    case 23:
        DMA_CR(5) |= CR_CIRC;
        break;
    case 24:
        DMA_FCR(5) |= FCR_DMDIS;
        break;
    case 25:
        DMA_CR(5) &= ~(uint32_t)CR_EN;
        DMA_CR(5) |= CR_EN;
        break;
    case 26:
        DMA_CR(5) |= CR_TCIE | CR_HTIE;
        DMA_FCR(5) |= FCR_FEIE;
        break;
    case 27:
    case 28:
        TIM_DIER(TIM2) = DIER_CC1DE;
        wait_cycles(20);
        ask(EGR_CH1);
        DMA_CR(5) &= ~(uint32_t)CR_EN;
        wait_cycles(20);
        if (number == 27) {
            clear_flags(5); /* NDTR is not written */
        } else {
            DMA_NDTR(5) = 3; /* the flags are not cleared */
        }
        enable(5);
        break;
    case 29:
        DMA_M1AR(5) = 0;
        break;
    default:
        break;
    }
}

static void do_settings(uint32_t number)
{
    static const uint32_t settings[] = {
        CHSEL(3) | CR_PSIZE_WORD,                    /* allowed: from the peripheral */
        CHSEL(3) | 2u << 6 | CR_PSIZE_WORD,          /* memory to memory */
        CHSEL(3) | 3u << 6 | CR_PSIZE_WORD,          /* no direction */
        CHSEL(3) | CR_WORDS | 1u << 5,               /* flow controller */
        CHSEL(3) | CR_WORDS | 1u << 18,              /* double buffer */
        CHSEL(3) | CR_TO_PERIPHERAL | 3u << 11,      /* no size */
        CHSEL(4) | CR_WORDS,                         /* USART2_RX */
        CHSEL(3) | CR_TO_PERIPHERAL | CR_PSIZE_WORD, /* allowed: MINC is 0 */
        CHSEL(3) | CR_WORDS | 1u << 23 | 3u << 13,   /* allowed: direct mode looks at neither burst nor MSIZE */
    };
    set_up_with(settings[number - 40]);
    enable(5);
}

static void do_fifo(uint32_t number)
{
    DMA_FCR(5) = FCR_DMDIS;
    set_up_with(CHSEL(3) | CR_WORDS);
    switch (number) {
    case 60:
        DMA_CR(5) = CHSEL(3) | CR_WORDS | 1u << 23; /* a burst */
        break;
    case 61:
        DMA_CR(5) = CHSEL(3) | CR_TO_PERIPHERAL | CR_PSIZE_HALF | CR_MSIZE_WORD;
        DMA_NDTR(5) = 3;
        break;
    case 62:
        DMA_M0AR(5) = (uint32_t)words + 2;
        break;
    case 63:
        DMA_CR(5) = CHSEL(3) | CR_PSIZE_WORD | CR_MSIZE_WORD; /* from the peripheral */
        break;
    default:
        break;
    }
    enable(5);
}

static void do_writes(uint32_t number)
{
    static const uint32_t targets[] = {0x40000034, 0x40000034, 0x40006000, 0x40000834}; /* 83: TIM4, without clock */
    TIM_DIER(TIM2) = DIER_CC1DE;
    set_up_with(CHSEL(3) | CR_TO_PERIPHERAL | (number == 80 ? 0u : CR_PSIZE_HALF));
    DMA_PAR(5) = targets[number - 80];
    enable(5);
    wait_cycles(20);
    ask(EGR_CH1);
}

int main(void)
{
    uint32_t number = *(const volatile uint32_t *)&which;
    switch_on();
    if (number < 20) {
        do_registers(number);
    } else if (number < 40) {
        do_enabled(number);
    } else if (number < 60) {
        do_settings(number);
    } else if (number < 80) {
        do_fifo(number);
    } else {
        do_writes(number);
    }
    (void)TIM_CR1(TIM2);
    result[0] = 1;
    return 0;
}
