/*
 * The state of the step output and the inner functions of its two files: stm32_step.c makes pulses, stm32_step_setup.c
 * does all else.
 *
 * One pulse of a motor:
 *
 *             edge by hardware          low by software, or by hardware while long pulses last
 *                 |<--- HIGH_TICKS --->|
 *      ___________/~~~~~~~~~~~~~~~~~~~~\______________/~~~
 *                 |  interrupt, client |    next armed
 *
 * Finding the next pulse takes longer than most drivers' minimum width, so the pin mostly is low at once after it.
 * What is left of a wider pulse is waited for if that takes less than an interrupt would (SPIN_TICKS); else the same
 * channel makes the falling edge too, and its interrupt arms what comes next.
 *
 * A channel stands in PWM mode 2 (RM0090 18.3.9): its pin is high from the compare value on and low before it, so one
 * write of the next value both ends a pulse and arms the next. That works while the counter does not wrap in between,
 * and for short pulses; `special` has the channels that are armed in another mode.
 */
#ifndef STM32_STEP_PRIVATE_H
#define STM32_STEP_PRIVATE_H

#include <assert.h>

#include "base_limits.h"
#include "base_tick.h"
#include "board.h"
#include "step_channel.h"
#include "stm32_private.h"
#include "stm32f4.h"

/* The bus of the timer runs at a quarter of the core's clock, the timer at half. An access takes two clocks of that
 * bus, and one of the core each for the matrix and to get into step with the bus (AN4031, table 4): a write acts that
 * much after its instruction, and the next access waits for it. `cycles` are those of the code. */
enum {
    CYCLES_PER_TICK = 2,
    BUS_ACCESS_CYCLES = 2 * 4 + 2
};
#define TICKS_OF_WRITES(writes, cycles) (((writes) * BUS_ACCESS_CYCLES + (cycles)) / CYCLES_PER_TICK)

#define TICKS_OF_NS(ns) (((ns) * TICKS_PER_US + 999U) / 1000U)

enum {
    HIGH_TICKS = TICKS_OF_NS(BOARD_STEP_HIGH_NS),
    LOW_TICKS = TICKS_OF_NS(BOARD_STEP_LOW_NS),
    SETUP_TICKS = TICKS_OF_NS(BOARD_DIR_SETUP_NS),
    HOLD_TICKS = TICKS_OF_NS(BOARD_DIR_HOLD_NS) + HIGH_TICKS,

    /* At most, from a look at the counter until what was decided has arrived: the write that holds a pin low, or moves
     * an armed edge on; those that end a pulse by the channel; those that arm it. The tests have the cycles of code. */
    WRITE_TICKS = TICKS_OF_WRITES(1, 48),
    MOVE_WRITE_TICKS = TICKS_OF_WRITES(1, 16),
    FALL_TICKS = TICKS_OF_WRITES(2, 48),
    ARM_TICKS = TICKS_OF_WRITES(5, 80),

    /* No edge comes before its channel is armed. */
    ROOM_TICKS = LOW_TICKS + WRITE_TICKS > ARM_TICKS ? LOW_TICKS + WRITE_TICKS : ARM_TICKS,
    MOVE_TICKS = LOW_TICKS + MOVE_WRITE_TICKS,
    SPIN_TICKS = 48, /* what an interrupt more takes at least */
    STUCK_TICKS = 5 * TICKS_PER_MS,

    /* The first lead for a change of speed; where planning takes longer, the axis tries again with twice as much. */
    LEAD_TICKS = 60 * TICKS_PER_US,
};

static_assert(SPIN_TICKS >= FALL_TICKS, "a pulse that its channel ends is not over before the channel knows");

/* What a channel does with its pin, RM0090 18.4.7. */
enum {
    MODE_RISE = 1,  /* active on match */
    MODE_FALL = 2,  /* inactive on match */
    MODE_LOW = 4,   /* forced inactive; matches are flagged all the same, RM0090 18.3.7 */
    MODE_AFTER = 7, /* PWM mode 2: active from the compare value on */
    MODE_MASK = 7,
};

struct stm32_channel {
    uint32_t *modes;         /* what the register holds; two channels share it */
    volatile uint32_t *mode; /* CCMR1 or CCMR2 */
    volatile uint32_t *compare;
    uint32_t one; /* mode 1 of this channel in the register */
    bool backward;
    bool connected;
};

struct stm32_step {
    uint32_t plain; /* flags of the channels that have an edge to come, in MODE_AFTER */
    struct step_channel *client[UNIT_MOTORS];
    uint32_t special;           /* of those that have one in another mode */
    uint32_t falling;           /* of those whose pulse is being ended by the channel */
    uint32_t waiting;           /* of those falling that have a pulse to be armed after it */
    uint32_t edge[UNIT_MOTORS]; /* of a plain channel, the client knows it; else the armed edge, or the last one */
    bool may_move;
    uint32_t modes[2];
    struct stm32_channel channel[UNIT_MOTORS];
};
extern struct stm32_step stm32_step;

static inline uint32_t flag_of(unsigned motor)
{
    return TIM2_SR_CC1IF << motor;
}

static inline void set_mode(const struct stm32_channel *channel, uint32_t mode)
{
    uint32_t others = *channel->modes & ~(MODE_MASK * channel->one);
    *channel->modes = others | mode * channel->one;
    *channel->mode = *channel->modes;
}

/* The mode of an armed channel. While disconnected its pin stays low. */
static inline uint32_t armed_mode(unsigned motor)
{
    uint32_t mode = (stm32_step.special & flag_of(motor)) != 0 ? MODE_RISE : MODE_AFTER;
    return stm32_step.channel[motor].connected ? mode : MODE_LOW;
}

/* The channels that have an edge to come. */
static inline uint32_t enabled(void)
{
    return stm32_step.plain | stm32_step.special;
}

static inline void set_enabled(uint32_t plain, uint32_t special)
{
    stm32_step.plain = plain;
    stm32_step.special = special;
    TIM2_DIER = plain | special;
}

/* The tick of the armed edge, else of the last one. */
static inline uint32_t edge_of(unsigned motor)
{
    bool plain = (stm32_step.plain & flag_of(motor)) != 0;
    return plain ? stm32_step.client[motor]->cursor.generator.tick : stm32_step.edge[motor];
}

#endif
