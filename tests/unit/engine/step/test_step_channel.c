#include "mock_hal_step.h"
#include "step_channel.h"
#include "unity.h"

#include "channel_rig.h"

/* Segments, pulses and marks. */

void setUp(void)
{
    channel_rig_init();
}

void tearDown(void)
{
    channel_rig_check();
}

void test_a_new_channel_rests_at_position_0(void)
{
    TEST_ASSERT_FALSE(step_channel_is_running(&channel));
    TEST_ASSERT_EQUAL_INT64(0, step_channel_position(&channel));
    TEST_ASSERT_EQUAL_UINT64(0, step_channel_pulses(&channel));
    TEST_ASSERT_EQUAL_UINT32(STEP_QUEUE_SEGMENTS, step_channel_room(&channel));
}

void test_a_move_begins_with_its_direction_set(void)
{
    hal_step_set_direction_Stub(NULL);
    hal_step_set_direction_Expect(MOTOR, true);

    step_channel_begin(&channel, START, true);
}

void test_run_lays_the_first_pulse_a_whole_step_after_the_start(void)
{
    begin_move(10);

    TEST_ASSERT_EQUAL_UINT(LAID_AHEAD, laid_waiting());
    TEST_ASSERT_EQUAL_UINT32(START + INTERVAL, laid_next_tick());
}

void test_run_with_nothing_queued_rests(void)
{
    step_channel_begin(&channel, START, false);

    step_channel_run(&channel);

    TEST_ASSERT_FALSE(step_channel_is_running(&channel));
    TEST_ASSERT_EQUAL_UINT(0, laid.laid);
}

void test_after_each_pulse_the_next_one_waits(void)
{
    begin_move(LAID_AHEAD + 2);

    make_pulses(1);

    TEST_ASSERT_EQUAL_UINT32(START + 2 * INTERVAL, laid_next_tick());
    TEST_ASSERT_EQUAL_UINT(LAID_AHEAD, laid_waiting());
}

void test_a_move_has_the_pulses_of_its_segments(void)
{
    begin_two(3, 4);

    TEST_ASSERT_EQUAL_UINT(7, run_to_the_end());
    TEST_ASSERT_EQUAL_UINT(7, laid.laid);
    TEST_ASSERT_EQUAL_UINT32(START + 7 * INTERVAL, laid.last_tick);
}

void test_a_pulse_that_waits_is_not_counted_before_it_is_made(void)
{
    begin_move(3);

    TEST_ASSERT_EQUAL_UINT64(0, step_channel_pulses(&channel));
    TEST_ASSERT_EQUAL_INT64(0, step_channel_position(&channel));
}

void test_a_pulse_forward_adds_a_step(void)
{
    begin_move(3);

    make_pulses(2);

    TEST_ASSERT_EQUAL_INT64(2, step_channel_position(&channel));
    TEST_ASSERT_EQUAL_UINT64(2, step_channel_pulses(&channel));
}

void test_a_pulse_backward_takes_a_step_off(void)
{
    step_channel_set_position(&channel, 1);
    step_channel_begin(&channel, START, true);
    push(0, 3);
    step_channel_run(&channel);

    make_pulses(3);

    TEST_ASSERT_EQUAL_INT64(-2, step_channel_position(&channel));
    TEST_ASSERT_EQUAL_UINT64(3, step_channel_pulses(&channel));
}

void test_the_position_may_be_set_again_and_again(void)
{
    step_channel_set_position(&channel, 100);
    step_channel_set_position(&channel, -7);

    TEST_ASSERT_EQUAL_INT64(-7, step_channel_position(&channel));
}

void test_the_position_goes_on_in_the_next_move_and_the_count_of_pulses_begins_anew(void)
{
    begin_move(5);
    (void)run_to_the_end();

    begin_move(2);
    (void)run_to_the_end();

    TEST_ASSERT_EQUAL_INT64(7, step_channel_position(&channel));
    TEST_ASSERT_EQUAL_UINT64(2, step_channel_pulses(&channel));
}

void test_a_pulse_inside_a_segment_needs_no_attention(void)
{
    begin_move(LAID_AHEAD + 2);

    make_pulses(1);

    TEST_ASSERT_FALSE(laid.main_has_work);
}

void test_a_queue_that_gets_shorter_wants_attention_with_as_much_room_as_it_was_told(void)
{
    step_channel_wake_with(&channel, 10);
    step_channel_begin(&channel, START, false);
    for (uint32_t i = 0; i < STEP_QUEUE_SEGMENTS; i++) {
        push(i, 1);
    }
    step_channel_run(&channel);
    uint32_t room = step_channel_room(&channel);

    while (step_channel_room(&channel) < STEP_QUEUE_SEGMENTS - 2U) {
        make_pulses(1);
        bool wanted = step_channel_room(&channel) != room && step_channel_room(&channel) >= 10U;
        TEST_ASSERT_EQUAL(wanted, laid.main_has_work);
        room = step_channel_room(&channel);
    }
}

/* The backend has been told that there is no more, and would ask again at the last pulse only. */
void test_what_comes_to_a_queue_that_has_run_dry_is_laid_at_once(void)
{
    laid.ahead = 10;
    begin_move(3);
    make_pulses(1);
    TEST_ASSERT_EQUAL_UINT(2, laid_waiting());

    push(3, 4);

    TEST_ASSERT_EQUAL_UINT(6, laid_waiting());
    TEST_ASSERT_EQUAL_UINT(6, run_to_the_end());
}

static void push_unheard(uint32_t pulse, uint32_t steps)
{
    unsigned runs = laid.runs;
    push(pulse, steps);
    TEST_ASSERT_EQUAL_UINT(runs, laid.runs);
}

void test_the_backend_hears_of_what_is_pushed_to_a_queue_that_has_run_dry_alone(void)
{
    begin_move(LAID_AHEAD + 2);
    push_unheard(LAID_AHEAD + 2, 1);
    make_pulses(2);
    push_unheard(LAID_AHEAD + 3, 1);
    (void)run_to_the_end();
    push_unheard(LAID_AHEAD + 4, 1);
}

/* Segments of one pulse: the queue gets shorter with the first question that no way back leads over. */
void test_a_queue_that_gets_shorter_wants_attention(void)
{
    step_channel_begin(&channel, START, false);
    for (uint32_t i = 0; i < STEP_QUEUE_SEGMENTS; i++) {
        push(i, 1);
    }
    step_channel_run(&channel);
    uint32_t room = step_channel_room(&channel);

    while (step_channel_is_running(&channel)) {
        make_pulses(1);
        TEST_ASSERT_TRUE(laid.main_has_work || step_channel_room(&channel) == room);
        room = step_channel_room(&channel);
    }

    TEST_ASSERT_EQUAL_UINT32(STEP_QUEUE_SEGMENTS, room);
}

void test_the_end_of_a_move_wants_attention_and_rests(void)
{
    begin_move(1);

    make_pulses(1);

    TEST_ASSERT_TRUE(laid.main_has_work);
    TEST_ASSERT_FALSE(step_channel_is_running(&channel));
}

void test_the_end_tick_is_that_of_the_last_pulse(void)
{
    begin_move(4);
    (void)run_to_the_end();

    TEST_ASSERT_EQUAL_UINT32(START + 4 * INTERVAL, step_channel_end_tick(&channel));
}

void test_the_end_tick_of_a_move_without_pulses_is_its_start(void)
{
    step_channel_begin(&channel, START, false);
    step_channel_run(&channel);

    TEST_ASSERT_EQUAL_UINT32(START, step_channel_end_tick(&channel));
}

void test_room_shrinks_with_each_push_until_the_queue_is_full(void)
{
    step_channel_begin(&channel, START, false);
    for (uint32_t i = 0; i < STEP_QUEUE_SEGMENTS; i++) {
        TEST_ASSERT_EQUAL_UINT32(STEP_QUEUE_SEGMENTS - i, step_channel_room(&channel));
        push(i, 1);
    }

    TEST_ASSERT_EQUAL_UINT32(0, step_channel_room(&channel));
}

/* Two places are kept, and no pulse waits longer than LAID_AHEAD others. */
void test_a_segment_makes_room_when_no_way_back_leads_over_it(void)
{
    begin_two(2, 4 * LAID_AHEAD);
    TEST_ASSERT_EQUAL_UINT32(STEP_QUEUE_SEGMENTS - 2, step_channel_room(&channel));

    make_pulses(2 + 2 * LAID_AHEAD);

    TEST_ASSERT_EQUAL_UINT32(STEP_QUEUE_SEGMENTS, step_channel_room(&channel));
}

void test_a_full_queue_is_run_to_its_end(void)
{
    step_channel_begin(&channel, START, false);
    for (uint32_t i = 0; i < STEP_QUEUE_SEGMENTS; i++) {
        push(i, 1);
    }
    step_channel_run(&channel);

    TEST_ASSERT_EQUAL_UINT(STEP_QUEUE_SEGMENTS, run_to_the_end());
    TEST_ASSERT_EQUAL_UINT32(START + STEP_QUEUE_SEGMENTS * INTERVAL, step_channel_end_tick(&channel));
}

void test_the_queue_is_a_ring_that_can_be_fed_without_end(void)
{
    enum {
        SEGMENTS = 5 * STEP_QUEUE_SEGMENTS + 1
    };
    begin_two(1, 1);

    for (uint32_t i = 2; i < SEGMENTS; i++) {
        TEST_ASSERT_GREATER_THAN_UINT32(0, step_channel_room(&channel));
        push(i, 1);
        if (i > LAID_AHEAD) {
            make_pulses(1);
        }
    }

    (void)run_to_the_end();
    TEST_ASSERT_EQUAL_UINT64(SEGMENTS, step_channel_pulses(&channel));
    TEST_ASSERT_EQUAL_UINT32(START + SEGMENTS * (uint32_t)INTERVAL, step_channel_end_tick(&channel));
}

void test_a_queue_that_was_fed_too_late_goes_on_from_the_last_pulse(void)
{
    begin_move(3);
    (void)run_to_the_end();

    push(3, 2);
    step_channel_run(&channel);

    TEST_ASSERT_EQUAL_UINT32(START + 4 * INTERVAL, laid_next_tick());
    TEST_ASSERT_EQUAL_UINT(2, run_to_the_end());
    TEST_ASSERT_EQUAL_UINT64(5, step_channel_pulses(&channel));
}

/* The segment's first pulse; however far ahead pulses are laid, it is laid when those before it have been made. */
enum {
    MARKED = LAID_AHEAD + 2
};

static void begin_marked(void)
{
    struct step_segment marked = segment_after(MARKED - 1, 2);
    marked.marked = true;
    step_channel_begin(&channel, START, false);
    push(0, MARKED - 1);
    step_channel_push(&channel, &marked);
    step_channel_run(&channel);
}

void test_a_mark_is_not_seen_before_its_segment_begins(void)
{
    begin_marked();

    make_pulses(MARKED - 2);

    TEST_ASSERT_FALSE(step_channel_take_mark(&channel));
}

void test_a_mark_is_seen_once_when_its_segment_begins(void)
{
    begin_marked();

    make_pulses(MARKED - 1);

    TEST_ASSERT_TRUE(laid.main_has_work);
    TEST_ASSERT_TRUE(step_channel_take_mark(&channel));
    TEST_ASSERT_FALSE(step_channel_take_mark(&channel));
}

void test_a_mark_that_nobody_took_does_not_reach_the_next_move(void)
{
    begin_marked();
    (void)run_to_the_end();

    begin_move(1);

    TEST_ASSERT_FALSE(step_channel_take_mark(&channel));
}
