/*
 * What both step outputs, stm32_step.c and stm32_gpio_step.c, have in common: the times of the board's drivers, and the
 * order of ticks.
 */
#ifndef STM32_STEP_TIMES_H
#define STM32_STEP_TIMES_H

#include <stdbool.h>
#include <stdint.h>

#include "base_tick.h"
#include "board.h"

#define TICKS_OF_NS(ns) (((ns) * TICKS_PER_US + 999U) / 1000U)

enum {
    HIGH_TICKS = TICKS_OF_NS(BOARD_STEP_HIGH_NS),
    LOW_TICKS = TICKS_OF_NS(BOARD_STEP_LOW_NS),
    SETUP_TICKS = TICKS_OF_NS(BOARD_DIR_SETUP_NS),
    HOLD_TICKS = TICKS_OF_NS(BOARD_DIR_HOLD_NS) + HIGH_TICKS, /* after a rising edge, while main waits */
};

/* Of ticks less than 25 s apart. */
static inline bool is_before(uint32_t tick, uint32_t other)
{
    return (int32_t)(tick - other) < 0;
}

static inline uint32_t later(uint32_t tick, uint32_t other)
{
    return is_before(tick, other) ? other : tick;
}

#endif
