/*
 * The rig of a late axis: an axis on a backend whose clock runs while main works. Planning takes ticks, which pass
 * before the step interrupt is held off to cut the queue, and in which the motor goes on.
 *
 * To be included by one test program alone, after the mocks.
 */
#ifndef LATE_RIG_H
#define LATE_RIG_H

#include "base_tick.h"
#include "mock_hal_run.h"
#include "mock_hal_step.h"
#include "mock_hal_time.h"
#include "mock_hal_trace.h"
#include "axis.h"
#include "unity.h"

#include "laid_rig.h"

static struct axis axis;
static uint64_t now;
static uint32_t lead_ticks;
static uint64_t planning_ticks; /* that pass until the cut */
static uint64_t handing_ticks;  /* that pass after the cut */
static uint64_t looking_ticks;  /* that pass between the first look of a stop and its brake */
static uint64_t braking_ticks;  /* that pass while a stop is planned */
static unsigned holds; /* since planning began: first to look ahead, then to replace; a stop finds, brakes, joins */
static bool stops;
static bool changes;
static unsigned cuts_tried;
static uint64_t pulses;
static uint64_t pulse_tick[3000];
static unsigned changes_traced;

/* Pulse k stands at k * 5250 ticks. */
static const struct motion_order fast = {
    .section = {{1000, 16000, 60000}},
    .start_speed_steps_per_s = 16000,
    .sections = 1,
};

static inline unsigned lay(struct hal_step_room *room)
{
    return axis_lay_isr(&axis, room);
}

static inline bool is_waiting(void)
{
    return laid_waiting() != 0;
}

static inline uint64_t next_pulse(void)
{
    return tick_extend(laid_next_tick(), now);
}

static inline void make_pulses_until(uint64_t tick)
{
    while (is_waiting() && next_pulse() <= tick) {
        pulse_tick[pulses] = next_pulse();
        now = pulse_tick[pulses] > now ? pulse_tick[pulses] : now;
        pulses++;
        (void)laid_make_pulse();
    }
    now = tick > now ? tick : now;
}

static inline void hold_seen(int calls)
{
    (void)calls;
    holds++;
    if (stops) {
        make_pulses_until(now + (holds == 2 ? looking_ticks : holds == 3 ? braking_ticks : 0));
    } else if (changes && holds % 2U == 0) {
        cuts_tried++;
        make_pulses_until(now + planning_ticks);
    }
    laid_hold();
}

static inline void release_seen(int calls)
{
    (void)calls;
    laid_release();
    if (changes && holds % 2U == 0 && handing_ticks != 0) {
        make_pulses_until(now + handing_ticks);
    }
}

static inline void traced(uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value, int calls)
{
    (void)tick;
    (void)motor;
    (void)value;
    (void)calls;
    changes_traced += event == HAL_TRACE_SPEED ? 1U : 0U;
}

static inline uint64_t tell_time(int calls)
{
    (void)calls;
    return now;
}

static inline uint32_t tell_lead(int calls)
{
    (void)calls;
    holds = 0;
    return lead_ticks;
}

static inline void late_rig_init(void)
{
    now = UINT64_C(1) << 40;
    lead_ticks = 0;
    planning_ticks = 0;
    handing_ticks = 0;
    looking_ticks = 0;
    braking_ticks = 0;
    stops = false;
    changes = false;
    holds = 0;
    cuts_tried = 0;
    pulses = 0;
    changes_traced = 0;
    laid_init(0, (uint32_t)now, lay);
    hal_step_hold_Stub(hold_seen);
    hal_step_release_Stub(release_seen);
    hal_step_lead_ticks_Stub(tell_lead);
    hal_time_now_Stub(tell_time);
    hal_run_hold_plan_Ignore();
    hal_run_release_plan_Ignore();
    hal_trace_Stub(traced);
    axis_init(&axis, 0);
}

/* Starts and makes some pulses, so that the next one is due in 5250 ticks. */
static inline void start(const struct motion_order *order, unsigned made)
{
    static const struct axis_guards none = {0};
    axis_begin(&axis, order, false, now, &none);
    while (axis_feed(&axis)) {
    }
    for (unsigned i = 0; i < made; i++) {
        make_pulses_until(next_pulse());
    }
    TEST_ASSERT_EQUAL_UINT64(made, pulses);
}

static inline void stop(void)
{
    holds = 0;
    stops = true;
    axis_stop(&axis, AXIS_CAUSE_PAUSE);
    stops = false;
}

static inline void change_speed(uint32_t speed_steps_per_s)
{
    changes = true;
    axis_change_speed(&axis, speed_steps_per_s);
    changes = false;
}

static inline void run_to_the_end(void)
{
    planning_ticks = 0;
    handing_ticks = 0;
    for (axis_poll(&axis); axis_is_moving(&axis); axis_poll(&axis)) {
        TEST_ASSERT_TRUE(is_waiting());
        while (axis_feed(&axis)) {
        }
        make_pulses_until(next_pulse());
    }
    TEST_ASSERT_EQUAL_UINT64(pulses, axis_steps_made(&axis));
}

#endif
