#include <string.h>

#include "base_tick.h"
#include "mock_hal_run.h"
#include "mock_hal_step.h"
#include "mock_hal_time.h"
#include "mock_hal_trace.h"
#include "mover.h"
#include "unity.h"

/* A mover on a backend whose clock runs while main works: planning takes ticks, which pass before the step
 * interrupt is held off to cut the queue, and in which the motor goes on. */

static struct mover mover;
static uint64_t now;
static uint64_t armed;
static bool is_armed;
static uint32_t lead_ticks;
static uint64_t planning_ticks; /* that pass until the cut */
static uint64_t handing_ticks;  /* that pass after the cut */
static uint64_t looking_ticks;  /* that pass between the first look of a stop and its brake */
static uint64_t braking_ticks;  /* that pass while a stop is planned */
static unsigned holds;          /* since planning began: first to foresee, then to cut; a stop looks, brakes, joins */
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

/* From 16 000 steps/s down to 100 takes 2133 steps at 60 000 steps/s^2, and from the 50th pulse of a ramp 50. */
static const struct motion_order ramped = {
    .section = {{4000, 16000, 60000}},
    .start_speed_steps_per_s = 100,
    .sections = 1,
};

static void make_pulses_until(uint64_t tick)
{
    while (is_armed && armed <= tick) {
        now = armed > now ? armed : now;
        is_armed = false;
        pulse_tick[pulses] = armed;
        pulses++;
        (void)mover_pulse_isr(&mover);
    }
    now = tick > now ? tick : now;
}

static void arm_seen(unsigned motor, uint32_t tick, int calls)
{
    (void)motor;
    (void)calls;
    TEST_ASSERT_FALSE(is_armed);
    armed = tick_extend(tick, now);
    is_armed = true;
}

static bool disarm_seen(unsigned motor, int calls)
{
    (void)motor;
    (void)calls;
    bool taken = is_armed;
    is_armed = false;
    return taken;
}

static void hold_seen(int calls)
{
    (void)calls;
    holds++;
    if (stops) {
        make_pulses_until(now + (holds == 2 ? looking_ticks : holds == 3 ? braking_ticks : 0));
    } else if (changes && holds % 2U == 0) {
        cuts_tried++;
        make_pulses_until(now + planning_ticks);
    }
}

static void release_seen(int calls)
{
    (void)calls;
    if (changes && holds % 2U == 0 && handing_ticks != 0) {
        make_pulses_until(now + handing_ticks);
    }
}

static void traced(uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value, int calls)
{
    (void)tick;
    (void)motor;
    (void)value;
    (void)calls;
    changes_traced += event == HAL_TRACE_SPEED ? 1U : 0U;
}

static uint64_t tell_time(int calls)
{
    (void)calls;
    return now;
}

static uint32_t tell_lead(int calls)
{
    (void)calls;
    holds = 0;
    return lead_ticks;
}

void setUp(void)
{
    now = UINT64_C(1) << 40;
    is_armed = false;
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
    hal_step_set_direction_Ignore();
    hal_step_arm_Stub(arm_seen);
    hal_step_disarm_Stub(disarm_seen);
    hal_step_hold_Stub(hold_seen);
    hal_step_release_Stub(release_seen);
    hal_step_lead_ticks_Stub(tell_lead);
    hal_time_now_Stub(tell_time);
    hal_run_hold_plan_Ignore();
    hal_run_release_plan_Ignore();
    hal_trace_Stub(traced);
    mover_init(&mover, 0);
}

void tearDown(void)
{
}

/* Starts and makes some pulses, so that the next one is due in 5250 ticks. */
static void start(const struct motion_order *order, unsigned made)
{
    static const struct mover_guards none = {0};
    mover_start(&mover, order, false, now, &none);
    while (mover_feed(&mover)) {
    }
    for (unsigned i = 0; i < made; i++) {
        make_pulses_until(armed);
    }
    TEST_ASSERT_EQUAL_UINT64(made, pulses);
}

static void stop(void)
{
    holds = 0;
    stops = true;
    mover_stop(&mover, HAL_TRACE_STOP_COMMAND);
    stops = false;
}

static void change_speed(uint32_t speed_steps_per_s)
{
    changes = true;
    mover_change_speed(&mover, speed_steps_per_s);
    changes = false;
}

static void run_to_the_end(void)
{
    planning_ticks = 0;
    handing_ticks = 0;
    for (mover_poll(&mover); mover_is_moving(&mover); mover_poll(&mover)) {
        TEST_ASSERT_TRUE(is_armed);
        while (mover_feed(&mover)) {
        }
        make_pulses_until(armed);
    }
    TEST_ASSERT_EQUAL_UINT64(pulses, mover_steps_made(&mover));
}

void test_a_stop_below_the_start_speed_takes_effect_at_the_next_pulse(void)
{
    start(&fast, 10);
    braking_ticks = 3 * 5250;

    stop();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(11, pulses);
    TEST_ASSERT_EQUAL_INT(HAL_TRACE_STOP_COMMAND, mover_stop_cause(&mover));
}

/* Ends of moves that were stopped behind pulse 50, by the time that planning took. */
static void assert_stopped_alike(uint64_t planning)
{
    static uint64_t expected[sizeof pulse_tick / sizeof *pulse_tick];
    setUp();
    start(&ramped, 50);
    stop();
    run_to_the_end();
    uint64_t made = pulses;
    memcpy(expected, pulse_tick, sizeof expected);

    setUp();
    start(&ramped, 50);
    braking_ticks = planning;
    stop();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(made, pulses);
    for (unsigned i = 0; i < made; i++) {
        TEST_ASSERT_UINT64_WITHIN(1, expected[i], pulse_tick[i]);
    }
}

void test_a_stop_makes_the_same_pulses_however_long_planning_takes(void)
{
    assert_stopped_alike(1);
    assert_stopped_alike(TICK_HZ / 1000U);
    assert_stopped_alike(TICK_HZ / 200U);
}

/* Half of the way down to S is made without a plan, then the motor waits for it. */
void test_a_stop_that_is_planned_much_too_late_ends_on_its_step_all_the_same(void)
{
    start(&ramped, 50);
    stop();
    run_to_the_end();
    uint64_t made = pulses;

    setUp();
    start(&ramped, 50);
    braking_ticks = TICK_HZ;
    stop();
    TEST_ASSERT_EQUAL_UINT64((made + 51U) / 2U, pulses);
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(made, pulses);
}

/* The pulse behind which the interval is another. */
static unsigned first_change(void)
{
    unsigned k = 1;
    while (pulse_tick[k] - pulse_tick[k - 1U] == pulse_tick[1] - pulse_tick[0]) {
        k++;
    }
    return k;
}

void test_a_change_of_speed_takes_effect_at_the_first_pulse_that_leaves_the_lead(void)
{
    start(&fast, 10);
    lead_ticks = 2 * 5250 + 1;

    change_speed(8000);
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT(13, first_change());
}

void test_planning_within_the_lead_is_in_time_at_the_first_try(void)
{
    start(&fast, 10);
    lead_ticks = 2 * 5250 + 1;
    planning_ticks = 2 * 5250;

    change_speed(8000);
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT(13, first_change());
    TEST_ASSERT_EQUAL_UINT(1, cuts_tried);
}

/* The lead ends at pulse 12, planning lasts nearly until pulse 13; the second lead, twice as long and 1 us, ends just
 * after pulse 16. */
void test_planning_that_takes_longer_than_the_lead_is_tried_again_with_twice_the_lead(void)
{
    start(&fast, 10);
    lead_ticks = 5250 + 2625;
    planning_ticks = 3 * 5250 - 1;

    change_speed(8000);
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT(17, first_change());
    TEST_ASSERT_EQUAL_UINT(2, cuts_tried);
}

void test_a_change_of_speed_that_was_tried_again_keeps_the_target(void)
{
    start(&fast, 10);
    lead_ticks = 5250 + 2625;
    planning_ticks = 3 * 5250 - 1;

    change_speed(8000);
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(1000, pulses);
    TEST_ASSERT_EQUAL_UINT(2, cuts_tried);
    TEST_ASSERT_EQUAL_UINT(1, changes_traced);
}

void test_a_change_that_is_planned_after_the_end_of_the_move_changes_nothing(void)
{
    start(&fast, 10);
    lead_ticks = 1;
    planning_ticks = 1000 * 5250;

    change_speed(8000);

    TEST_ASSERT_EQUAL_UINT(1, cuts_tried);
    TEST_ASSERT_EQUAL_UINT(0, changes_traced);
    run_to_the_end();
    TEST_ASSERT_EQUAL_UINT64(1000, pulses);
}

void test_a_stop_behind_which_no_pulse_is_left_changes_nothing(void)
{
    start(&fast, 999);

    stop();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(1000, pulses);
}

void test_a_stop_takes_a_pulse_back_that_is_armed_while_it_looks(void)
{
    start(&fast, 10);
    looking_ticks = 5250;

    stop();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(11, pulses);
}

/* Two pulses come meanwhile: the stop acts at the third. */
void test_a_stop_that_looks_too_long_ago_acts_at_the_armed_pulse(void)
{
    start(&fast, 10);
    looking_ticks = 2 * 5250;

    stop();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(13, pulses);
}

void test_a_stop_that_meets_the_last_pulse_where_it_brakes_changes_nothing(void)
{
    start(&fast, 998);
    looking_ticks = 2 * 5250;

    stop();
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(1000, pulses);
}

/* Behind 50 pulses, an input changes so long ago; the pulses are those of a stop behind `made`. */
static void assert_sensed_like_a_stop_behind(unsigned made, uint64_t ago_ticks)
{
    static const struct mover_guards guards = {.stop_high = 1};
    start(&ramped, 50);
    now += 100;
    mover.guards = guards;
    TEST_ASSERT_TRUE(mover_sense_isr(&mover, 1, now - ago_ticks));
    mover_plan_isr(&mover);
    run_to_the_end();
    uint64_t sensed = pulses;

    setUp();
    start(&ramped, made);
    stop();
    run_to_the_end();
    TEST_ASSERT_EQUAL_UINT64(pulses, sensed);
}

void test_an_input_that_is_seen_late_stops_at_the_pulse_behind_its_change(void)
{
    assert_sensed_like_a_stop_behind(49, 101);
}

void test_a_pulse_on_the_tick_of_the_change_is_not_behind_it(void)
{
    assert_sensed_like_a_stop_behind(50, 100);
}

void test_a_stop_of_a_move_whose_end_main_has_not_seen_changes_nothing(void)
{
    start(&fast, 1000);

    stop();
    TEST_ASSERT_TRUE(mover_is_moving(&mover));
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(1000, pulses);
}

void test_a_change_of_speed_that_cannot_be_planned_within_a_second_is_given_up(void)
{
    static const struct motion_order slow = {
        .section = {{1000, 100, 2000}},
        .start_speed_steps_per_s = 100,
        .sections = 1,
    };
    start(&slow, 10);
    lead_ticks = (TICK_HZ - TICKS_PER_US) / 2U;
    planning_ticks = 2U * (uint64_t)TICK_HZ;

    change_speed(50);
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT(1, cuts_tried);
    TEST_ASSERT_EQUAL_UINT(0, changes_traced);
    TEST_ASSERT_EQUAL_UINT64(1000, pulses);
}

void test_a_change_of_speed_that_the_move_ends_before_is_not_traced(void)
{
    start(&fast, 998);
    lead_ticks = 3 * 5250;

    change_speed(8000);
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT(0, changes_traced);
    TEST_ASSERT_EQUAL_UINT64(1000, pulses);
}

/* Ten sections of one step: a cut hands over the first two, and before main comes to the rest they are used up. */
static void run_dry(void)
{
    struct motion_order order = {.start_speed_steps_per_s = 16000, .sections = MOTION_SECTIONS};
    for (unsigned i = 0; i < MOTION_SECTIONS; i++) {
        order.section[i] = (struct motion_section){1, 16000, 60000};
    }
    start(&order, 1);
    handing_ticks = 6 * 5250;

    change_speed(15999);
    TEST_ASSERT_FALSE(is_armed);
}

/* Pulse 2 is armed when the change comes. */
void test_a_change_hands_over_two_segments_for_the_time_until_main_lays_the_others(void)
{
    run_dry();

    TEST_ASSERT_EQUAL_UINT64(2 + 2, pulses);
    run_to_the_end();
}

void test_a_queue_that_ran_dry_behind_a_cut_is_filled_and_goes_on(void)
{
    run_dry();

    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(MOTION_SECTIONS, pulses);
    TEST_ASSERT_EQUAL_INT64(MOTION_SECTIONS, mover_position_steps(&mover));
}

void test_a_queue_that_ran_dry_goes_on_as_soon_as_it_is_fed(void)
{
    run_dry();

    TEST_ASSERT_TRUE(mover_feed(&mover));
    TEST_ASSERT_TRUE(is_armed);
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(MOTION_SECTIONS, pulses);
}

/* Without a plan the motor gets to the border; what was planned behind it is there when main looks. */
void test_a_stop_that_is_planned_when_the_motor_waits_at_a_border_goes_on_behind_it(void)
{
    static const struct motion_order two = {
        .section = {{1060, 16000, 60000}, {4000, 16000, 60000}},
        .start_speed_steps_per_s = 100,
        .sections = 2,
    };
    start(&two, 1050);
    stop();
    run_to_the_end();
    uint64_t made = pulses;

    setUp();
    start(&two, 1050);
    braking_ticks = TICK_HZ;
    stop();
    TEST_ASSERT_EQUAL_UINT64(1060, pulses);
    TEST_ASSERT_FALSE(is_armed);
    run_to_the_end();

    TEST_ASSERT_GREATER_THAN_UINT64(1100, made);
    TEST_ASSERT_EQUAL_UINT64(made, pulses);
}
