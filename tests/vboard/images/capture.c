/*
 * The low-speed oscillator at channel 4 of TIM5: EDGES is CC4P and CC4NP, PRESCALER is IC4PSC. What is forbidden comes
 * by defines.
 */
#include "part.h"

#ifndef EDGES
#define EDGES 0
#endif
#ifndef PRESCALER
#define PRESCALER 0
#endif

enum {
    TIM5EN = 1 << 3,
    LSION = 1 << 0,
    LSIRDY = 1 << 1,
    LSI = 1 << 6,
    CC4S_OWN = 1 << 8,
    CC4E = 1 << 12,
    CC4IF = 1 << 4,
    CC4OF = 1 << 12,
    CAPTURES = 9,
};

static void set_up(void)
{
    RCC_APB1ENR |= TIM5EN;
    settle();
    TIM_OR(TIM5) = LSI;
    TIM_CCMR2(TIM5) = CC4S_OWN | PRESCALER << 10;
    TIM_CCER(TIM5) = CC4E | EDGES << 13;
    TIM_CR1(TIM5) = 1;
}

static void do_what_is_forbidden(void)
{
#ifdef MODE_WHILE_ON
    TIM_CCMR2(TIM5) = 0;
#endif
#ifdef WRITE_CAPTURE
    TIM_CCR(TIM5, 4) = 1;
#endif
#ifdef RESERVED_EDGE
    TIM_CCER(TIM5) = CC4E | 4 << 13;
#endif
#ifdef EDGE_OF_OUTPUT
    TIM_CCER(TIM5) = CC4E | 1 << 3;
#endif
#ifdef OTHER_INPUT
    TIM_CCER(TIM5) = 0;
    TIM_CCMR2(TIM5) = 3 << 8;
#endif
#ifdef FILTER
    TIM_CCMR2(TIM5) = CC4S_OWN | 1 << 12;
#endif
#ifdef OTHER_OSCILLATOR
    TIM_OR(TIM5) = 2 << 6;
#endif
}

static uint32_t next_capture(void)
{
    while ((TIM_SR(TIM5) & CC4IF) == 0) {
    }
    return TIM_CCR(TIM5, 4);
}

int main(void)
{
    run_at_168_mhz();
    set_up();
    do_what_is_forbidden();
    uint32_t begin = TIM_CNT(TIM5);
    while (TIM_CNT(TIM5) - begin < 84000) {
    }
    result[10] = TIM_SR(TIM5); /* the oscillator does not run yet */
    RCC_CSR |= LSION;
    while ((RCC_CSR & LSIRDY) == 0) {
    }
    TIM_SR(TIM5) = 0;
    for (int i = 0; i < CAPTURES; i++) {
        result[i] = next_capture();
    }
    result[11] = TIM_SR(TIM5);
    begin = TIM_CNT(TIM5);
    while (TIM_CNT(TIM5) - begin < 8 * 84000) {
    }
    result[12] = TIM_SR(TIM5);
    (void)TIM_CCR(TIM5, 4);
    result[13] = TIM_SR(TIM5);
    TIM_SR(TIM5) = ~(uint32_t)CC4OF;
    TIM_CCER(TIM5) = 0;
    begin = TIM_CNT(TIM5);
    while (TIM_CNT(TIM5) - begin < 84000) {
    }
    result[14] = TIM_SR(TIM5);
    test_end();
    return 0;
}
