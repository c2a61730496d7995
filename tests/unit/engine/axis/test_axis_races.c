#include "base_tick.h"
#include "mock_hal_driver.h"
#include "mock_hal_run.h"
#include "mock_hal_step.h"
#include "mock_hal_time.h"
#include "mock_hal_trace.h"
#include "axis.h"
#include "unity.h"

#include "laid_rig.h"

/* An input changes while main works: the tick interrupt comes at any of the calls that main makes to the backend, and
 * the plan interrupt as soon as main lets it. No time passes, so all that counts is what main had done until then. */

enum {
    INPUT = 1,
    CALLS_MAX = 400,
    PASSES_MAX = 20000
};

static struct axis axis;
static uint64_t now;
static uint64_t pulses;
static unsigned calls;   /* of main to the backend */
static unsigned edge_at; /* the call at which the input changes; 0: never */
static bool edge_waits;  /* the interrupt is held off */
static bool plan_held;
static bool plan_waits;
static unsigned stops_traced;

static const struct axis_guards guards = {.stop_high = INPUT};

static const struct motion_order ramped = {
    .section = {{8000, 16000, 60000}},
    .start_speed_steps_per_s = 100,
    .sections = 1,
};

static void make_change(void)
{
    edge_at = 0;
    edge_waits = false;
    if (axis_sense_isr(&axis, INPUT, now)) {
        plan_waits = true;
    }
}

static void let_through(void)
{
    if (edge_waits && laid.holds == 0) {
        make_change();
    }
    if (plan_waits && !plan_held && laid.holds == 0) {
        plan_waits = false;
        plan_held = true;
        axis_plan_isr(&axis);
        plan_held = false;
    }
}

static void call_seen(void)
{
    calls++;
    edge_waits = edge_waits || calls == edge_at;
    let_through();
}

static void enable_seen(int call)
{
    (void)call;
    call_seen();
}

static void hold_seen(int count)
{
    (void)count;
    call_seen();
    laid_hold();
}

static void release_seen(int count)
{
    (void)count;
    laid_release();
    call_seen();
}

static void hold_plan_seen(int count)
{
    (void)count;
    call_seen();
    plan_held = true;
}

static void release_plan_seen(int count)
{
    (void)count;
    plan_held = false;
    call_seen();
}

static uint64_t tell_time(int count)
{
    (void)count;
    call_seen();
    return now;
}

static void traced(uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value, int count)
{
    (void)tick;
    (void)motor;
    (void)value;
    (void)count;
    stops_traced += event == HAL_TRACE_STOP ? 1U : 0U;
}

static unsigned lay(struct hal_step_room *room)
{
    return axis_lay_isr(&axis, room);
}

void setUp(void)
{
    now = UINT64_C(1) << 40;
    plan_held = false;
    plan_waits = false;
    edge_waits = false;
    edge_at = 0;
    calls = 0;
    pulses = 0;
    stops_traced = 0;
    laid_init(0, (uint32_t)now, lay);
    hal_step_lead_ticks_IgnoreAndReturn(0);
    hal_driver_enable_Stub(enable_seen);
    hal_step_hold_Stub(hold_seen);
    hal_step_release_Stub(release_seen);
    hal_run_hold_plan_Stub(hold_plan_seen);
    hal_run_release_plan_Stub(release_plan_seen);
    hal_time_now_Stub(tell_time);
    hal_trace_Stub(traced);
    axis_init(&axis, 0);
}

void tearDown(void)
{
}

static void make_pulse(void)
{
    now = tick_extend(laid_next_tick(), now);
    pulses++;
    (void)laid_make_pulse();
}

static void start(void)
{
    axis_begin(&axis, &ramped, false, now, &guards);
}

static void start_and_make_pulses(unsigned made)
{
    start();
    while (pulses < made) {
        make_pulse();
    }
}

static void run_to_the_end(void)
{
    unsigned passes = 0;
    for (axis_poll(&axis); axis_is_moving(&axis); axis_poll(&axis)) {
        TEST_ASSERT_LESS_THAN_UINT_MESSAGE(PASSES_MAX, passes++, "a move does not end");
        while (axis_feed(&axis)) {
        }
        if (laid_waiting() != 0) {
            make_pulse();
        }
    }
    TEST_ASSERT_EQUAL_UINT(0, laid_waiting());
    TEST_ASSERT_TRUE(axis_take_end(&axis));
    TEST_ASSERT_EQUAL_UINT64(pulses, axis_steps_made(&axis));
}

static void feed(void)
{
    while (axis_feed(&axis)) {
    }
}

static void change_speed(void)
{
    axis_change_speed(&axis, 300);
}

static void stop_by_command(void)
{
    axis_stop(&axis, AXIS_CAUSE_PAUSE);
}

static void poll(void)
{
    axis_poll(&axis);
}

static void change_input(void)
{
    (void)axis_sense_isr(&axis, INPUT, now);
    axis_plan_isr(&axis);
}

/* Pulses of a move that does two things after so many. */
static uint64_t pulses_of(unsigned made, void (*first)(void), void (*second)(void))
{
    setUp();
    start_and_make_pulses(made);
    first();
    second();
    run_to_the_end();
    return pulses;
}

/* The change comes at each call in turn, until main is through before it. */
static void assert_stopped_as_before_or_after(unsigned made, void (*work)(void))
{
    uint64_t before = pulses_of(made, change_input, work);
    uint64_t after = pulses_of(made, work, change_input);
    bool through = false;
    for (unsigned call = 1; !through; call++) {
        TEST_ASSERT_LESS_THAN_UINT(CALLS_MAX, call);
        setUp();
        start_and_make_pulses(made);
        calls = 0;
        edge_at = call;
        work();
        through = edge_at != 0;
        run_to_the_end();
        TEST_ASSERT_TRUE(through || pulses == before || pulses == after);
        TEST_ASSERT_TRUE(through || stops_traced == 1);
    }
}

void test_an_input_that_changes_while_segments_are_laid_stops_the_motor(void)
{
    assert_stopped_as_before_or_after(0, feed);
    assert_stopped_as_before_or_after(50, feed);
}

void test_an_input_that_changes_while_the_speed_is_changed_stops_the_motor(void)
{
    assert_stopped_as_before_or_after(50, change_speed);
}

void test_an_input_that_changes_while_a_command_stops_the_motor_changes_nothing(void)
{
    assert_stopped_as_before_or_after(50, stop_by_command);
}

void test_an_input_that_changes_while_main_looks_for_the_end_stops_the_motor(void)
{
    assert_stopped_as_before_or_after(50, poll);
}

/* Either no step is made, or the move is stopped at its first pulse. */
void test_an_input_that_changes_while_a_move_begins_stops_it(void)
{
    uint64_t at_once = pulses_of(0, feed, change_input);
    bool through = false;
    for (unsigned call = 1; !through; call++) {
        TEST_ASSERT_LESS_THAN_UINT(CALLS_MAX, call);
        setUp();
        edge_at = call;
        start();
        through = edge_at != 0;
        run_to_the_end();
        TEST_ASSERT_TRUE(through || pulses == 0 || pulses == at_once);
        TEST_ASSERT_TRUE(through || axis_cause(&axis) == AXIS_CAUSE_HIGH);
    }
}

/* Only the first segment has been laid; so many are its pulses. */
static unsigned pulses_laid(void)
{
    setUp();
    start();
    while (laid_waiting() != 0) {
        make_pulse();
    }
    return (unsigned)pulses;
}

void test_an_input_that_changes_while_a_motor_that_has_waited_goes_on_stops_it(void)
{
    assert_stopped_as_before_or_after(pulses_laid(), feed);
    assert_stopped_as_before_or_after(pulses_laid(), poll);
}

void test_a_stop_of_a_motor_that_waits_for_the_planner_leaves_it_where_it_is(void)
{
    unsigned made = pulses_laid();

    change_input();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(made, pulses);
    TEST_ASSERT_EQUAL_INT(AXIS_CAUSE_HIGH, axis_cause(&axis));
}

void test_what_was_stopped_does_not_touch_the_next_move(void)
{
    start_and_make_pulses(50);
    change_input();
    run_to_the_end();
    (void)axis_sense_isr(&axis, 0, now);
    pulses = 0;

    start();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(8000, pulses);
    TEST_ASSERT_EQUAL_INT(AXIS_CAUSE_NONE, axis_cause(&axis));
}
