#include "stm32_supply.h"

#include <assert.h>

#include "base_tick.h"
#include "board.h"
#include "stm32_edge.h"
#include "stm32_private.h"
#include "stm32f4.h"

static_assert(STM32_DETECT_RISING_MAX_MV(BOARD_DETECT_LEVEL) <= BOARD_SUPPLY_MIN_MV,
              "BOARD_DETECT_LEVEL: a good supply might never be seen as good");
static_assert(STM32_DETECT_FALLING_MIN_MV(BOARD_DETECT_LEVEL) >= STM32_FLASH_MIN_MV(BOARD_FLASH_BYTES),
              "BOARD_DETECT_LEVEL: a supply too low for BOARD_FLASH_BYTES at a time might not be seen");
static_assert(STM32_BROWN_OUT_RISING_MAX_MV(BOARD_BROWN_OUT_LEVEL) <= BOARD_SUPPLY_MIN_MV,
              "BOARD_BROWN_OUT_LEVEL: the part might never start");
static_assert(STM32_BROWN_OUT_FALLING_MIN_MV(BOARD_BROWN_OUT_LEVEL) >= 2100U,
              "BOARD_BROWN_OUT_LEVEL: below 2.1 V the part cannot run at 168 MHz");

/* How long the detector takes to begin is not in the data sheet of this part: assumed, with much room. A turn reads the
 * timer by a slow bus: so many take longer, whatever the clock, if it stands still. */
#define SETTLE_TICKS (250U * TICKS_PER_US)
enum {
    TURNS_MAX = 20000
};

void stm32_supply_start(void)
{
    stm32_enable_clock(&RCC_APB1ENR, RCC_APB1ENR_PWREN);
    PWR_CR = (PWR_CR & ~PWR_CR_PLS(7U)) | PWR_CR_PVDE | PWR_CR_PLS(BOARD_DETECT_LEVEL);
    uint32_t start = TIM2_CNT;
    for (uint32_t turns = 0; turns < (uint32_t)TURNS_MAX && TIM2_CNT - start < SETTLE_TICKS; turns++) {
    }
    EXTI_RTSR |= STM32_EDGE_SUPPLY;
    EXTI_FTSR |= STM32_EDGE_SUPPLY;
    EXTI_IMR |= STM32_EDGE_SUPPLY;
    EXTI_SWIER = STM32_EDGE_SUPPLY; /* as if it had changed: who asks first looks */
}
