#include "mock_hal_step.h"
#include "step_channel.h"
#include "unity.h"

#include "channel_rig.h"

/* The pulse at which a stop can act. */

enum {
    MADE = 5, /* pulses, of MOVE */
    MOVE = 1000,
    ACCEL = 2000 * (int32_t)STEP_ACCEL_PER_ACCEL,
    FAST_ACCEL = STEP_ACCEL_MAX * STEP_ACCEL_PER_ACCEL,
};

void setUp(void)
{
    channel_rig_init();
}

void tearDown(void)
{
    channel_rig_check();
}

void test_a_search_tells_the_next_pulse(void)
{
    struct step_cursor cursor;
    begin_move(MOVE);
    make_pulses(MADE);

    TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, laid_next_tick(), &cursor));

    TEST_ASSERT_EQUAL_UINT64(MADE + 1, step_cursor_pulse(&cursor));
    TEST_ASSERT_EQUAL_UINT32(laid_next_tick(), cursor.generator.tick);
}

void test_a_search_at_rest_tells_the_last_pulse_and_that_none_is_to_come(void)
{
    struct step_cursor cursor;
    begin_move(3);
    (void)run_to_the_end();

    TEST_ASSERT_FALSE(step_channel_find_pulse(&channel, laid.last_tick, &cursor));

    TEST_ASSERT_EQUAL_UINT64(3, step_cursor_pulse(&cursor));
    TEST_ASSERT_EQUAL_UINT32(START + 3 * INTERVAL, cursor.generator.tick);
}

/* Pulse 5 came on this tick; pulse 6 is the next one. */
enum {
    LAST_TICK = START + MADE * INTERVAL
};

void test_the_pulse_found_is_the_one_before_the_next_if_that_came_after_the_moment(void)
{
    struct step_cursor cursor;
    begin_move(MOVE);
    make_pulses(MADE);

    TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, LAST_TICK - 1, &cursor));
    TEST_ASSERT_EQUAL_UINT64(MADE, step_cursor_pulse(&cursor));
    TEST_ASSERT_EQUAL_UINT32(LAST_TICK, cursor.generator.tick);

    TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, LAST_TICK, &cursor));
    TEST_ASSERT_EQUAL_UINT64(MADE + 1, step_cursor_pulse(&cursor));
}

void test_a_search_before_the_first_pulse_of_a_move_tells_that_one(void)
{
    struct step_cursor cursor;
    begin_move(MOVE);

    TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, START - 1000, &cursor));

    TEST_ASSERT_EQUAL_UINT64(1, step_cursor_pulse(&cursor));
}

/* Pulses 1 to 10 on a ramp up from 1000 steps/s, and 11 to 20 on one down. */
static void begin_up_and_down(void)
{
    step_channel_begin(&channel, START, false);
    struct step_segment up = segment_after(0, 10);
    up.accel = ACCEL;
    step_channel_push(&channel, &up);
    struct step_segment down = {.slope = up.slope, .accel = -ACCEL, .tick = START + 10 * INTERVAL, .steps = 10};
    step_generator_aim(&down, INTERVAL);
    step_channel_push(&channel, &down);
    step_channel_run(&channel);
}

void test_a_search_goes_back_to_any_pulse_and_over_the_border_of_two_segments(void)
{
    struct step_cursor last;
    struct step_cursor cursor;
    begin_up_and_down();
    for (uint64_t pulse = 1; pulse < 20; pulse++) {
        TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, laid_next_tick(), &last));
        make_pulses(1);

        TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, last.generator.tick - 1U, &cursor));

        TEST_ASSERT_EQUAL_UINT64(pulse, step_cursor_pulse(&cursor));
        TEST_ASSERT_EQUAL_UINT32(last.generator.tick, cursor.generator.tick);
        TEST_ASSERT_EQUAL_HEX64(last.generator.residual, cursor.generator.residual);
        TEST_ASSERT_EQUAL_HEX64(last.generator.slope, cursor.generator.slope);
        TEST_ASSERT_EQUAL_INT32(last.generator.accel, cursor.generator.accel);
    }
}

static void begin_fast_move(uint32_t interval)
{
    struct step_segment segment = {
        .slope = STEP_QUANTA / interval, .tick = START, .pace_ticks = interval, .steps = 100};
    step_generator_aim(&segment, interval);
    step_channel_begin(&channel, START, false);
    step_channel_push(&channel, &segment);
    step_channel_run(&channel);
    make_pulses(MADE);
}

static struct step_cursor look_at_start(void)
{
    struct step_cursor cursor;
    TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, START, &cursor));
    return cursor;
}

void test_a_search_goes_back_at_up_to_25_000_steps_per_s(void)
{
    begin_fast_move(3360);

    struct step_cursor cursor = look_at_start();

    TEST_ASSERT_EQUAL_UINT64(MADE, step_cursor_pulse(&cursor));
}

void test_a_search_at_faster_pulses_tells_the_next_one(void)
{
    begin_fast_move(3359);

    struct step_cursor cursor = look_at_start();

    TEST_ASSERT_EQUAL_UINT64(MADE + 1, step_cursor_pulse(&cursor));
}

/* 200 000 steps/s; the way leads over pulses that are skipped. */
void test_a_search_over_many_fast_pulses_tells_the_next_one_and_its_interval(void)
{
    begin_fast_move(420);
    for (uint32_t made = MADE; made < 99; made++) {
        struct step_cursor cursor = look_at_start();

        TEST_ASSERT_EQUAL_UINT64(made + 1U, step_cursor_pulse(&cursor));
        TEST_ASSERT_EQUAL_UINT32(START + (made + 1U) * 420U, cursor.generator.tick);
        TEST_ASSERT_EQUAL_UINT32(420, cursor.generator.interval);
        make_pulses(1);
    }
}

/* From 100 000 steps/s on, as steep as can be. */
static struct step_segment begin_fast_ramp(void)
{
    struct step_segment up = {.slope = STEP_QUANTA / 840, .accel = FAST_ACCEL, .tick = START, .steps = 100};
    step_generator_aim(&up, 840);
    laid.ahead = 20;
    step_channel_begin(&channel, START, false);
    step_channel_push(&channel, &up);
    step_channel_run(&channel);
    return up;
}

void test_a_search_over_many_fast_pulses_of_a_ramp_tells_the_interval_of_the_next_one(void)
{
    struct step_segment up = begin_fast_ramp();
    struct step_generator expected = {.tick = START};
    step_generator_load(&expected, &up);
    for (uint32_t made = 0; made < 99; made++) {
        struct step_cursor cursor = look_at_start();

        TEST_ASSERT_EQUAL_UINT64(made + 1U, step_cursor_pulse(&cursor));
        TEST_ASSERT_EQUAL_UINT32(expected.tick, cursor.generator.tick);
        TEST_ASSERT_EQUAL_UINT32(expected.interval, cursor.generator.interval);
        (void)step_generator_next(&expected);
        make_pulses(1);
    }
}

/* The way to the last pulse that stays leads over pulses that are skipped. */
void test_a_halt_one_pulse_before_a_brake_that_came_late_ends_on_the_tick_of_the_last_pulse(void)
{
    for (unsigned late = 2; late < 15; late++) {
        setUp();
        (void)begin_fast_ramp();
        struct step_cursor at = look_at_start();
        laid.too_late = late;
        TEST_ASSERT_TRUE(step_channel_brake(&channel, FAST_ACCEL, 90, &at));
        TEST_ASSERT_EQUAL_UINT64(late, step_cursor_pulse(&at));
        make_pulses(late - 1U);
        laid.too_late = 0;
        step_channel_halt(&channel);

        TEST_ASSERT_EQUAL_UINT64(late - 1U, step_channel_pulses(&channel));
        TEST_ASSERT_EQUAL_UINT32(laid.last_tick, step_channel_end_tick(&channel));
    }
}

void test_a_search_after_the_last_pulse_of_which_the_channel_has_not_heard_tells_that_one(void)
{
    struct step_cursor cursor;
    begin_move(3);
    make_pulses(2);
    laid.made++;

    TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, START + 3 * INTERVAL, &cursor));

    TEST_ASSERT_EQUAL_UINT64(3, step_cursor_pulse(&cursor));
}
