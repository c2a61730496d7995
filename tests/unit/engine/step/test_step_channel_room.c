#include <string.h>

#include "mock_hal_step.h"
#include "step_channel.h"
#include "unity.h"

#include "channel_rig.h"

/* What a backend asks for and gets, and the room in the queue while pulses can be taken back. */

enum {
    PLACES = 16,
    UNTOUCHED = 0x55,
};

static struct hal_step_pulse pulse[PLACES + 1];

void setUp(void)
{
    channel_rig_init();
    memset(pulse, UNTOUCHED, sizeof pulse);
}

void tearDown(void)
{
    channel_rig_check();
}

/* The rig asks for nothing by itself. */
static void begin_unasked(uint32_t first, uint32_t second)
{
    laid.ahead = 0;
    begin_two(first, second);
}

static struct hal_step_room room_until(uint32_t until_tick, unsigned count)
{
    return (struct hal_step_room){
        .pulse = pulse, .count = count, .until_tick = until_tick, .high_ticks = LAID_HIGH_TICKS};
}

static void assert_pulses(unsigned first, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_UINT32(START + (first + i) * INTERVAL, pulse[i].rise_tick);
        TEST_ASSERT_EQUAL_UINT32(pulse[i].rise_tick + LAID_HIGH_TICKS, pulse[i].fall_tick);
    }
    TEST_ASSERT_EACH_EQUAL_HEX8(UNTOUCHED, &pulse[count], (PLACES + 1U - count) * sizeof *pulse);
}

void test_no_more_pulses_are_laid_than_there_are_places(void)
{
    for (unsigned count = 1; count <= PLACES; count++) {
        setUp();
        begin_unasked(5, 50);
        struct hal_step_room room = room_until(START + 100 * INTERVAL, count);

        TEST_ASSERT_EQUAL_UINT(count, step_channel_lay_isr(&channel, &room));

        assert_pulses(1, count);
    }
}

/* On the tick of pulse k, one before and one after it. */
void test_no_pulse_is_laid_after_the_first_that_is_due_at_the_end_or_later(void)
{
    for (unsigned k = 1; k < PLACES; k++) {
        for (unsigned off = 0; off <= 2; off++) {
            setUp();
            begin_unasked(5, 50);
            struct hal_step_room room = room_until(START + k * INTERVAL + off - 1U, PLACES);
            unsigned count = off == 2 ? k + 1U : k;

            TEST_ASSERT_EQUAL_UINT(count, step_channel_lay_isr(&channel, &room));

            assert_pulses(1, count);
        }
    }
}

void test_a_pulse_is_laid_even_if_it_is_due_after_the_end(void)
{
    begin_unasked(5, 50);
    struct hal_step_room room = room_until(START - 10, PLACES);

    TEST_ASSERT_EQUAL_UINT(1, step_channel_lay_isr(&channel, &room));
    assert_pulses(1, 1);
}

void test_a_question_at_the_end_of_the_queue_gets_what_is_left_and_then_nothing(void)
{
    begin_unasked(5, 3);
    struct hal_step_room room = room_until(START + 100 * INTERVAL, PLACES);
    TEST_ASSERT_EQUAL_UINT(8, step_channel_lay_isr(&channel, &room));
    assert_pulses(1, 8);
    room.waiting = 8;
    TEST_ASSERT_EQUAL_UINT(0, step_channel_lay_isr(&channel, &room));
    TEST_ASSERT_TRUE(step_channel_is_running(&channel));
    room.main_has_work = false;
    room.waiting = 0;

    TEST_ASSERT_EQUAL_UINT(0, step_channel_lay_isr(&channel, &room));

    TEST_ASSERT_FALSE(step_channel_is_running(&channel));
    TEST_ASSERT_TRUE(room.main_has_work);
}

void test_a_queue_fed_while_the_last_pulses_wait_goes_on_with_the_next_question(void)
{
    begin_unasked(5, 3);
    struct hal_step_room room = room_until(START + 100 * INTERVAL, PLACES);
    TEST_ASSERT_EQUAL_UINT(8, step_channel_lay_isr(&channel, &room));
    room.waiting = 2;
    TEST_ASSERT_EQUAL_UINT(0, step_channel_lay_isr(&channel, &room));
    push(8, 4);

    TEST_ASSERT_EQUAL_UINT(4, step_channel_lay_isr(&channel, &room));

    TEST_ASSERT_EQUAL_UINT32(START + 9 * INTERVAL, pulse[0].rise_tick);
    TEST_ASSERT_EQUAL_UINT32(START + 12 * INTERVAL, pulse[3].rise_tick);
}

static uint32_t feed_from(uint32_t pushed, uint32_t segments)
{
    while (pushed < segments && step_channel_room(&channel) > 0) {
        push(pushed++, 1);
    }
    return pushed;
}

/* Segments of one pulse, as many as there is room for. Before each pulse is made some of those that wait are taken back
 * and laid again; which ones are left to chance. If all but the next one are, what is queued after it is dropped. */
static void feed_and_take_back(unsigned ahead, uint32_t segments)
{
    uint32_t chance = 1;
    laid.ahead = ahead;
    begin_move(1);
    uint32_t pushed = feed_from(1, segments);
    while (step_channel_is_running(&channel)) {
        struct step_cursor at;
        uint32_t next = START + (laid.made + 1U) * INTERVAL;
        chance = chance * 1664525U + 1013904223U;
        laid.too_late = 1U + (chance >> 16U) % ahead;
        TEST_ASSERT_TRUE(step_channel_look_ahead(&channel, next, &at));
        TEST_ASSERT_EQUAL_UINT32(next, at.generator.tick);
        TEST_ASSERT_EQUAL_UINT64(laid.made + 1U, step_cursor_pulse(&at));
        if (step_channel_replace(&channel, &at, NULL, 0)) {
            pushed = laid.made + 1U;
        }
        pushed = feed_from(pushed, segments);
        TEST_ASSERT_EQUAL_UINT32(next, laid_make_pulse());
    }
    TEST_ASSERT_EQUAL_UINT64(segments, step_channel_pulses(&channel));
}

void test_no_segment_is_overwritten_that_a_way_back_leads_over(void)
{
    for (unsigned ahead = 1; ahead <= STEP_QUEUE_SEGMENTS / 2; ahead++) {
        setUp();
        feed_and_take_back(ahead, 10 * STEP_QUEUE_SEGMENTS);
    }
}

/* While the pulses of the queue's last places wait, the first ones get free in time for more. */
static void make_room_for(uint32_t segments)
{
    uint32_t pushed = 1;
    begin_move(1);
    for (uint32_t made = 0; made < segments; made++) {
        while (step_channel_room(&channel) > 0) {
            push(pushed++, 1);
        }
        make_pulses(1);
        TEST_ASSERT_TRUE(laid_waiting() == laid.ahead || made == 0);
    }
    (void)run_to_the_end();
}

void test_segments_make_room_while_as_many_pulses_wait_as_ever(void)
{
    laid.ahead = STEP_QUEUE_SEGMENTS / 4;
    make_room_for(5 * STEP_QUEUE_SEGMENTS);
}

void test_segments_make_room_in_each_move(void)
{
    for (uint32_t first = 5 * STEP_QUEUE_SEGMENTS; first < 5 * STEP_QUEUE_SEGMENTS + 4; first++) {
        setUp();
        make_room_for(first);
        make_room_for(3 * STEP_QUEUE_SEGMENTS);
    }
}

void test_a_segment_makes_room_with_the_first_question_after_the_one_at_which_it_was_over(void)
{
    begin_unasked(1, 1);
    push(2, 1);
    for (unsigned waiting = 0; waiting < 3; waiting++) {
        struct hal_step_room room = room_until(START + 100 * INTERVAL, 1);
        room.waiting = waiting == 2;
        TEST_ASSERT_EQUAL_UINT(1, step_channel_lay_isr(&channel, &room));
        TEST_ASSERT_EQUAL_UINT32(STEP_QUEUE_SEGMENTS - (waiting == 2 ? 2 : 3), step_channel_room(&channel));
    }
}

static void begin_marked(unsigned ahead)
{
    struct step_segment marked = segment_after(4, 20);
    marked.marked = true;
    laid.ahead = ahead;
    step_channel_begin(&channel, START, false);
    push(0, 4);
    step_channel_push(&channel, &marked);
    step_channel_run(&channel);
}

void test_a_mark_is_seen_when_all_before_it_has_been_made_however_far_ahead_pulses_are_laid(void)
{
    for (unsigned ahead = 1; ahead <= 6; ahead++) {
        setUp();
        begin_marked(ahead);
        for (unsigned made = 0; made < 10; made++) {
            TEST_ASSERT_EQUAL(made == 4, step_channel_take_mark(&channel));
            make_pulses(1);
        }
    }
}

void test_a_mark_wakes_main_however_much_room_it_waits_for(void)
{
    step_channel_wake_with(&channel, STEP_QUEUE_SEGMENTS + 1);
    begin_marked(6);
    for (unsigned made = 1; made < 10; made++) {
        make_pulses(1);
        TEST_ASSERT_EQUAL(made == 4, laid.main_has_work);
    }
}

/* Main may not have looked yet. */
void test_a_mark_outlives_that_its_pulses_are_taken_back_and_laid_again(void)
{
    struct step_cursor at;
    begin_marked(6);
    make_pulses(4);
    TEST_ASSERT_TRUE(step_channel_look_ahead(&channel, START + 5 * INTERVAL, &at));
    laid.too_late = 2;
    TEST_ASSERT_FALSE(step_channel_replace(&channel, &at, NULL, 0));
    TEST_ASSERT_EQUAL_UINT(4, laid.back);

    TEST_ASSERT_TRUE(step_channel_take_mark(&channel));
}

/* What comes instead of the pulses that are dropped needs a place. */
void test_a_full_queue_is_frozen_only_where_a_place_gets_free(void)
{
    begin_unasked(5, 50);
    for (uint32_t before = 55; step_channel_room(&channel) != 0; before += 2) {
        push(before, 2);
    }
    TEST_ASSERT_FALSE(step_channel_freeze(&channel, 0));
    TEST_ASSERT_FALSE(step_channel_freeze(&channel, 1));
    TEST_ASSERT_TRUE(step_channel_freeze(&channel, 2));
}
