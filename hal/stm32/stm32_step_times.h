/*
 * What both step outputs, stm32_step.c and stm32_gpio_step.c, have in common: the times of the board's drivers, and the
 * order of ticks.
 */
#ifndef STM32_STEP_TIMES_H
#define STM32_STEP_TIMES_H

#include <assert.h>
#include <stdbool.h>
#include <stdint.h>

#include "base_tick.h"
#include "board.h"
#include "image.h"

#define TICKS_OF_NS(ns) (((ns) * TICKS_PER_US + 999U) / 1000U)

/* Pulses of half a period, where the build says so (FIRMWARE_STEP_HALF): each is high until the middle between its
 * rising edge and the next one, but not longer than WIDEST_TICKS. The first of a motion and after a turn, and one whose
 * next is not known in time, have the width that all have otherwise. */
#ifndef IMAGE_STEP_HALF
#define IMAGE_STEP_HALF 0
#endif

/* The width of a pulse is the board's, or that of the image. */
#define HIGH_NS (IMAGE_STEP_HIGH_NS != 0U ? IMAGE_STEP_HIGH_NS : BOARD_STEP_HIGH_NS)
#define WIDEST_NS 10000U
#define TOP_NS (1000000000U / IMAGE_STEPS_PER_S_MAX) /* a period of the unit's highest rate */

enum {
    ROUNDED_TICKS = 2,
    HIGH_TICKS = TICKS_OF_NS(HIGH_NS),
    WIDEST_TICKS = TICKS_OF_NS(IMAGE_STEP_HALF ? WIDEST_NS : HIGH_NS),
    BOARD_LOW_TICKS = TICKS_OF_NS(BOARD_STEP_LOW_NS),

    /* That period, what of it a pulse is high, and what two edges leave if both were rounded. */
    TOP_TICKS = TICKS_OF_NS(TOP_NS),
    TOP_HALF_TICKS = (WIDEST_TICKS < (TOP_TICKS / 2)) ? WIDEST_TICKS : (TOP_TICKS / 2),
    TOP_HIGH_TICKS = (TOP_HALF_TICKS > HIGH_TICKS) ? TOP_HALF_TICKS : HIGH_TICKS,
    LEFT_TICKS = TOP_TICKS - TOP_HIGH_TICKS - ROUNDED_TICKS,

    LOW_TICKS = IMAGE_STEP_HIGH_NS != 0U && BOARD_LOW_TICKS > LEFT_TICKS ? LEFT_TICKS : BOARD_LOW_TICKS,
    SETUP_TICKS = TICKS_OF_NS(BOARD_DIR_SETUP_NS),
    HOLD_TICKS = TICKS_OF_NS(BOARD_DIR_HOLD_NS) + WIDEST_TICKS, /* after a rising edge, while main waits */
};

static_assert(IMAGE_STEP_HIGH_NS == 0U || IMAGE_STEP_HIGH_NS >= BOARD_STEP_HIGH_NS,
              "the drivers of the board want wider pulses than the unit makes");
static_assert(HIGH_NS <= WIDEST_NS, "a stop waits for the end of a pulse, with interrupts held off");
/* Nanoseconds, too, as ticks of far too many would wrap. */
static_assert((BOARD_STEP_LOW_NS <= TOP_NS) && ((TOP_HIGH_TICKS + BOARD_LOW_TICKS) <= TOP_TICKS),
              "the drivers of the board want more time for a pulse than the highest rate of the unit leaves");

/* Motors that begin together wait for HOLD at once, and for SETUP one after the other, before the first pulse of the
 * last one is planned, which may be due 500 us after their begin. In 64 bits, as four times far too much would wrap. */
#define DIR_NS_MAX 120000
static_assert((BOARD_DIR_HOLD_NS + (UINT64_C(4) * BOARD_DIR_SETUP_NS)) <= DIR_NS_MAX,
              "the drivers want DIR to stand for longer than there is: hold and four times setup, 120 us at most");

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
