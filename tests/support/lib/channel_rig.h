/*
 * The rig of the tests of a step channel: a channel on the mock of hal_step.h, which keeps what is armed and sees that
 * the step interrupt is held off in pairs.
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

enum {
    MOTOR = 2,
    INTERVAL = 84000,
    START = 1000
};

static struct step_channel channel;
static uint32_t armed_tick;
static unsigned arms;
static bool disarm_answer;
static unsigned holds;

static inline void arm_seen(unsigned motor, uint32_t tick, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_UINT(MOTOR, motor);
    armed_tick = tick;
    arms++;
}

static inline bool disarm_asked(unsigned motor, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_UINT(MOTOR, motor);
    return disarm_answer;
}

static inline void hold_seen(int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, holds, "held twice");
    holds++;
}

static inline void release_seen(int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, holds, "released without a hold");
    holds--;
}

static inline void channel_rig_init(void)
{
    arms = 0;
    armed_tick = 0;
    holds = 0;
    disarm_answer = true;
    hal_step_arm_Stub(arm_seen);
    hal_step_disarm_Stub(disarm_asked);
    hal_step_hold_Stub(hold_seen);
    hal_step_release_Stub(release_seen);
    hal_step_set_direction_Ignore();
    step_channel_init(&channel, MOTOR);
}

static inline void channel_rig_check(void)
{
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, holds, "the step interrupt is still held off");
}

/* Pulses INTERVAL ticks apart, the first one INTERVAL after pulse number `pulse` of the move. */
static inline struct step_segment segment_after(uint32_t pulse, uint32_t steps)
{
    struct step_segment segment = {
        .slope = STEP_QUANTA / INTERVAL,
        .tick = START + pulse * INTERVAL,
        .pace_ticks = INTERVAL,
        .steps = steps,
    };
    step_generator_aim(&segment, INTERVAL);
    return segment;
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
        (void)step_channel_pulse_isr(&channel);
    }
}

static inline unsigned run_to_the_end(void)
{
    unsigned count = 0;
    while (step_channel_is_running(&channel)) {
        (void)step_channel_pulse_isr(&channel);
        count++;
        TEST_ASSERT_LESS_THAN_UINT(100000, count);
    }
    return count;
}

#endif
