#include "base_tick.h"
#include "bringup.h"
#include "stm32_private.h"
#include "stm32f4.h"

enum {
    SOURCE_PLACE = 2,
    FIELD = 3,
    LATENCY = 0xF,
};

static void tell(const char *name, uint32_t value)
{
    say_name(name);
    say_decimal(value);
    say_line_end();
}

/* Twice that of the bus where that is divided (RM0090 7.2). */
uint32_t bringup_timer_hz(uint32_t bus_hz)
{
    return bus_hz == stm32_board_clock.core_hz ? bus_hz : 2U * bus_hz;
}

void bringup_clock_tell_now(void)
{
    uint32_t tick = TIM2_CNT;
    uint32_t cycles = DWT_CYCCNT;
    while (TIM2_CNT - tick < (uint32_t)TICKS_PER_MS) {
    }
    uint32_t ticks_passed = TIM2_CNT - tick;
    uint32_t cycles_passed = DWT_CYCCNT - cycles;
    tell("ticks", tick);
    tell("ticks_passed", ticks_passed);
    tell("cycles_passed", cycles_passed);
}

void bringup_clock_tell(void)
{
    uint32_t control = RCC_CR;
    tell("crystal", stm32_board_clock.crystal ? 1U : 0U);
    tell("core_hz", stm32_board_clock.core_hz);
    tell("apb1_hz", stm32_board_clock.apb1_hz);
    tell("apb2_hz", stm32_board_clock.apb2_hz);
    tell("crystal_ready", (control & RCC_CR_HSERDY) != 0 ? 1U : 0U);
    tell("pll_ready", (control & RCC_CR_PLLRDY) != 0 ? 1U : 0U);
    tell("source", RCC_CFGR >> SOURCE_PLACE & FIELD);
    tell("wait_states", FLASH_ACR & LATENCY);
}
