/*
 * The internal reference, converted by ADC1. What is forbidden comes by defines.
 */
#include "part.h"

#ifndef DIVIDE
#define DIVIDE 1 /* by 4: 21 MHz */
#endif
#ifndef SAMPLING
#define SAMPLING 7 /* 480 cycles */
#endif
#ifndef CHANNEL
#define CHANNEL 17
#endif

enum {
    ADC1EN = 1 << 8,
    ADON = 1 << 0,
    SWSTART = 1 << 30,
    TSVREFE = 1 << 23,
    EOC = 1 << 1,
};

#define VREFIN_CAL REG16(0x1FFF7A2Au)

static void wait_us(uint32_t microseconds)
{
    uint32_t begin = cycles();
    while (cycles() - begin < 168 * microseconds) {
    }
}

static void set_up(void)
{
    RCC_APB2ENR |= ADC1EN;
    settle();
    ADC_CCR = DIVIDE << 16;
#ifndef WITHOUT_REFERENCE
    ADC_CCR = TSVREFE | DIVIDE << 16;
#endif
#ifndef REFERENCE_TOO_SOON
    wait_us(10);
#endif
    ADC_SMPR1 = SAMPLING << 21;
    ADC_SQR3 = CHANNEL;
#ifndef OFF
    ADC_CR2 = ADON;
#endif
#ifndef TOO_SOON
    wait_us(3);
#endif
}

int main(void)
{
    run_at_168_mhz();
    start_counting_cycles();
    set_up();
#ifdef INTERRUPT
    ADC_CR1 = 1 << 5;
#endif
#ifdef HALF_WORD
    REG16(ADC1 + 0x08) = ADON;
#endif
    result[2] = ADC_SR;
    uint32_t begin = cycles();
    ADC_CR2 = ADON | SWSTART;
#ifdef WHILE_RUNNING
    ADC_CR2 = ADON | SWSTART;
#endif
    result[3] = ADC_SR;
    while ((ADC_SR & EOC) == 0) {
    }
    result[4] = cycles() - begin;
    result[0] = ADC_DR;
    result[5] = ADC_SR;
    result[1] = VREFIN_CAL;
    ADC_SR = 0;
    result[6] = ADC_SR;
    test_end();
    return 0;
}
