/* Feeds the watchdog a while, then not any more. What is in .noinit survives a reset. */
#include "part.h"

__attribute__((section(".noinit"))) volatile uint32_t runs; /* how often main was reached */
__attribute__((section(".noinit"))) volatile uint32_t flags[4][2];

int main(void)
{
    uint32_t cause = RCC_CSR;
    if ((cause & 1u << 27) != 0) { /* power-on */
        runs = 0;
    }
    RCC_CSR |= 1u << 24; /* RMVF */
    flags[runs][0] = cause;
    flags[runs][1] = RCC_CSR;
    runs++;
    if (runs == 2) {
        SCB_AIRCR = 0x05FA0004;
        for (;;) {
        }
    }
    if (runs == 3) {
        return 0;
    }
    IWDG_KR = 0xCCCC;
    IWDG_KR = 0x5555;
    IWDG_PR = 0;   /* / 4 */
    IWDG_RLR = 79; /* 80 periods of 125 us: 10 ms */
    while (IWDG_SR != 0) {
    }
    IWDG_KR = 0xAAAA;
    for (unsigned i = 0; i < 20; i++) {
        uint32_t before = cycles();
        while (cycles() - before < 16 * 5000) { /* 5 ms */
        }
        IWDG_KR = 0xAAAA;
    }
    for (;;) {
    }
}
