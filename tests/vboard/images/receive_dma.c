/*
 * USART1 at 115 200 Bd and a stream of DMA2 that fetches what it has received, from RM0090 10 and 30.3.13 alone. `how`
 * says what is different; the run ends after `ends` turns of 10 000 cycles.
 */
#include "part.h"

#define DMA2 0x40026400u
#define LISR REG(DMA2 + 0x00)
#define HISR REG(DMA2 + 0x04)
#define LIFCR REG(DMA2 + 0x08)
#define STREAM(n, offset) REG(DMA2 + 0x10 + 0x18 * (n) + (offset))
#define CR(n) STREAM(n, 0x00)
#define NDTR(n) STREAM(n, 0x04)
#define PAR(n) STREAM(n, 0x08)
#define M0AR(n) STREAM(n, 0x0C)
#define CR3 REG(USART1 + 0x14)

enum {
    EN = 1,
    CIRC = 1 << 8,
    MINC = 1 << 10,
    HALF_WORDS = 1 << 11 | 1 << 13,
    EIE = 1,
    DMAR = 1 << 6,
    ITEMS = 8,
    TURN = 10000,
    FIRST_WORD = 8, /* of `result`: what is in memory */
};

enum how {
    NORMAL,
    STREAM_5,
    CHANNEL_5,
    ONCE,      /* not circular */
    NO_STREAM, /* nobody fetches */
    NO_DMAR,
    TO_CCM,
    BYTES,
    READS, /* the program ends an error as soon as it sees it */
};

extern const uint32_t how;
const uint32_t how __attribute__((section(".rodata.how"))) = NORMAL;
extern const uint32_t ends;
const uint32_t ends __attribute__((section(".rodata.ends"))) = 20;

static volatile uint16_t ring[ITEMS];
static volatile uint32_t interrupts;
static volatile uint32_t seen;

void usart1_handler(void)
{
    interrupts++;
    seen = USART_SR(USART1);
    if (*(const volatile uint32_t *)&how == READS) {
        (void)USART_DR(USART1);
    } else {
        NVIC_ICER(1) = 1u << (IRQ_USART1 - 32);
    }
}

static void start_stream(uint32_t what)
{
    uint32_t number = what == STREAM_5 ? 5 : 2;
    uint32_t channel = what == CHANNEL_5 ? 5 : 4;
    PAR(number) = (uint32_t)&USART_DR(USART1);
    M0AR(number) = what == TO_CCM ? 0x10000000u : (uint32_t)ring;
    NDTR(number) = ITEMS;
    CR(number) = channel << 25 | MINC | (what == ONCE ? 0u : CIRC) | (what == BYTES ? 0u : HALF_WORDS);
    CR(number) |= what == NO_STREAM ? 0u : EN;
}

static void tell(uint32_t number)
{
    result[0] = NDTR(number);
    result[1] = (number < 4 ? LISR >> 16 : HISR >> 6) & 0x3F;
    result[2] = CR(number) & EN;
    result[3] = interrupts;
    result[4] = seen;
    result[5] = USART_SR(USART1);
    result[6] = USART_DR(USART1);
    result[7] = USART_SR(USART1);
    for (unsigned i = 0; i < ITEMS; i++) {
        result[FIRST_WORD + i] = ring[i];
    }
}

int main(void)
{
    uint32_t what = *(const volatile uint32_t *)&how;
    RCC_AHB1ENR |= 1 | 1u << 22;
    RCC_APB2ENR |= 1u << 4;
    settle();
    GPIO_MODER(GPIOA) = (GPIO_MODER(GPIOA) & ~(0xFu << 18)) | 0xAu << 18; /* PA9 and PA10 */
    GPIO_AFRH(GPIOA) = 0x770;
    start_stream(what);
    USART_BRR(USART1) = 139; /* 16 MHz / 115200 */
    CR3 = what == NO_DMAR ? (uint32_t)EIE : (uint32_t)(EIE | DMAR);
    USART_CR1(USART1) = 1u << 13 | 1u << 2;
    NVIC_ISER(1) = 1u << (IRQ_USART1 - 32);
    for (uint32_t turn = 0; turn < *(const volatile uint32_t *)&ends; turn++) {
        for (uint32_t begin = cycles(); cycles() - begin < TURN;) {
        }
    }
    tell(what == STREAM_5 ? 5 : 2);
    return 0;
}
