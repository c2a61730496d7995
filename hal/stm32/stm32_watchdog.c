#include "stm32_private.h"
#include "stm32f4.h"

/* The watchdog's oscillator has 17 to 47 kHz: 512 ms nominal are 350 to 960 ms. */
enum {
    DIVIDE_BY_32 = 3,
    RELOAD = 511,
    KEY_ACCESS = 0x5555,
    KEY_FEED = 0xAAAA,
    KEY_START = 0xCCCC,
    TURNS_MAX = 100000, /* a change of the registers takes 5 periods of the oscillator, which starts first */

    MAIN_MS_MAX = 200, /* the longest pass of main takes a tenth of it */
};

static volatile uint32_t main_age_ms;

static void wait_for_update(void)
{
    for (uint32_t turns = 0; turns < TURNS_MAX && (IWDG_SR & (IWDG_SR_PVU | IWDG_SR_RVU)) != 0; turns++) {
    }
}

/* It cannot be stopped again. What a boot loader has set may wait for the oscillator yet, and no reset of this start
 * has cleared it: until it is taken over, the registers must not be written (RM0090 21.4.2, AN2606). */
void stm32_watchdog_start(void)
{
    IWDG_KR = KEY_START;
    wait_for_update();
    IWDG_KR = KEY_ACCESS;
    IWDG_PR = DIVIDE_BY_32;
    IWDG_RLR = RELOAD;
    wait_for_update();
    IWDG_KR = KEY_FEED;
}

void stm32_watchdog_main_lives(void)
{
    main_age_ms = 0;
}

void stm32_watchdog_tick(void)
{
    if (main_age_ms < (uint32_t)MAIN_MS_MAX) {
        main_age_ms++;
        if (!stm32_step_is_stuck()) {
            IWDG_KR = KEY_FEED;
        }
    }
}
