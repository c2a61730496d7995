#include <string.h>

#include "mock_hal_step.h"
#include "step_channel.h"
#include "unity.h"

#include "channel_rig.h"

/* What ends or changes the pulses that are queued. */

void setUp(void)
{
    channel_rig_init();
}

void tearDown(void)
{
    channel_rig_check();
}

/* Twice as fast. */
static struct step_segment fast_after(uint32_t pulse, uint32_t steps)
{
    struct step_segment segment = {
        .slope = STEP_QUANTA / INTERVAL * 2U,
        .tick = START + pulse * INTERVAL,
        .pace_ticks = INTERVAL / 2,
        .steps = steps,
    };
    step_generator_aim(&segment, INTERVAL / 2);
    return segment;
}

static struct step_cursor look_ahead_at(uint32_t pulse)
{
    struct step_cursor cursor;
    TEST_ASSERT_TRUE(step_channel_look_ahead(&channel, START + pulse * INTERVAL, &cursor));
    TEST_ASSERT_EQUAL_UINT64(pulse, step_cursor_pulse(&cursor));
    return cursor;
}

void test_a_resting_channel_has_nothing_ahead(void)
{
    struct step_cursor cursor;
    step_channel_begin(&channel, START, false);

    TEST_ASSERT_FALSE(step_channel_look_ahead(&channel, START, &cursor));
}

void test_the_next_pulse_is_found_ahead_where_no_time_is_needed(void)
{
    struct step_cursor cursor;
    begin_move(5);
    make_pulses(1);

    TEST_ASSERT_TRUE(step_channel_look_ahead(&channel, START + INTERVAL, &cursor));
    TEST_ASSERT_EQUAL_UINT64(2, step_cursor_pulse(&cursor));
    TEST_ASSERT_EQUAL_UINT32(START + 2 * INTERVAL, cursor.generator.tick);
}

void test_a_pulse_that_is_due_at_the_tick_itself_is_found_ahead(void)
{
    struct step_cursor cursor;
    begin_move(5);

    TEST_ASSERT_TRUE(step_channel_look_ahead(&channel, START + 3 * INTERVAL, &cursor));
    TEST_ASSERT_EQUAL_UINT64(3, step_cursor_pulse(&cursor));
    TEST_ASSERT_TRUE(step_channel_look_ahead(&channel, START + 3 * INTERVAL + 1, &cursor));
    TEST_ASSERT_EQUAL_UINT64(4, step_cursor_pulse(&cursor));
}

void test_pulses_of_later_segments_are_found_ahead(void)
{
    begin_two(2, 5);

    struct step_cursor cursor = look_ahead_at(6);

    TEST_ASSERT_EQUAL_UINT32(START + 6 * INTERVAL, cursor.generator.tick);
}

void test_nothing_is_found_ahead_after_the_last_pulse(void)
{
    struct step_cursor cursor;
    begin_two(2, 3);

    TEST_ASSERT_TRUE(step_channel_look_ahead(&channel, START + 5 * INTERVAL, &cursor));
    TEST_ASSERT_FALSE(step_channel_look_ahead(&channel, START + 5 * INTERVAL + 1, &cursor));
}

void test_looking_ahead_changes_nothing(void)
{
    begin_two(2, 5);

    (void)look_ahead_at(6);

    TEST_ASSERT_EQUAL_UINT(7, run_to_the_end());
    TEST_ASSERT_EQUAL_UINT(7, laid.laid);
    TEST_ASSERT_EQUAL_UINT(0, laid.back);
}

/* Looks ahead, replaces there, and lets two fast pulses follow. */
static bool cut_at(const struct step_cursor *cursor)
{
    struct step_segment segment = fast_after((uint32_t)step_cursor_pulse(cursor), 2);
    return step_channel_replace(&channel, cursor, &segment, 1);
}

static void assert_replaced_after(uint32_t pulse)
{
    (void)run_to_the_end();
    TEST_ASSERT_EQUAL_UINT64(pulse + 2U, step_channel_pulses(&channel));
    TEST_ASSERT_EQUAL_UINT32(START + (pulse + 1U) * INTERVAL, step_channel_end_tick(&channel));
}

void test_a_replacement_at_the_next_pulse_takes_effect_after_it(void)
{
    begin_two(4, 4);
    make_pulses(1);
    struct step_cursor cursor = look_ahead_at(2);

    TEST_ASSERT_TRUE(cut_at(&cursor));

    assert_replaced_after(2);
}

void test_a_replacement_at_a_later_pulse_keeps_the_pulses_before_it(void)
{
    begin_two(4, 4);
    struct step_cursor cursor = look_ahead_at(3);

    TEST_ASSERT_TRUE(cut_at(&cursor));

    assert_replaced_after(3);
}

void test_a_replacement_at_the_last_pulse_of_a_segment_drops_the_next_one(void)
{
    begin_two(4, 4);
    struct step_cursor cursor = look_ahead_at(4);

    TEST_ASSERT_TRUE(cut_at(&cursor));

    assert_replaced_after(4);
}

void test_a_replacement_inside_a_later_segment_shortens_it(void)
{
    begin_two(4, 4);
    struct step_cursor cursor = look_ahead_at(5);

    TEST_ASSERT_TRUE(cut_at(&cursor));

    assert_replaced_after(5);
}

void test_a_replacement_after_several_segments_keeps_them_whole(void)
{
    begin_two(2, 2);
    push(4, 3);
    push(7, 3);
    struct step_cursor cursor = look_ahead_at(7);

    TEST_ASSERT_TRUE(cut_at(&cursor));

    assert_replaced_after(7);
}

void test_a_replacement_is_in_time_until_the_looked_up_pulse_has_been_made(void)
{
    begin_two(4, 4);
    struct step_cursor cursor = look_ahead_at(6);
    make_pulses(5);

    TEST_ASSERT_TRUE(cut_at(&cursor));

    assert_replaced_after(6);
}

void test_a_replacement_that_comes_too_late_is_refused_and_changes_nothing(void)
{
    begin_two(4, 4);
    struct step_cursor cursor = look_ahead_at(3);
    make_pulses(3);
    struct step_channel before;
    memcpy(&before, &channel, sizeof before);

    TEST_ASSERT_FALSE(cut_at(&cursor));

    TEST_ASSERT_EQUAL_MEMORY(&before, &channel, sizeof before);
    TEST_ASSERT_EQUAL_UINT(5, run_to_the_end());
}

void test_a_replacement_after_the_end_is_refused(void)
{
    begin_move(3);
    struct step_cursor cursor = look_ahead_at(3);
    (void)run_to_the_end();

    TEST_ASSERT_FALSE(cut_at(&cursor));

    TEST_ASSERT_EQUAL_UINT32(STEP_QUEUE_SEGMENTS, step_channel_room(&channel));
}

void test_a_replacement_without_new_segments_ends_the_move_there(void)
{
    begin_two(4, 4);
    struct step_cursor cursor = look_ahead_at(6);

    TEST_ASSERT_TRUE(step_channel_replace(&channel, &cursor, NULL, 0));

    TEST_ASSERT_EQUAL_UINT(6, run_to_the_end());
}

void test_a_replacement_hands_over_all_segments_that_are_to_follow(void)
{
    begin_two(4, 4);
    struct step_cursor cursor = look_ahead_at(3);
    const struct step_segment segments[] = {segment_after(3, 2), segment_after(5, 6)};

    TEST_ASSERT_TRUE(step_channel_replace(&channel, &cursor, segments, 2));

    TEST_ASSERT_EQUAL_UINT(3 + 2 + 6, run_to_the_end());
    TEST_ASSERT_EQUAL_UINT32(START + 11 * INTERVAL, step_channel_end_tick(&channel));
}

/* One segment for each pulse, as many as there is room for. */
static void begin_full(void)
{
    step_channel_begin(&channel, START, false);
    for (uint32_t i = 0; i < STEP_QUEUE_SEGMENTS; i++) {
        push(i, 1);
    }
    step_channel_run(&channel);
}

void test_a_replacement_that_finds_no_room_after_its_pulse_changes_nothing(void)
{
    begin_full();
    struct step_cursor last = look_ahead_at(STEP_QUEUE_SEGMENTS);
    struct step_cursor before = look_ahead_at(STEP_QUEUE_SEGMENTS - 1);

    TEST_ASSERT_FALSE(cut_at(&last));
    TEST_ASSERT_EQUAL_UINT32(0, step_channel_room(&channel));
    TEST_ASSERT_EQUAL_UINT(0, laid.back);
    TEST_ASSERT_TRUE(cut_at(&before));

    TEST_ASSERT_EQUAL_UINT(STEP_QUEUE_SEGMENTS + 1, run_to_the_end());
}

/* The segment that is cut keeps its place while a way back leads over it. */
void test_a_replacement_gives_the_room_of_what_it_dropped_back(void)
{
    begin_full();
    struct step_cursor cursor = look_ahead_at(1);

    TEST_ASSERT_TRUE(cut_at(&cursor));

    TEST_ASSERT_EQUAL_UINT32(STEP_QUEUE_SEGMENTS - 2, step_channel_room(&channel));
}

void test_a_halt_takes_all_pulses_back_that_wait(void)
{
    begin_two(4, 4);
    make_pulses(2);

    step_channel_halt(&channel);

    TEST_ASSERT_FALSE(step_channel_is_running(&channel));
    TEST_ASSERT_EQUAL_UINT64(2, step_channel_pulses(&channel));
    TEST_ASSERT_EQUAL_INT64(2, step_channel_position(&channel));
    TEST_ASSERT_EQUAL_UINT32(START + 2 * INTERVAL, step_channel_end_tick(&channel));
}

void test_a_halt_before_the_first_pulse_ends_at_the_start(void)
{
    begin_move(4);

    step_channel_halt(&channel);

    TEST_ASSERT_EQUAL_UINT64(0, step_channel_pulses(&channel));
    TEST_ASSERT_EQUAL_UINT32(START, step_channel_end_tick(&channel));
}

void test_a_halt_drops_what_is_queued(void)
{
    begin_two(4, 4);

    step_channel_halt(&channel);
    step_channel_run(&channel);

    TEST_ASSERT_FALSE(step_channel_is_running(&channel));
    TEST_ASSERT_EQUAL_UINT32(STEP_QUEUE_SEGMENTS, step_channel_room(&channel));
}

void test_a_halt_closes_the_queue_until_the_next_move(void)
{
    const struct step_segment segment = segment_after(1, 5);
    begin_move(4);
    step_channel_halt(&channel);

    TEST_ASSERT_FALSE(step_channel_push(&channel, &segment));
    TEST_ASSERT_EQUAL_UINT32(STEP_QUEUE_SEGMENTS, step_channel_room(&channel));

    begin_move(4);
    TEST_ASSERT_EQUAL_UINT(4, run_to_the_end());
}

void test_a_halt_at_rest_drops_what_is_queued_and_closes_the_queue(void)
{
    const struct step_segment segment = segment_after(5, 5);
    begin_move(3);
    (void)run_to_the_end();
    push(3, 2);

    step_channel_halt(&channel);

    TEST_ASSERT_EQUAL_UINT32(STEP_QUEUE_SEGMENTS, step_channel_room(&channel));
    TEST_ASSERT_FALSE(step_channel_push(&channel, &segment));
    TEST_ASSERT_EQUAL_UINT64(3, step_channel_pulses(&channel));
}

/* The hardware is about to make the edge when it is asked to take it back. */
void test_a_halt_that_is_too_late_for_a_pulse_ends_with_it(void)
{
    begin_two(4, 4);
    make_pulses(2);
    laid.too_late = 1;

    step_channel_halt(&channel);
    TEST_ASSERT_TRUE(step_channel_is_running(&channel));
    make_pulses(1);

    TEST_ASSERT_FALSE(step_channel_is_running(&channel));
    TEST_ASSERT_EQUAL_INT64(3, step_channel_position(&channel));
    TEST_ASSERT_EQUAL_UINT32(START + 3 * INTERVAL, step_channel_end_tick(&channel));
}

void test_a_halt_at_rest_does_nothing(void)
{
    begin_move(2);
    (void)run_to_the_end();
    hal_step_take_back_Stub(NULL);

    step_channel_halt(&channel);

    TEST_ASSERT_EQUAL_UINT64(2, step_channel_pulses(&channel));
    TEST_ASSERT_EQUAL_UINT32(START + 2 * INTERVAL, step_channel_end_tick(&channel));
}
