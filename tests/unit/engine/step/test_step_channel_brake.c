#include <string.h>

#include "mock_hal_step.h"
#include "step_channel.h"
#include "unity.h"

#include "channel_rig.h"

/* The stopgap that brakes at once, and the planned segment that takes its place. */

enum {
    MADE = 5, /* pulses before the stop, of MOVE */
    MOVE = 1000,
    PLANNED = 40,      /* pulses after the next one, as planned */
    GAP = PLANNED / 2, /* and those of the stopgap */
    ACCEL = 2000 * (int32_t)STEP_ACCEL_PER_ACCEL,
    FAST = 3359, /* ticks: above 25 000 steps/s */
};

/* Pulse 5 came on this tick; pulse 6 is the next one. */
enum {
    LAST_TICK = START + MADE * INTERVAL
};

static uint32_t ticks[PLANNED + 2];
static unsigned count;

void setUp(void)
{
    channel_rig_init();
    count = 0;
}

void tearDown(void)
{
    channel_rig_check();
}

static struct step_cursor brake_until(uint64_t until)
{
    struct step_cursor at;
    begin_move(MOVE);
    make_pulses(MADE);
    TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, laid_next_tick(), &at));
    TEST_ASSERT_TRUE(step_channel_brake(&channel, ACCEL, until, &at));
    return at;
}

static struct step_segment planned_after(const struct step_cursor *at, uint32_t steps)
{
    struct step_segment segment = {
        .residual = at->generator.residual,
        .slope = at->generator.slope,
        .accel = -ACCEL,
        .tick = at->generator.tick,
        .steps = steps,
    };
    step_generator_aim(&segment, INTERVAL);
    return segment;
}

/* Makes up to `most` pulses and keeps their ticks. */
static void record(unsigned most)
{
    for (unsigned i = 0; i < most && step_channel_is_running(&channel); i++) {
        TEST_ASSERT_LESS_THAN_UINT(PLANNED + 2, count);
        ticks[count++] = laid_make_pulse();
    }
}

/* The pulses after `at` that were laid before the replacement, `gap` of them, are the stopgap's. */
static void assert_planned_ticks(const struct step_cursor *at, unsigned gap)
{
    struct step_segment segment = planned_after(at, PLANNED);
    struct step_generator generator = at->generator;
    step_generator_load(&generator, &segment);
    TEST_ASSERT_EQUAL_UINT(1 + PLANNED, count);
    TEST_ASSERT_EQUAL_UINT32(at->generator.tick, ticks[0]);
    for (unsigned i = 1; i <= PLANNED; i++) {
        if (i > gap) {
            TEST_ASSERT_EQUAL_UINT32(generator.tick, ticks[i]);
        }
        (void)step_generator_next(&generator);
    }
    TEST_ASSERT_EQUAL_UINT64(MADE + 1 + PLANNED, step_channel_pulses(&channel));
    TEST_ASSERT_EQUAL_INT64(MADE + 1 + PLANNED, step_channel_position(&channel));
}

/* Brakes, makes so many pulses, the next one included, and has the planned segment in the place of the stopgap. */
static void assert_replaced_after(unsigned made)
{
    setUp();
    struct step_cursor at = brake_until(MADE + 1 + GAP);
    record(made);

    struct step_segment segment = planned_after(&at, PLANNED);
    step_channel_replace_brake(&channel, &at, &segment);
    TEST_ASSERT_TRUE(step_channel_is_running(&channel));
    record(PLANNED + 2);

    assert_planned_ticks(&at, 0);
}

void test_a_brake_of_fast_pulses_goes_on_from_the_last_one_made(void)
{
    struct step_segment segment = {.slope = STEP_QUANTA / FAST, .tick = START, .pace_ticks = FAST, .steps = 100};
    struct step_cursor at;
    step_generator_aim(&segment, FAST);
    step_channel_begin(&channel, START, false);
    step_channel_push(&channel, &segment);
    step_channel_run(&channel);
    make_pulses(MADE);
    TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, START, &at));
    make_pulses(1);

    TEST_ASSERT_TRUE(step_channel_brake(&channel, ACCEL, MADE + GAP, &at));

    TEST_ASSERT_EQUAL_UINT64(MADE + 1, step_cursor_pulse(&at));
    TEST_ASSERT_EQUAL_UINT(LAID_AHEAD, laid.back);
    TEST_ASSERT_EQUAL_UINT(GAP - 1, run_to_the_end());
    TEST_ASSERT_GREATER_THAN_UINT32(START + (MADE + GAP) * FAST, laid.last_tick);
}

/* Looks while pulse 5 is the next one, and brakes when it has been made. */
static struct step_cursor brake_at_the_pulse_found(void)
{
    struct step_cursor at;
    begin_move(MOVE);
    make_pulses(MADE - 1);
    TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, laid_next_tick(), &at));
    make_pulses(1);
    TEST_ASSERT_TRUE(step_channel_brake(&channel, ACCEL, MADE + GAP, &at));
    return at;
}

void test_a_brake_takes_the_pulses_back_that_follow_the_one_found(void)
{
    struct step_cursor at = brake_at_the_pulse_found();

    TEST_ASSERT_EQUAL_UINT64(MADE, step_cursor_pulse(&at));
    TEST_ASSERT_EQUAL_UINT32(LAST_TICK, at.generator.tick);
    TEST_ASSERT_EQUAL_UINT64(MADE, step_channel_pulses(&channel));
    TEST_ASSERT_EQUAL_UINT(LAID_AHEAD, laid.back);
    TEST_ASSERT_EQUAL_UINT(LAID_AHEAD, laid_waiting());
    TEST_ASSERT_GREATER_THAN_UINT32(LAST_TICK + INTERVAL, laid_next_tick());
    TEST_ASSERT_EQUAL_UINT(GAP, run_to_the_end());
}

void test_a_brake_that_takes_pulses_back_makes_the_pulses_of_one_in_time(void)
{
    struct step_cursor at = brake_at_the_pulse_found();
    record(GAP);
    uint32_t expected[GAP];
    memcpy(expected, ticks, sizeof expected);

    setUp();
    begin_move(MOVE);
    make_pulses(MADE - 1);
    TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, laid_next_tick(), &at));
    TEST_ASSERT_TRUE(step_channel_brake(&channel, ACCEL, MADE + GAP, &at));
    make_pulses(1);
    record(GAP);

    TEST_ASSERT_EQUAL_UINT32_ARRAY(expected, ticks, GAP);
}

void test_a_brake_goes_on_from_a_pulse_for_which_it_is_too_late(void)
{
    laid.too_late = 1;
    struct step_cursor at = brake_at_the_pulse_found();

    TEST_ASSERT_EQUAL_UINT64(MADE + 1, step_cursor_pulse(&at));
    TEST_ASSERT_EQUAL_UINT(LAID_AHEAD - 1, laid.back);
    TEST_ASSERT_EQUAL_UINT32(LAST_TICK + INTERVAL, laid_next_tick());
}

/* The way from the pulse found leads over the one that cannot be taken back: both brakes begin there. */
void test_a_brake_that_is_too_late_for_a_pulse_makes_the_pulses_of_one_that_found_it(void)
{
    laid.too_late = 1;
    (void)brake_at_the_pulse_found();
    record(GAP);
    uint32_t expected[GAP];
    memcpy(expected, ticks, sizeof expected);

    setUp();
    (void)brake_until(MADE + GAP);
    record(GAP);

    TEST_ASSERT_EQUAL_UINT32_ARRAY(expected, ticks, GAP);
}

static struct step_cursor brake_two_pulses_after_the_one_found(void)
{
    struct step_cursor at;
    begin_move(MOVE);
    make_pulses(MADE - 2);
    TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, laid_next_tick(), &at));
    make_pulses(2);
    TEST_ASSERT_TRUE(step_channel_brake(&channel, ACCEL, MADE + GAP, &at));
    return at;
}

void test_a_brake_two_pulses_after_the_one_found_goes_on_from_the_last_one_made(void)
{
    struct step_cursor at = brake_two_pulses_after_the_one_found();

    TEST_ASSERT_EQUAL_UINT64(MADE, step_cursor_pulse(&at));
    TEST_ASSERT_EQUAL_UINT32(LAST_TICK, at.generator.tick);
    TEST_ASSERT_EQUAL_UINT(LAID_AHEAD, laid.back);
    TEST_ASSERT_EQUAL_UINT(GAP, run_to_the_end());
}

void test_a_brake_two_pulses_after_the_one_found_leaves_what_cannot_be_taken_back(void)
{
    laid.too_late = 1;

    struct step_cursor at = brake_two_pulses_after_the_one_found();

    TEST_ASSERT_EQUAL_UINT64(MADE + 1, step_cursor_pulse(&at));
    TEST_ASSERT_EQUAL_UINT(GAP, run_to_the_end());
}

void test_a_brake_stands_on_the_next_pulse_and_leaves_it_laid(void)
{
    struct step_cursor at = brake_until(MADE + 1 + GAP);

    TEST_ASSERT_EQUAL_UINT64(MADE + 1, step_cursor_pulse(&at));
    TEST_ASSERT_EQUAL_UINT(LAID_AHEAD - 1, laid.back);
    TEST_ASSERT_EQUAL_UINT32(START + (MADE + 1) * INTERVAL, laid_next_tick());
}

void test_a_brake_acts_from_the_next_pulse_on(void)
{
    (void)brake_until(MADE + 1 + GAP);

    record(GAP + 1);

    for (unsigned i = 2; i < count; i++) {
        TEST_ASSERT_GREATER_THAN_UINT32(ticks[i - 1] - ticks[i - 2], ticks[i] - ticks[i - 1]);
    }
}

void test_a_brake_goes_on_until_its_last_pulse_and_drops_what_is_queued(void)
{
    struct step_cursor at;
    begin_two(MADE + 10, 100);
    make_pulses(MADE);
    TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, laid_next_tick(), &at));

    TEST_ASSERT_TRUE(step_channel_brake(&channel, ACCEL, MADE + 20, &at));

    TEST_ASSERT_EQUAL_UINT32(STEP_QUEUE_SEGMENTS, step_channel_room(&channel));
    TEST_ASSERT_EQUAL_UINT(20, run_to_the_end());
    TEST_ASSERT_EQUAL_UINT64(MADE + 20, step_channel_pulses(&channel));
}

void test_a_brake_that_must_end_at_the_next_pulse_or_before_leaves_that_pulse(void)
{
    for (uint64_t until = MADE - 1; until <= MADE + 1; until++) {
        setUp();
        (void)brake_until(until);

        TEST_ASSERT_EQUAL_UINT(1, run_to_the_end());
        TEST_ASSERT_EQUAL_UINT64(MADE + 1, step_channel_pulses(&channel));
        TEST_ASSERT_EQUAL_UINT32(START + (MADE + 1) * INTERVAL, step_channel_end_tick(&channel));
    }
}

void test_a_brake_at_rest_changes_nothing(void)
{
    begin_move(3);
    (void)run_to_the_end();
    push(3, 2);
    struct step_cursor at = {.end = 77};
    struct step_cursor before;
    (void)step_channel_find_pulse(&channel, laid.last_tick, &before);

    TEST_ASSERT_FALSE(step_channel_brake(&channel, ACCEL, 100, &at));

    TEST_ASSERT_EQUAL_UINT64(77, at.end);
    TEST_ASSERT_EQUAL_MEMORY(&before, &channel.cursor, sizeof before);
    TEST_ASSERT_EQUAL_UINT(3, laid.laid);
}

void test_a_brake_closes_the_queue_until_it_is_replaced(void)
{
    struct step_cursor at = brake_until(MADE + 1 + GAP);
    struct step_segment segment = segment_after(MOVE, 7);

    TEST_ASSERT_FALSE(step_channel_push(&channel, &segment));
    TEST_ASSERT_FALSE(step_channel_replace(&channel, &at, &segment, 1));
    TEST_ASSERT_EQUAL_UINT32(STEP_QUEUE_SEGMENTS, step_channel_room(&channel));

    struct step_segment planned = planned_after(&at, PLANNED);
    step_channel_replace_brake(&channel, &at, &planned);
    TEST_ASSERT_TRUE(step_channel_push(&channel, &segment));
}

void test_a_planned_segment_before_the_next_pulse_is_made_has_all_its_pulses(void)
{
    assert_replaced_after(0);
}

void test_a_planned_segment_after_some_pulses_of_the_stopgap_goes_on_as_planned(void)
{
    assert_replaced_after(1);
    assert_replaced_after(2);
    assert_replaced_after(GAP / 2);
    assert_replaced_after(GAP);
}

void test_a_planned_segment_after_a_stopgap_that_ran_out_lays_the_next_pulse(void)
{
    assert_replaced_after(GAP + 1);
}

static void assert_replaced_off_after(unsigned made)
{
    setUp();
    struct step_cursor at = brake_until(MADE + 1 + GAP);
    struct step_cursor off = at;
    off.generator.residual += 3U * off.generator.slope;
    record(made);

    struct step_segment segment = planned_after(&off, PLANNED);
    step_channel_replace_brake(&channel, &at, &segment);
    record(PLANNED + 2);

    assert_planned_ticks(&off, made + LAID_AHEAD - 1);
}

void test_a_planned_segment_goes_on_as_planned_where_the_stopgap_was_some_ticks_off(void)
{
    assert_replaced_off_after(0);
    assert_replaced_off_after(1);
    assert_replaced_off_after(GAP / 2);
}

void test_a_planned_segment_goes_on_with_what_was_queued_after_it(void)
{
    struct step_cursor at = brake_until(MADE + 1 + GAP);
    make_pulses(3);
    struct step_segment segment = planned_after(&at, PLANNED);
    step_channel_replace_brake(&channel, &at, &segment);
    segment = segment_after(MOVE, 7);
    step_channel_push(&channel, &segment);

    (void)run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(MADE + 1 + PLANNED + 7, step_channel_pulses(&channel));
    TEST_ASSERT_EQUAL_UINT32(START + (MOVE + 7) * (uint32_t)INTERVAL, step_channel_end_tick(&channel));
}

void test_a_planned_segment_with_no_more_pulses_than_were_made_rests(void)
{
    struct step_cursor at = brake_until(MADE + 1 + GAP);
    (void)run_to_the_end();
    uint32_t before = laid.laid;

    struct step_segment segment = planned_after(&at, GAP);
    step_channel_replace_brake(&channel, &at, &segment);

    TEST_ASSERT_FALSE(step_channel_is_running(&channel));
    TEST_ASSERT_EQUAL_UINT32(before, laid.laid);
    TEST_ASSERT_EQUAL_UINT64(MADE + 1 + GAP, step_channel_pulses(&channel));
}

void test_a_planned_segment_whose_last_pulse_waits_ends_with_it(void)
{
    struct step_cursor at = brake_until(MADE + 1 + GAP);
    make_pulses(GAP);

    struct step_segment segment = planned_after(&at, GAP);
    step_channel_replace_brake(&channel, &at, &segment);

    TEST_ASSERT_EQUAL_UINT(1, run_to_the_end());
    TEST_ASSERT_EQUAL_UINT64(MADE + 1 + GAP, step_channel_pulses(&channel));
}

static void replace_by_marked(const struct step_cursor *at)
{
    struct step_segment segment = planned_after(at, PLANNED);
    segment.marked = true;
    step_channel_replace_brake(&channel, at, &segment);
}

void test_a_mark_of_a_planned_segment_is_seen_when_its_first_pulse_is_laid(void)
{
    laid.ahead = 1;
    struct step_cursor at = brake_until(MADE + 1 + GAP);

    replace_by_marked(&at);

    TEST_ASSERT_FALSE(step_channel_take_mark(&channel));
    make_pulses(1);
    TEST_ASSERT_TRUE(step_channel_take_mark(&channel));
}

void test_a_mark_of_a_planned_segment_is_seen_at_once_if_that_pulse_has_been_laid(void)
{
    struct step_cursor at = brake_until(MADE + 1 + GAP);
    make_pulses(1);

    replace_by_marked(&at);

    TEST_ASSERT_TRUE(step_channel_take_mark(&channel));
    TEST_ASSERT_EQUAL_UINT(PLANNED, run_to_the_end());
    TEST_ASSERT_FALSE(step_channel_take_mark(&channel));
}

void test_a_mark_of_a_planned_segment_after_the_last_pulse_of_the_stopgap_is_seen_at_once(void)
{
    struct step_cursor at = brake_until(MADE + 1);
    make_pulses(1);
    TEST_ASSERT_FALSE(step_channel_is_running(&channel));

    replace_by_marked(&at);

    TEST_ASSERT_TRUE(step_channel_take_mark(&channel));
    TEST_ASSERT_EQUAL_UINT(PLANNED, run_to_the_end());
}

/* No way leads back along the stopgap, but the pulse before the one that waits is known. */
void test_a_halt_on_a_planned_segment_ends_with_the_last_pulse_made(void)
{
    laid.ahead = 1;
    struct step_cursor at = brake_until(MADE + 1 + GAP);
    record(3);
    struct step_segment segment = planned_after(&at, PLANNED);
    step_channel_replace_brake(&channel, &at, &segment);

    step_channel_halt(&channel);

    TEST_ASSERT_FALSE(step_channel_is_running(&channel));
    TEST_ASSERT_EQUAL_UINT64(MADE + 3, step_channel_pulses(&channel));
    TEST_ASSERT_EQUAL_UINT32(ticks[2], step_channel_end_tick(&channel));
}
