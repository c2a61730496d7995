/*
 * When a write to the slow bus acts, at 168 MHz. Channel 1 of TIM2 is forced high by a store, and a port on the fast
 * bus looks at the pin in the cycles after it; the same for a pin of the port itself. Then an interrupt whose flag is
 * cleared by the last instruction but one of its handler.
 */
#include "part.h"

#define LOOK(n) "ldr r" #n ", [r2]\n\t"

/* Stores a value, looks at bit 0 ten times in a row, and gives how often it was low. */
uint32_t count_low(volatile uint32_t *where, uint32_t value, volatile uint32_t *port);
__asm__(".pushsection .ramcode, \"ax\"\n.thumb_func\ncount_low:\n\t"
        "push {r4-r11, lr}\n\t"
        "mov lr, r0\n\t"
        "nop\n\t"
        "str r1, [lr]\n\t" LOOK(0) LOOK(1) LOOK(3) LOOK(4) LOOK(5) LOOK(6) LOOK(7) LOOK(8) LOOK(9)
            LOOK(10) "add r0, r0, r1\n\tadd r0, r0, r3\n\tadd r0, r0, r4\n\tadd r0, r0, r5\n\tadd r0, r0, r6\n\t"
                     "add r0, r0, r7\n\tadd r0, r0, r8\n\tadd r0, r0, r9\n\tadd r0, r0, r10\n\t"
                     "and r0, r0, #15\n\trsb r0, r0, #10\n\t" /* of the port only pin 0 has a bit that low */
                     "pop {r4-r11, pc}\n.popsection\n");

static volatile uint32_t served;

/* It ends with BX, as it has no frame of its own. */
RAMCODE __attribute__((naked)) void tim2_handler(void)
{
    __asm volatile("ldr r1, [%0]\n\t"
                   "adds r1, r1, #1\n\t"
                   "str r1, [%0]\n\t"
                   "mov.w r2, #0x40000000\n\t"
                   "movs r1, #0\n\t"
                   "str r1, [r2, #0x10]\n\t" /* TIM2_SR */
#ifdef BARRIER
                   "dsb\n\t"
#endif
                   "bx lr\n\t" ::"r"(&served));
}

int main(void)
{
    run_at_168_mhz();
    RCC_AHB1ENR |= 1;
    RCC_APB1ENR |= 1;
    GPIO_MODER(GPIOA) = (GPIO_MODER(GPIOA) & ~0xFu) | 2; /* PA0 alternate */
    GPIO_AFRL(GPIOA) = 1;                                /* TIM2 */
    TIM_CCER(TIM2) = 1;
    TIM_CCMR1(TIM2) = 4 << 4; /* forced low */
    (void)TIM_CCMR1(TIM2);
    result[0] = count_low(&TIM_CCMR1(TIM2), 5 << 4, &GPIO_IDR(GPIOA)); /* forced high */
    TIM_CCR(TIM2, 2) = 1234;
    result[1] = TIM_CCR(TIM2, 2);

    GPIO_MODER(GPIOA) = (GPIO_MODER(GPIOA) & ~0xFu) | 1; /* PA0 output, low */
    result[2] = count_low(&GPIO_BSRR(GPIOA), 1, &GPIO_IDR(GPIOA));

    TIM_CCR(TIM2, 2) = 4321; /* on its way when the port is written: that acts first */
    result[3] = count_low(&GPIO_BSRR(GPIOA), 1, &GPIO_IDR(GPIOA));

    NVIC_ISER(0) = 1u << IRQ_TIM2;
    TIM_DIER(TIM2) = 1;
    TIM_EGR(TIM2) = 1;
    for (volatile unsigned i = 0; i < 100; i++) {
    }
    result[4] = served;
    return 0;
}
