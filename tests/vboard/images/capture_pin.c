/*
 * Pulses of TIM5 at PA0, every 100 us, 2.5 us wide, captured by channels 1 (rising) and 2 (falling) of TIM4 at PB6, or
 * of TIM1 at PA8: PWM input mode (RM0090 18.3.6). What is forbidden comes by defines.
 */
#include "part.h"

#ifdef BY_TIM1
#define TIMER 0x40010000u
#define PORT GPIOA
#define PIN 8
#define FUNCTION 1u
#else
#define TIMER 0x40000800u
#define PORT GPIOB
#define PIN 6
#define FUNCTION 2u
#endif
#ifndef PRESCALER
#define PRESCALER 0
#endif
#define RCC_APB2RSTR REG(RCC + 0x24)

enum {
    TIM4EN = 1 << 2,
    TIM5EN = 1 << 3,
    TIM1EN = 1 << 0,
    PORTS = 3,
    PERIOD = 8400,
    WIDTH = 210,
    PULSES = 6,
    CC1IF = 1 << 1,
    CC2IF = 1 << 2,
};

static void make_pulses(void)
{
    GPIO_AFRL(GPIOA) |= 2;
    GPIO_MODER(GPIOA) |= 2;
    TIM_ARR(TIM5) = PERIOD - 1;
    TIM_CCR(TIM5, 1) = WIDTH;
    TIM_CNT(TIM5) = WIDTH; /* the pin rests until the first period begins */
    TIM_CCMR1(TIM5) = 6 << 4;
    TIM_CCER(TIM5) = 1;
    TIM_CR1(TIM5) = 1;
}

static void listen(void)
{
#ifndef OTHER_FUNCTION
    if (PIN < 8) {
        GPIO_AFRL(PORT) |= FUNCTION << 4 * (PIN % 8);
    } else {
        GPIO_AFRH(PORT) |= FUNCTION << 4 * (PIN % 8);
    }
#endif
    GPIO_MODER(PORT) |= 2u << 2 * PIN;
    TIM_CCMR1(TIMER) = 1 | PRESCALER << 2 | 2 << 8;
    TIM_CCER(TIMER) = 1 | 3 << 4;
    TIM_CR1(TIMER) = 1;
}

static void do_what_is_not_modelled(void)
{
#ifdef OUTPUT
    TIM_CCMR2(TIMER) = 6 << 4;
    TIM_CCER(TIMER) = 1 << 8;
#endif
#ifdef INTERRUPT
    TIM_DIER(TIMER) = 2;
#endif
#ifdef SLAVE
    REG(TIMER + 0x08) = 0x54;
#endif
}

int main(void)
{
    run_at_168_mhz();
    RCC_AHB1ENR |= PORTS;
    RCC_APB1ENR |= TIM4EN | TIM5EN;
    RCC_APB2ENR |= TIM1EN;
    settle();
    listen();
    do_what_is_not_modelled();
    make_pulses();
    uint32_t begin = TIM_CNT(TIMER);
    for (int i = 0; i < PULSES; i++) {
        while ((TIM_SR(TIMER) & CC2IF) == 0) {
            if (((TIM_CNT(TIMER) - begin) & 0xFFFF) > 60000) {
                test_end(); /* nothing comes: the counts stay 0 */
            }
        }
        result[2 * i] = TIM_CCR(TIMER, 1);
        result[2 * i + 1] = TIM_CCR(TIMER, 2);
        begin = TIM_CNT(TIMER);
        result[12] = (uint32_t)i + 1;
    }
    result[13] = TIM_SR(TIMER) & 0x606; /* all has been read */
    while (((TIM_CNT(TIMER) - begin) & 0xFFFF) < 50000) {
    }
    result[14] = TIM_SR(TIMER) & 0x606; /* captures that nobody has read */
#ifdef BY_TIM1
    RCC_APB2RSTR |= TIM1EN;
    RCC_APB2RSTR &= ~(uint32_t)TIM1EN;
    result[15] = TIM_CCER(TIMER) | TIM_SR(TIMER);
#endif
    test_end();
    return 0;
}
