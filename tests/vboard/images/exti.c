/* External interrupts, by RM0090 chapters 9.2 and 12. Levels of pins come from their pull resistors. */
#include "part.h"

static volatile uint32_t taken; /* numbers of the exceptions, the last in the lowest byte */
static volatile uint32_t count;
static volatile uint32_t seen; /* EXTI_PR in the handler */

static void take(void)
{
    seen = EXTI_PR;
    taken = taken << 8 | (SCB_ICSR & 0xFF);
    count++;
    EXTI_PR = seen;
    (void)EXTI_PR; /* so that the line is low at the return */
}

#define HANDLER(name)                                                                                                  \
    void name##_handler(void)                                                                                          \
    {                                                                                                                  \
        take();                                                                                                        \
    }
HANDLER(exti0)
HANDLER(exti1)
HANDLER(exti2)
HANDLER(exti3)
HANDLER(exti4)
HANDLER(exti9_5)
HANDLER(exti15_10)

static void set_pin(uint32_t port, unsigned pin, unsigned level)
{
    uint32_t others = GPIO_PUPDR(port) & ~(3u << 2 * pin);
    GPIO_PUPDR(port) = others | (level ? 1u : 2u) << 2 * pin;
    __asm volatile("dsb\n nop\n nop\n nop\n nop");
}

static void pulse(uint32_t port, unsigned pin)
{
    set_pin(port, pin, 1);
    set_pin(port, pin, 0);
}

/* After it nothing is pending and no line is in use. */
static uint32_t begin(void)
{
    EXTI_IMR = 0;
    EXTI_RTSR = 0;
    EXTI_FTSR = 0;
    EXTI_PR = 0xFFFF;
    (void)EXTI_PR;
    taken = 0;
    count = 0;
    return EXTI_PR;
}

static void triggers(void)
{
    result[0] = SYSCFG_EXTICR(1);
    SYSCFG_EXTICR(1) = 2 << 4; /* line 5 to port C */
    EXTI_IMR = 1 << 5;
    EXTI_RTSR = 1 << 5;
    set_pin(GPIOC, 5, 1);
    result[1] = count;
    set_pin(GPIOC, 5, 0);
    result[2] = count;
    EXTI_RTSR = 0;
    EXTI_FTSR = 1 << 5;
    set_pin(GPIOC, 5, 1);
    result[3] = count;
    set_pin(GPIOC, 5, 0);
    result[4] = count;
    EXTI_RTSR = 1 << 5;
    pulse(GPIOC, 5);
    result[5] = count;
    result[6] = seen;
    pulse(GPIOA, 5); /* another port, another pin */
    pulse(GPIOC, 6);
    result[7] = count;
}

static void masks(void)
{
    EXTI_RTSR = 1 << 5;
    pulse(GPIOC, 5);
    result[8] = count;
    result[9] = EXTI_PR;
    EXTI_PR = 1 << 4;
    result[10] = EXTI_PR;
    EXTI_IMR = 1 << 5;
    __asm volatile("dsb\n nop\n nop\n nop\n nop");
    result[11] = count;
    result[12] = EXTI_PR;
}

static void vectors_of_lines(void)
{
    EXTI_RTSR = 0xFFFF;
    EXTI_IMR = 0xFFFF;
    static const uint8_t lines[] = {1, 2, 3, 4, 5, 9, 10, 15};
    SYSCFG_EXTICR(0) = 0x2222;
    SYSCFG_EXTICR(1) = 0x2222;
    SYSCFG_EXTICR(2) = 0x2222;
    SYSCFG_EXTICR(3) = 0x2222;
    pulse(GPIOC, 0);
    result[13] = taken;
    for (unsigned i = 0; i < 8; i++) {
        pulse(GPIOC, lines[i]);
        result[i < 4 ? 14 : 15] = taken;
    }
}

static void software(void)
{
    EXTI_SWIER = 1 << 3; /* masked */
    result[16] = EXTI_PR;
    EXTI_PR = 1 << 3;
    EXTI_SWIER = 0;
    EXTI_IMR = 1 << 3;
    EXTI_SWIER = 1 << 3;
    __asm volatile("dsb\n nop\n nop\n nop\n nop");
    result[17] = count;
    result[18] = EXTI_SWIER; /* cleared with the bit in PR */
}

static void routing(void)
{
    SYSCFG_EXTICR(0) = 0;
    set_pin(GPIOC, 0, 1);
    set_pin(GPIOA, 0, 0);
    EXTI_RTSR = 1;
    EXTI_IMR = 1;
    SYSCFG_EXTICR(0) = 2; /* from a low pin to a high one */
    __asm volatile("dsb\n nop\n nop\n nop\n nop");
    result[19] = count;
    GPIO_MODER(GPIOC) = 3; /* analog: the line falls, and rises with the next mode */
    GPIO_MODER(GPIOC) = 0;
    __asm volatile("dsb\n nop\n nop\n nop\n nop");
    result[20] = count;
}

int main(void)
{
    RCC_AHB1ENR |= 5;
    RCC_APB2ENR |= 1u << 14;
    settle();
    GPIO_MODER(GPIOC) = 0;
    NVIC_ISER(0) = 0x1Fu << IRQ_EXTI0 | 1u << IRQ_EXTI9_5;
    NVIC_ISER(1) = 1u << (IRQ_EXTI15_10 - 32);
    triggers();
    begin();
    masks();
    begin();
    vectors_of_lines();
    result[21] = begin();
    software();
    begin();
    routing();
#ifdef LINE_17
    EXTI_IMR = 1 << 17;
#endif
#ifdef PORT_9
    SYSCFG_EXTICR(0) = 9;
#endif
#ifdef EVENTS
    EXTI_EMR = 1;
#endif
#ifdef NO_REGISTER
    EXTI_PR = REG(EXTI + 0x18);
#endif
    return 0;
}
