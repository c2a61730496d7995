/* The judge passes a good log, and finds each invariant broken in a doctored one. The log: motor 1 makes 600 steps
 * forward with S100 V1000 A2000, whose ramps have 247.5 steps, in a compound move of one section. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base_tick.h"
#include "judge.h"
#include "unity.h"

enum {
    STEPS = 600,
    START = 1000,
    CRUISE_PULSE = 300,
    RAMP_PULSE = 100
};

static struct judge judge;
static uint64_t ticks[STEPS + 1]; /* from 1 */
static uint64_t done_tick;
static int64_t done_steps;
static struct motion_order order;

/* Pulse k of the run with a stop at `stop` (0: none), as the judge's own curve has it. */
static void lay_log(uint64_t stop)
{
    struct judge_curve curve;
    judge_curve_begin(&curve, &order);
    for (uint64_t pulse = 1; pulse <= STEPS && pulse <= curve.last; pulse++) {
        if (pulse == stop) {
            judge_curve_stop(&curve, pulse);
        }
        ticks[pulse] = START + (uint64_t)llroundl(judge_curve_tick(&curve, pulse));
    }
    done_steps = (int64_t)curve.last;
    done_tick = ticks[done_steps];
}

void setUp(void)
{
    struct judge_limits limits = judge_default_limits();
    judge_init(&judge, &limits);
    order = (struct motion_order){.start_speed_steps_per_s = 100, .sections = 1};
    order.section[0] = (struct motion_section){STEPS, 1000, 2000};
    lay_log(0);
}

void tearDown(void)
{
}

static void begin(void)
{
    judge_event(&judge, START, 1, HAL_TRACE_MOVE, STEPS);
    judge_order(&judge, 1, &order, 0);
}

static void feed(unsigned from, unsigned to)
{
    for (unsigned pulse = from; pulse <= to; pulse++) {
        judge_pulse(&judge, ticks[pulse], 1, false);
    }
}

static void end(void)
{
    judge_event(&judge, done_tick, 1, HAL_TRACE_DONE, done_steps);
    judge_finish(&judge, done_tick + TICK_HZ);
}

static void feed_all(void)
{
    begin();
    feed(1, (unsigned)done_steps);
    end();
}

static void assert_none(void)
{
    TEST_ASSERT_EQUAL_STRING("", judge.complaint[0].text);
    TEST_ASSERT_EQUAL_UINT32(0, judge.complaints);
}

static void assert_found(const char *part)
{
    for (uint32_t i = 0; i < judge.complaints; i++) {
        if (strstr(judge.complaint[i].text, part) != NULL) {
            return;
        }
    }
    TEST_FAIL_MESSAGE(judge.complaints == 0 ? "no complaint" : judge.complaint[0].text);
}

void test_a_good_log_passes(void)
{
    feed_all();
    assert_none();
}

void test_the_curve_is_that_of_the_contract(void)
{
    /* 5.405 s for 5000 steps, and 2 * (sqrt(210000) - 100) / 2000 s for 100 (motion.md). */
    struct judge_curve curve;
    order.section[0].steps = 5000;
    judge_curve_begin(&curve, &order);
    TEST_ASSERT_EQUAL_INT64(454020000, llroundl(judge_curve_tick(&curve, 5000)));
    order.section[0].steps = 100;
    judge_curve_begin(&curve, &order);
    TEST_ASSERT_EQUAL_INT64(llroundl((sqrtl(210000.0L) - 100.0L) / 1000.0L * 84000000.0L),
                            llroundl(judge_curve_tick(&curve, 100)));
}

void test_a_stop_down_the_ramp_passes(void)
{
    lay_log(CRUISE_PULSE);
    begin();
    feed(1, CRUISE_PULSE - 1);
    judge_event(&judge, ticks[CRUISE_PULSE - 1] + 1, 1, HAL_TRACE_STOP, AXIS_CAUSE_PAUSE);
    feed(CRUISE_PULSE, (unsigned)done_steps);
    end();
    TEST_ASSERT_EQUAL_INT64(CRUISE_PULSE + 247, done_steps);
    assert_none();
}

void test_a_change_of_speed_passes(void)
{
    struct judge_curve curve;
    judge_curve_begin(&curve, &order);
    begin();
    for (uint64_t pulse = 1; pulse <= STEPS; pulse++) {
        if (pulse == CRUISE_PULSE) {
            judge_event(&judge, ticks[pulse - 1], 1, HAL_TRACE_SPEED, 300);
            judge_curve_change_speed(&curve, pulse, 300);
        }
        ticks[pulse] = START + (uint64_t)llroundl(judge_curve_tick(&curve, pulse));
        feed((unsigned)pulse, (unsigned)pulse);
    }
    done_tick = ticks[STEPS];
    end();
    assert_none();
}

void test_a_guard_that_has_its_level_at_the_start_lets_no_pulse_come(void)
{
    begin();
    judge_event(&judge, START, 1, HAL_TRACE_STOP, AXIS_CAUSE_HIGH);
    judge_event(&judge, START, 1, HAL_TRACE_DONE, 0);
    judge_finish(&judge, START + TICK_HZ);
    assert_none();
}

void test_1_a_position_that_is_not_the_pulses_is_found(void)
{
    begin();
    feed(1, RAMP_PULSE);
    judge_position(&judge, 1, RAMP_PULSE);
    assert_none();
    judge_position(&judge, 1, RAMP_PULSE + 1);
    assert_found("the position 101 is not the pulses made, 100");
}

void test_2_a_speed_above_v_is_found(void)
{
    begin();
    feed(1, CRUISE_PULSE);
    judge_pulse(&judge, ticks[CRUISE_PULSE] + TICK_HZ / 1000U - 3U, 1, false);
    assert_found("is faster than its V");
}

void test_2_pulses_slower_than_the_plan_are_found(void)
{
    for (unsigned pulse = 2; pulse <= STEPS; pulse++) {
        ticks[pulse] += 2;
    }
    done_tick += 2;
    feed_all();
    assert_found("more than a tick off its time");
}

TEST_CASE(-2)
TEST_CASE(2)
void test_3_a_pulse_two_ticks_off_is_found(int off)
{
    ticks[RAMP_PULSE] += (uint64_t)(int64_t)off;
    feed_all();
    assert_found("more than a tick off its time");
}

TEST_CASE(100)
TEST_CASE(300)
TEST_CASE(500)
void test_4_an_interval_out_of_its_order_is_found(unsigned pulse)
{
    ticks[pulse] += 20000;
    feed_all();
    assert_found("has an interval out of its order");
}

void test_5_a_speed_that_leaves_too_little_way_is_found(void)
{
    begin();
    feed(1, STEPS - 20);
    judge_pulse(&judge, ticks[STEPS - 20] + TICK_HZ / 990U, 1, false);
    assert_found("is too fast for the way that is left");
}

void test_6_a_move_that_ends_short_is_found(void)
{
    done_steps = STEPS - 1;
    done_tick = ticks[STEPS - 1];
    feed_all();
    assert_found("ended at 599 with no stop");
    assert_found("does not end where its plan does");
}

void test_6_a_pulse_after_done_is_found(void)
{
    feed_all();
    judge_pulse(&judge, done_tick + TICK_HZ / 100U, 1, false);
    assert_found("a pulse outside any move");
}

TEST_CASE(-1)
TEST_CASE(1)
void test_6_a_done_that_is_not_at_the_last_pulse_is_found(int off)
{
    done_tick += (uint64_t)(int64_t)off;
    feed_all();
    assert_found("has a done that is not at its last pulse");
}

void test_7_dir_that_moves_before_a_pulse_is_found(void)
{
    judge_direction(&judge, ticks[1] - TICKS_PER_US, 1, false);
    feed_all();
    assert_found("DIR moves before the pulse");
}

void test_7_dir_that_moves_after_a_pulse_is_found(void)
{
    judge.limits.dir_hold_ticks = 2U * TICKS_PER_US;
    feed_all();
    judge_direction(&judge, done_tick + TICKS_PER_US, 1, true);
    assert_found("DIR moves after a pulse");
}

void test_7_dir_that_shows_the_other_way_is_found(void)
{
    judge_direction(&judge, START, 1, true);
    feed_all();
    assert_found("DIR shows the other way");
}

void test_7_a_dir_that_stands_still_passes(void)
{
    judge.limits.dir_hold_ticks = 2U * TICKS_PER_US;
    judge_direction(&judge, START, 1, false);
    feed_all();
    judge_direction(&judge, done_tick + 3U * TICKS_PER_US, 1, true);
    assert_none();
}

void test_8_a_gap_inside_a_move_is_found(void)
{
    begin();
    feed(1, CRUISE_PULSE);
    judge_pulse(&judge, ticks[CRUISE_PULSE] + TICK_HZ / 100U + 3U, 1, false);
    assert_found("has a gap");
}

void test_8_a_pulse_that_has_not_come_is_found(void)
{
    begin();
    feed(1, CRUISE_PULSE);
    judge_finish(&judge, ticks[CRUISE_PULSE + 1]);
    assert_none();
    judge_finish(&judge, ticks[CRUISE_PULSE + 1] + 4U);
    assert_found("owes a pulse");
}

void test_9_a_pulse_too_many_after_a_stop_is_found(void)
{
    lay_log(CRUISE_PULSE);
    begin();
    feed(1, CRUISE_PULSE - 1);
    judge_event(&judge, ticks[CRUISE_PULSE - 1] + 1, 1, HAL_TRACE_STOP, AXIS_CAUSE_HIGH);
    feed(CRUISE_PULSE, (unsigned)done_steps);
    judge_pulse(&judge, done_tick + TICK_HZ / 100U, 1, false);
    assert_found("makes more pulses than its plan or a stop allow");
}

void test_9_a_pulse_after_the_end_of_a_limit_run_is_found(void)
{
    order.section[0] = motion_order_endless(100, 2000);
    begin();
    judge_pulse(&judge, START + TICK_HZ / 100U, 1, false);
    judge_event(&judge, START + TICK_HZ / 99U, 1, HAL_TRACE_STOP, AXIS_CAUSE_LIMIT);
    assert_none();
    judge_pulse(&judge, START + TICK_HZ / 50U, 1, false);
    assert_found("makes more pulses than its plan or a stop allow");
}

void test_10_a_request_without_an_answer_is_found(void)
{
    judge_exchange(&judge, 1, 1);
    assert_none();
    judge_exchange(&judge, 1, 0);
    assert_found("0 answers to 1 requests");
}

void test_10_an_answer_to_a_broadcast_is_found(void)
{
    judge_exchange(&judge, 0, 1);
    assert_found("1 answers to 0 requests");
}

void test_11_a_program_that_has_left_its_bounds_is_found(void)
{
    static struct interpreter interpreter;
    judge_interpreter(&judge, 1, &interpreter);
    assert_none();
    interpreter.call_depth = INTERPRETER_CALLS_MAX + 1;
    judge_interpreter(&judge, 1, &interpreter);
    assert_found("has left its bounds");
}

void test_11_a_pass_without_bounds_is_found(void)
{
    for (int i = 0; i < 1000; i++) {
        judge_event(&judge, START, 1, HAL_TRACE_OUT, 1);
    }
    judge_pass(&judge);
    assert_found("a pass of main did 1000 things");
}

void test_12_a_word_written_when_not_erased_is_found(void)
{
    judge_flash(&judge, 0);
    assert_none();
    judge_flash(&judge, 1);
    assert_found("1 words of the flash");
}

void test_13_and_14_the_digest_tells_runs_apart(void)
{
    static struct judge other;
    feed_all();
    other = judge;
    judge_init(&judge, &other.limits);
    feed_all();
    TEST_ASSERT_EQUAL_HEX64(judge_digest(&other), judge_digest(&judge));
    judge_init(&judge, &other.limits);
    ticks[RAMP_PULSE]++;
    feed_all();
    TEST_ASSERT_NOT_EQUAL_HEX64(judge_digest(&other), judge_digest(&judge));
}

TEST_CASE(false)
TEST_CASE(true)
void test_pins_are_not_switched_inside_a_move(bool connected)
{
    begin();
    feed(1, RAMP_PULSE);
    judge_connect(&judge, ticks[RAMP_PULSE], 1, connected);
    assert_found(connected ? "is connected at" : "is disconnected at");
}

void test_a_move_that_the_pins_do_not_show_is_judged_but_for_dir(void)
{
    judge_direction(&judge, 0, 1, true);
    judge_connect(&judge, 0, 1, false);
    feed_all();
    assert_none();
}

void test_dir_is_judged_again_when_the_pins_are_connected_again(void)
{
    judge_direction(&judge, 0, 1, true);
    judge_connect(&judge, 0, 1, false);
    judge_connect(&judge, 0, 1, true);
    feed_all();
    assert_found("DIR shows the other way");
}

void test_a_restart_forgets_what_was_begun(void)
{
    begin();
    feed(1, RAMP_PULSE);
    judge_restart(&judge);
    judge_finish(&judge, done_tick);
    assert_none();
}

void test_the_same_complaint_of_one_move_is_told_once(void)
{
    char text[JUDGE_TEXT_BYTES + 32];
    ticks[RAMP_PULSE] += 3;
    ticks[RAMP_PULSE + 1] += 3;
    feed_all();
    judge_tell(&judge, 0, text);
    TEST_ASSERT_NOT_NULL(strstr(text, "(2 times)"));
}
