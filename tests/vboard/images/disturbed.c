/*
 * Checksums of work full of IT blocks, branches, divisions and multiple loads, alone and while a timer interrupts at
 * many different places: they must be the same.
 */
#include "part.h"

static volatile uint32_t interrupts;

RAMCODE void tim2_handler(void)
{
    TIM_SR(TIM2) = 0;
    interrupts++;
    TIM_CCR(TIM2, 1) += 53 + interrupts % 7;
}

__attribute__((noipa)) static uint32_t mix(uint32_t seed)
{
    uint32_t table[16];
    uint64_t sum = 0;
    for (uint32_t i = 0; i < 16; i++) {
        table[i] = seed = seed * 1664525 + 1013904223;
    }
    for (uint32_t round = 0; round < 200; round++) {
        for (uint32_t i = 0; i < 16; i++) {
            uint32_t value = table[i];
            uint32_t other = table[(i + round) & 15];
            value = value > other ? value - other : value / (other % 17 + 1);
            value ^= (value & 1) ? 0xEDB88320u : value >> 3;
            if (value % 5 == 2) {
                sum += (uint64_t)value * other;
            } else {
                sum -= round;
            }
            __asm volatile("cmp %0, %1\n ittee hi\n subhi %0, %0, %1\n addhi %2, %2, #1\n addls %0, %0, %1\n"
                           "eorls %2, %2, %0\n"
                           "cmp %2, %1\n it ne\n movne.w %2, %2, ror #3"
                           : "+r"(value), "+r"(other), "+r"(seed)
                           :
                           : "cc");
            table[i] = value + seed;
        }
    }
    return (uint32_t)sum ^ (uint32_t)(sum >> 32);
}

int main(void)
{
    run_at_168_mhz();
    result[0] = mix(1);
    result[1] = mix(2);
    RCC_APB1ENR |= 1;
    settle();
    TIM_CCR(TIM2, 1) = 100;
    TIM_DIER(TIM2) = 2;
    NVIC_ISER(0) = 1u << IRQ_TIM2;
    TIM_CR1(TIM2) = 1;
    result[2] = mix(1);
    result[3] = mix(2);
    result[4] = interrupts;
    return 0;
}
