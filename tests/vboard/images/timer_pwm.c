/*
 * TIM2 and its outputs, each case after RM0090 sections 18.3.8 to 18.3.10 and 18.4: the counter goes on every 10 us, so
 * that the pin can be looked at between two ticks. PA0 to PA3 are the channels.
 */
#include "part.h"

enum {
    FROZEN,
    ACTIVE,
    INACTIVE,
    TOGGLE,
    LOW,
    HIGH,
    PWM1,
    PWM2,
    PRELOAD = 1 << 3,
    FLAG1 = 2
};

static unsigned results;

static inline void note(uint32_t value)
{
    result[results++] = value;
}

static inline void mode(unsigned of_channel_1)
{
    TIM_CCMR1(TIM2) = of_channel_1 << 4;
}

static inline void note_pin(void)
{
    (void)TIM_CR1(TIM2); /* what was written before has arrived */
    note(GPIO_IDR(GPIOA) & 1);
}

static inline void wait_for(uint32_t count)
{
    while (TIM_CNT(TIM2) != count) {
    }
}

static inline void start(uint32_t last)
{
    RCC_AHB1ENR |= 1;
    RCC_APB1ENR |= 1;
    settle();
    GPIO_MODER(GPIOA) = (GPIO_MODER(GPIOA) & ~0xFFu) | 0xAA;
    GPIO_AFRL(GPIOA) = 0x1111;
    TIM_PSC(TIM2) = 159;
    TIM_ARR(TIM2) = last;
    TIM_EGR(TIM2) = 1;
    TIM_SR(TIM2) = 0;
    TIM_CCER(TIM2) = 1;
}

static inline void run(void)
{
    TIM_CR1(TIM2) |= 1;
}

#if defined EDGES
/* Two channels of each mode, one of them upside down, so that both edges are rising ones somewhere. */
int main(void)
{
    start(99);
    for (unsigned i = 1; i <= 4; i++) {
        TIM_CCR(TIM2, i) = 40;
    }
    TIM_CCMR1(TIM2) = PWM1 << 4 | PWM1 << 12;
    TIM_CCMR2(TIM2) = PWM2 << 4 | PWM2 << 12;
    TIM_CCER(TIM2) = 1 | 3 << 4 | 1 << 8 | 3 << 12;
    run();
    for (unsigned i = 0; i < 3; i++) {
        wait_for(99);
        wait_for(50);
    }
    return 0;
}
#elif defined ENDS
/* Compare values of 0, of ARR and above ARR. */
int main(void)
{
    static const uint32_t values[] = {0, 99, 100, 500};
    start(99);
    for (unsigned i = 1; i <= 4; i++) {
        TIM_CCR(TIM2, i) = values[i - 1];
    }
    TIM_CCMR1(TIM2) = PWM1 << 4 | PWM1 << 12;
    TIM_CCMR2(TIM2) = PWM1 << 4 | PWM1 << 12;
    TIM_CCER(TIM2) = 0x1111;
    run();
    wait_for(50);
    note(GPIO_IDR(GPIOA) & 0xF);
    note(TIM_SR(TIM2) & 0x1E);
    wait_for(99);
    note(GPIO_IDR(GPIOA) & 0xF);
    note(TIM_SR(TIM2) & 0x1E);
    wait_for(0);
    note(GPIO_IDR(GPIOA) & 0xF);
    note(TIM_SR(TIM2) & 0x1F);
    return 0;
}
#elif defined MOVES
/* PWM mode 2, a free-running counter: the value is written ahead of the counter and after it. */
int main(void)
{
    start(0xFFFFFFFF);
    TIM_CCR(TIM2, 1) = 20;
    mode(PWM2);
    note_pin();
    run();
    wait_for(19);
    note_pin();
    wait_for(20);
    note_pin();
    note(TIM_SR(TIM2) & FLAG1);
    TIM_SR(TIM2) = ~(uint32_t)FLAG1;
    TIM_CCR(TIM2, 1) = 40; /* ahead: low at once */
    note_pin();
    wait_for(39);
    note_pin();
    wait_for(40);
    note_pin();
    TIM_SR(TIM2) = ~(uint32_t)FLAG1;
    TIM_CCR(TIM2, 1) = 60;
    note_pin();
    TIM_CCR(TIM2, 1) = 30; /* after: high at once, and no match */
    note_pin();
    note(TIM_SR(TIM2) & FLAG1);
    TIM_CCR(TIM2, 1) = 60;
    wait_for(50);
    TIM_CCR(TIM2, 1) = 50; /* equal: high at once */
    note_pin();
    note(TIM_SR(TIM2) & FLAG1);
    TIM_CCR(TIM2, 1) = 10;
    TIM_CNT(TIM2) = 0; /* the counter goes back: low */
    note_pin();
    wait_for(10);
    note_pin();
    TIM_CNT(TIM2) = 0xFFFFFFFE;
    note_pin();
    wait_for(0); /* it turns over: low */
    note_pin();
    return 0;
}
#elif defined FORCED
/* From one mode to another while the counter stands. */
int main(void)
{
    start(0xFFFFFFFF);
    TIM_CCR(TIM2, 1) = 20;
    mode(HIGH);
    note_pin();
    mode(FROZEN); /* keeps it */
    note_pin();
    mode(PWM2); /* from frozen: the comparison at once */
    note_pin();
    TIM_CNT(TIM2) = 30;
    note_pin();
    mode(LOW);
    note_pin();
    mode(PWM2); /* the comparison has not changed: still low, by the manual */
    note_pin();
    TIM_CCR(TIM2, 1) = 40;
    TIM_CCR(TIM2, 1) = 20;
    note_pin();
    mode(LOW);
    mode(FROZEN);
    mode(PWM2);
    note_pin();
    mode(PWM1);
    mode(FROZEN);
    mode(PWM1);
    note_pin();
    return 0;
}
#elif defined MATCHES
/* The modes that wait for a match, and what a match is. */
int main(void)
{
    start(0xFFFFFFFF);
    mode(ACTIVE);
    TIM_CCR(TIM2, 1) = 10;
    run();
    wait_for(9);
    note_pin();
    wait_for(10);
    note_pin();
    mode(INACTIVE);
    TIM_CCR(TIM2, 1) = 20;
    note_pin();
    wait_for(20);
    note_pin();
    mode(TOGGLE);
    TIM_CCR(TIM2, 1) = 30;
    wait_for(30);
    note_pin();
    TIM_CCR(TIM2, 1) = 40;
    wait_for(40);
    note_pin();
    mode(FROZEN);
    TIM_SR(TIM2) = 0;
    TIM_CCR(TIM2, 1) = 50;
    wait_for(50);
    note_pin();
    note(TIM_SR(TIM2) & FLAG1); /* frozen and forced channels match all the same */
    TIM_SR(TIM2) = 0;
    mode(HIGH);
    TIM_CCR(TIM2, 1) = 60;
    wait_for(60);
    note(TIM_SR(TIM2) & FLAG1);
    mode(TOGGLE);
    TIM_SR(TIM2) = 0;
    TIM_EGR(TIM2) = FLAG1; /* the flag by software */
    note(TIM_SR(TIM2) & FLAG1);
    TIM_CCER(TIM2) = 3;
    note_pin(); /* active low */
    TIM_CCER(TIM2) = 0;
    note_pin();
    return 0;
}
#elif defined PRELOADED
/* Preload of compare values and of the period; events without update. */
int main(void)
{
    start(99);
    TIM_CCMR1(TIM2) = PWM2 << 4 | PRELOAD;
    TIM_CCR(TIM2, 1) = 20;
    TIM_EGR(TIM2) = 1;
    run();
    wait_for(30);
    note_pin();
    TIM_CCR(TIM2, 1) = 60;
    note_pin(); /* not yet in force */
    note(TIM_CCR(TIM2, 1));
    wait_for(10);
    wait_for(30);
    note_pin();
    TIM_CCR(TIM2, 1) = 20;
    note_pin();
    TIM_CCMR1(TIM2) = PWM2 << 4; /* without preload: at once */
    note_pin();
    TIM_CR1(TIM2) |= 1 << 7; /* ARPE */
    TIM_ARR(TIM2) = 49;
    wait_for(60); /* the old period still */
    note(TIM_ARR(TIM2));
    wait_for(0);
    wait_for(49);
    wait_for(0);
    note(TIM_SR(TIM2) & 1);
    TIM_SR(TIM2) = 0;
    TIM_CR1(TIM2) |= 1 << 1; /* UDIS: no update */
    wait_for(49);
    wait_for(0);
    note(TIM_SR(TIM2) & 1);
    TIM_CR1(TIM2) = 1 | 1 << 2; /* URS: an update by software sets no flag */
    TIM_EGR(TIM2) = 1;
    note(TIM_SR(TIM2) & 1);
    return 0;
}
#elif defined STOPS
/* One pulse, by overflow and by software, and a period of 0. */
int main(void)
{
    start(9);
    TIM_CCR(TIM2, 1) = 5;
    mode(PWM2);
    TIM_CR1(TIM2) = 1 << 3 | 1;
    while ((TIM_CR1(TIM2) & 1) != 0) {
    }
    note(TIM_CNT(TIM2));
    note_pin();
    TIM_CR1(TIM2) = 1 << 3 | 1;
    TIM_EGR(TIM2) = 1;
    note(TIM_CR1(TIM2) & 1);
    TIM_CR1(TIM2) = 0;
    TIM_ARR(TIM2) = 0;
    run();
    uint32_t before = cycles();
    while (cycles() - before < 3200) {
    }
    note(TIM_CNT(TIM2));
    return 0;
}
#elif defined READS
/* What a read of the counter costs, and that it shows the counter at its end. */
int main(void)
{
    start(0xFFFFFFFF);
    TIM_PSC(TIM2) = 0;
    TIM_EGR(TIM2) = 1;
    run();
    uint32_t first;
    uint32_t second;
    __asm volatile("ldr %0, [%2]\n\t"
                   "nop\n\t"
                   "ldr %1, [%2]\n\t"
                   : "=&r"(first), "=&r"(second)
                   : "r"(&TIM_CNT(TIM2)));
    note(second - first);
    return 0;
}
#endif
