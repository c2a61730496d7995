/*
 * The rig of the tests of a step channel: a channel on the step output of laid_rig.h.
 *
 * Pulses come at constant speed, one every INTERVAL ticks, so that pulse k of a move stands at START + k * INTERVAL.
 * To be included by one test program alone, after the mock.
 */
#ifndef CHANNEL_RIG_H
#define CHANNEL_RIG_H

#include "mock_hal_step.h"
#include "step_channel.h"
#include "step_scale.h"
#include "unity.h"

#include "laid_rig.h"

enum {
    MOTOR = 2,
    INTERVAL = 84000,
    START = 1000
};

static struct step_channel channel;

static inline unsigned lay(struct hal_step_room *room)
{
    return step_channel_lay_isr(&channel, room);
}

static inline void channel_rig_init(void)
{
    laid_init(MOTOR, START, lay);
    step_channel_init(&channel, MOTOR);
}

static inline void channel_rig_check(void)
{
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, laid.holds, "the step interrupt is still held off");
}

/* Pulses so many ticks apart, as all before them, the first one after pulse number `pulse` of the move. */
static inline struct step_segment segment_every(uint32_t interval_ticks, uint32_t pulse, uint32_t steps)
{
    struct step_segment segment = {
        .slope = STEP_QUANTA / interval_ticks,
        .tick = START + pulse * interval_ticks,
        .pace_ticks = interval_ticks,
        .steps = steps,
    };
    step_generator_aim(&segment, interval_ticks);
    return segment;
}

static inline struct step_segment segment_after(uint32_t pulse, uint32_t steps)
{
    return segment_every(INTERVAL, pulse, steps);
}

static inline void push(uint32_t pulse, uint32_t steps)
{
    struct step_segment segment = segment_after(pulse, steps);
    step_channel_push(&channel, &segment);
}

static inline void begin_move(uint32_t steps)
{
    step_channel_begin(&channel, START, false);
    push(0, steps);
    step_channel_run(&channel);
}

/* Two segments: pulses 1 to `first` and as many after them as `second`. */
static inline void begin_two(uint32_t first, uint32_t second)
{
    step_channel_begin(&channel, START, false);
    push(0, first);
    push(first, second);
    step_channel_run(&channel);
}

static inline void make_pulses(unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        (void)laid_make_pulse();
    }
}

static inline unsigned run_to_the_end(void)
{
    unsigned count = 0;
    while (step_channel_is_running(&channel)) {
        make_pulses(1);
        count++;
        TEST_ASSERT_LESS_THAN_UINT(100000, count);
    }
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, laid_waiting(), "pulses are to come to a channel that rests");
    return count;
}

#endif
