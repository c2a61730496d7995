#include "reserved.h"

#include <stddef.h>

/* Registers in a row, `stride` bytes apart from one instance to the next, and the bits that may be written. */
struct row {
    uint32_t base;
    uint16_t stride;
    uint8_t instances;
    uint16_t first; /* offset of the first register, and of the last one */
    uint16_t last;
    uint32_t usable;
};

#define TIM2_BASE UINT32_C(0x40000000)
#define TIM3_BASE UINT32_C(0x40000400)
#define IWDG_BASE UINT32_C(0x40003000)
#define USART2_BASE UINT32_C(0x40004400)
#define USART1_BASE UINT32_C(0x40011000)
#define SYSCFG_BASE UINT32_C(0x40013800)
#define GPIOA_BASE UINT32_C(0x40020000)
#define FLASH_BASE UINT32_C(0x40023C00)
#define DMA1_BASE UINT32_C(0x40026000)
#define DMA2_BASE UINT32_C(0x40026400)
#define CORE_BASE UINT32_C(0xE000E000)

#define USART(base, instances)                                                                                         \
    {base, 0x400, instances, 0x04, 0x04, 0x1FF},      /* DR */                                                         \
        {base, 0x400, instances, 0x08, 0x08, 0xFFFF}, /* BRR */                                                        \
        {base, 0x400, instances, 0x0C, 0x0C, 0xBFFF}, /* CR1 */                                                        \
        {base, 0x400, instances, 0x10, 0x10, 0x7F6F}, /* CR2 */                                                        \
        {base, 0x400, instances, 0x14, 0x14, 0xFFF},  /* CR3 */                                                        \
        {base, 0x400, instances, 0x18, 0x18, 0xFFFF}  /* GTPR */

#define DMA(base)                                                                                                      \
    {base, 0, 1, 0x08, 0x0C, 0x0F7D0F7D},        /* LIFCR, HIFCR */                                                    \
        {base, 0x18, 8, 0x10, 0x10, 0x0FEFFFFF}, /* SxCR */                                                            \
        {base, 0x18, 8, 0x14, 0x14, 0xFFFF},     /* SxNDTR */                                                          \
        {base, 0x18, 8, 0x24, 0x24, 0xBF}        /* SxFCR */

static const struct row rows[] = {
    /* RM0090 section 18.4; a status register is written with ones wherever nothing is to be cleared. */
    {TIM2_BASE, 0x400, 4, 0x00, 0x00, 0x3FF},  /* CR1 */
    {TIM2_BASE, 0x400, 4, 0x04, 0x04, 0xF8},   /* CR2 */
    {TIM2_BASE, 0x400, 4, 0x0C, 0x0C, 0x5F5F}, /* DIER */
    {TIM2_BASE, 0x400, 4, 0x14, 0x14, 0x5F},   /* EGR */
    {TIM2_BASE, 0x400, 4, 0x18, 0x1C, 0xFFFF}, /* CCMR1, CCMR2 */
    {TIM2_BASE, 0x400, 4, 0x20, 0x20, 0xBBBB}, /* CCER */
    {TIM2_BASE, 0x400, 4, 0x28, 0x28, 0xFFFF}, /* PSC */
    {TIM3_BASE, 0x400, 2, 0x24, 0x24, 0xFFFF}, /* CNT, ARR, CCR of 16 bits */
    {TIM3_BASE, 0x400, 2, 0x2C, 0x40, 0xFFFF},
    /* 21.4 */
    {IWDG_BASE, 0, 1, 0x00, 0x00, 0xFFFF}, /* KR */
    {IWDG_BASE, 0, 1, 0x04, 0x04, 7},      /* PR */
    {IWDG_BASE, 0, 1, 0x08, 0x08, 0xFFF},  /* RLR */
    /* 30.6 */
    USART(USART2_BASE, 2),
    USART(USART1_BASE, 1),
    /* 9.2 */
    {SYSCFG_BASE, 0, 1, 0x00, 0x00, 3},          /* MEMRMP */
    {SYSCFG_BASE, 0, 1, 0x04, 0x04, 0x00800000}, /* PMC */
    {SYSCFG_BASE, 0, 1, 0x08, 0x14, 0xFFFF},     /* EXTICR1 to 4 */
    /* 8.4 */
    {GPIOA_BASE, 0x400, 9, 0x04, 0x04, 0xFFFF}, /* OTYPER */
    {GPIOA_BASE, 0x400, 9, 0x14, 0x14, 0xFFFF}, /* ODR */
    /* 3.9 */
    {FLASH_BASE, 0, 1, 0x00, 0x00, 0x1F07},     /* ACR */
    {FLASH_BASE, 0, 1, 0x0C, 0x0C, 0x000100F3}, /* SR */
    {FLASH_BASE, 0, 1, 0x10, 0x10, 0x8301037F}, /* CR */
    {FLASH_BASE, 0, 1, 0x14, 0x14, 0x0FFFFFEF}, /* OPTCR */
    /* 10.5; FS of FCR is read-only, and written as it was read */
    DMA(DMA1_BASE),
    DMA(DMA2_BASE),
    /* PM0214 4.5, 4.3 (82 interrupts, four bits of priority) and 4.4 */
    {CORE_BASE, 0, 1, 0x010, 0x010, 0x00010007}, /* SysTick: CTRL */
    {CORE_BASE, 0, 1, 0x014, 0x014, 0x00FFFFFF}, /* LOAD */
    {CORE_BASE, 0x80, 4, 0x108, 0x108, 0x3FFFF}, /* NVIC: ISER2, ICER2, ISPR2, ICPR2 */
    {CORE_BASE, 0, 1, 0x400, 0x44C, 0xF0F0F0F0}, /* IPR */
    {CORE_BASE, 0, 1, 0x450, 0x450, 0x0000F0F0},
    {CORE_BASE, 0, 1, 0xD04, 0xD04, 0x9E000000}, /* ICSR */
    {CORE_BASE, 0, 1, 0xD08, 0xD08, 0x3FFFFE00}, /* VTOR: the table is aligned to its 98 words */
    {CORE_BASE, 0, 1, 0xD0C, 0xD0C, 0xFFFF8704}, /* AIRCR; bits 0 and 1 are for debuggers */
    {CORE_BASE, 0, 1, 0xD10, 0xD10, 0x16},       /* SCR */
    {CORE_BASE, 0, 1, 0xD14, 0xD14, 0x31B},      /* CCR */
    {CORE_BASE, 0, 1, 0xD18, 0xD18, 0x00F0F0F0}, /* SHPR1 to 3 */
    {CORE_BASE, 0, 1, 0xD1C, 0xD1C, 0xF0000000},
    {CORE_BASE, 0, 1, 0xD20, 0xD20, 0xF0F00000},
    {CORE_BASE, 0, 1, 0xD24, 0xD24, 0x0007FD8B}, /* SHCSR */
    {CORE_BASE, 0, 1, 0xF00, 0xF00, 0x1FF},      /* STIR */
};

static uint32_t find(const struct row *row, uint32_t word)
{
    for (unsigned i = 0; i < row->instances; i++) {
        uint32_t offset = word - row->base - i * row->stride;
        if (offset >= row->first && offset <= row->last) {
            return ~row->usable;
        }
    }
    return 0;
}

uint32_t reserved_bits(uint32_t address)
{
    uint32_t bits = 0;
    for (unsigned i = 0; i < sizeof rows / sizeof *rows && bits == 0; i++) {
        bits = find(&rows[i], address & ~UINT32_C(3));
    }
    return bits;
}
