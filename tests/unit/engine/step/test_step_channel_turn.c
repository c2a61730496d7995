#include "mock_hal_step.h"
#include "step_channel.h"
#include "unity.h"

#include "channel_rig.h"

/* Pulses both ways in one move, laid ahead, frozen, recalled: each at its tick, and the position is what was made. */

enum {
    PIECES = 5,
    TOTAL = 15,
    AHEAD = 20,
    NEW_STEPS = 3,
    FAST_TICKS = 420, /* 200 000 steps/s: some pulses are skipped at once on the way back */
    FAST_STEPS = 35,
    FAST_AHEAD = 50
};

static const struct {
    uint32_t steps;
    bool backward;
} pieces[PIECES] = {{3, false}, {2, false}, {4, true}, {1, true}, {5, false}};

static int64_t position[TOTAL + 1]; /* after pulse k */

static void thaw(void)
{
    hal_step_hold();
    step_channel_thaw_held(&channel);
    hal_step_release();
}

static void begin_pieces(unsigned ahead)
{
    uint32_t pulse = 0;
    channel_rig_init();
    laid.ahead = ahead;
    step_channel_begin(&channel, START, false);
    for (unsigned i = 0; i < PIECES; i++) {
        step_channel_turn(&channel, pieces[i].backward);
        push(pulse, pieces[i].steps);
        pulse += pieces[i].steps;
    }
    step_channel_run(&channel);
}

static void assert_pulse(uint32_t pulse)
{
    TEST_ASSERT_EQUAL_UINT32(START + pulse * INTERVAL, laid_make_pulse());
    TEST_ASSERT_EQUAL_UINT64(pulse, step_channel_pulses(&channel));
    TEST_ASSERT_EQUAL_INT64(position[pulse], step_channel_position(&channel));
    TEST_ASSERT_EQUAL(position[pulse] < position[pulse - 1U], laid.direction);
}

static void assert_pulses(uint32_t from, uint32_t to)
{
    for (uint32_t pulse = from; pulse <= to; pulse++) {
        assert_pulse(pulse);
    }
}

void setUp(void)
{
    uint32_t pulse = 0;
    for (unsigned i = 0; i < PIECES; i++) {
        for (uint32_t k = 0; k < pieces[i].steps; k++, pulse++) {
            position[pulse + 1U] = position[pulse] + (pieces[i].backward ? -1 : 1);
        }
    }
    channel_rig_init();
}

void tearDown(void)
{
    channel_rig_check();
}

void test_pulses_go_the_way_of_their_segment_and_the_position_follows(void)
{
    for (unsigned ahead = 1; ahead <= AHEAD; ahead++) {
        begin_pieces(ahead);
        assert_pulses(1, TOTAL);
        TEST_ASSERT_FALSE(step_channel_is_running(&channel));
        TEST_ASSERT_EQUAL_INT64(position[TOTAL], step_channel_position(&channel));
    }
}

void test_a_move_goes_on_from_a_position_reached_both_ways(void)
{
    begin_pieces(AHEAD);
    assert_pulses(1, TOTAL);
    step_channel_begin(&channel, START, true);
    push(0, 2);
    step_channel_run(&channel);
    (void)run_to_the_end();
    TEST_ASSERT_EQUAL_INT64(position[TOTAL] - 2, step_channel_position(&channel));
}

void test_a_move_may_begin_the_other_way_than_it_was_readied_for(void)
{
    for (unsigned ahead = 1; ahead <= AHEAD; ahead++) {
        channel_rig_init();
        laid.ahead = ahead;
        step_channel_begin(&channel, START, false);
        step_channel_turn(&channel, true);
        push(0, 4);
        step_channel_run(&channel);
        TEST_ASSERT_TRUE(step_channel_freeze(&channel, 4));
        thaw();
        make_pulses(1);
        TEST_ASSERT_EQUAL_INT64(-1, step_channel_position(&channel));
        (void)run_to_the_end();
        TEST_ASSERT_EQUAL_INT64(-4, step_channel_position(&channel));
    }
}

static void freeze_and_thaw(unsigned ahead, uint32_t made, uint64_t back)
{
    begin_pieces(ahead);
    assert_pulses(1, made);
    TEST_ASSERT_TRUE(step_channel_freeze(&channel, back));
    TEST_ASSERT_LESS_OR_EQUAL_UINT(TOTAL - back, laid.laid);
    TEST_ASSERT_EQUAL_INT64(position[made], step_channel_position(&channel));
    thaw();
    assert_pulses(made + 1U, TOTAL);
    TEST_ASSERT_FALSE(step_channel_is_running(&channel));
}

void test_what_was_frozen_and_thawed_comes_as_if_nothing_had_happened(void)
{
    for (unsigned ahead = 1; ahead <= AHEAD; ahead += 3) {
        for (uint32_t made = 0; made < TOTAL; made++) {
            for (uint32_t back = 0; back <= TOTAL - made; back++) {
                freeze_and_thaw(ahead, made, back);
            }
        }
    }
}

void test_while_frozen_only_what_stays_is_made(void)
{
    begin_pieces(AHEAD);
    assert_pulses(1, 2);
    TEST_ASSERT_TRUE(step_channel_freeze(&channel, TOTAL - 4));
    assert_pulses(3, 4);
    TEST_ASSERT_EQUAL_UINT(0, laid_waiting());
    TEST_ASSERT_TRUE(step_channel_is_running(&channel));
    thaw();
    assert_pulses(5, TOTAL);
}

void test_while_frozen_the_pulses_that_stay_go_on_being_laid(void)
{
    for (unsigned ahead = 1; ahead <= AHEAD; ahead++) {
        for (uint32_t stays = 1; stays < TOTAL; stays++) {
            struct step_segment segment = segment_after(stays, NEW_STEPS);
            begin_pieces(ahead);
            assert_pulses(1, 1);
            TEST_ASSERT_TRUE(step_channel_freeze(&channel, TOTAL - stays));
            assert_pulses(2, stays);
            TEST_ASSERT_EQUAL_UINT(0, laid_waiting());
            TEST_ASSERT_TRUE(step_channel_is_running(&channel));
            step_channel_recall(&channel, TOTAL - stays, &segment, true);
            thaw();
            for (uint32_t k = 1; k <= NEW_STEPS; k++) {
                TEST_ASSERT_EQUAL_UINT32(START + (stays + k) * INTERVAL, laid_make_pulse());
                TEST_ASSERT_EQUAL_INT64(position[stays] - (int64_t)k, step_channel_position(&channel));
            }
            TEST_ASSERT_FALSE(step_channel_is_running(&channel));
        }
    }
}

static void recall(unsigned ahead, uint32_t made, uint32_t back, bool backward)
{
    uint32_t stays = TOTAL - back;
    struct step_segment segment = segment_after(stays, NEW_STEPS);
    begin_pieces(ahead);
    assert_pulses(1, made);
    TEST_ASSERT_TRUE(step_channel_freeze(&channel, back));
    step_channel_recall(&channel, back, &segment, backward);
    thaw();
    assert_pulses(made + 1U, stays);
    for (uint32_t k = 1; k <= NEW_STEPS; k++) {
        int64_t way = backward ? -(int64_t)k : (int64_t)k;
        TEST_ASSERT_EQUAL_UINT32(START + (stays + k) * INTERVAL, laid_make_pulse());
        TEST_ASSERT_EQUAL_INT64(position[stays] + way, step_channel_position(&channel));
    }
    TEST_ASSERT_FALSE(step_channel_is_running(&channel));
    TEST_ASSERT_EQUAL_UINT32(START + (stays + (uint32_t)NEW_STEPS) * INTERVAL, step_channel_end_tick(&channel));
    TEST_ASSERT_EQUAL_UINT32(STEP_QUEUE_SEGMENTS, step_channel_room(&channel));
}

void test_what_is_recalled_never_comes_and_what_replaces_it_does(void)
{
    for (unsigned ahead = 1; ahead <= AHEAD; ahead += 3) {
        for (uint32_t made = 0; made < TOTAL; made++) {
            for (uint32_t back = 0; back <= TOTAL - made; back++) {
                recall(ahead, made, back, false);
                recall(ahead, made, back, true);
            }
        }
    }
}

static void end_early(unsigned ahead, uint32_t made, uint32_t back)
{
    uint32_t stays = TOTAL - back;
    begin_pieces(ahead);
    assert_pulses(1, made);
    TEST_ASSERT_TRUE(step_channel_freeze(&channel, back));
    step_channel_recall(&channel, back, NULL, false);
    thaw();
    assert_pulses(made + 1U, stays);
    TEST_ASSERT_FALSE(step_channel_is_running(&channel));
    TEST_ASSERT_EQUAL_UINT32(START + stays * INTERVAL, step_channel_end_tick(&channel));
    TEST_ASSERT_EQUAL_INT64(position[stays], step_channel_position(&channel));
}

void test_a_move_that_is_recalled_ends_with_the_last_pulse_that_stays(void)
{
    for (unsigned ahead = 1; ahead <= AHEAD; ahead += 3) {
        for (uint32_t made = 1; made < TOTAL; made++) {
            for (uint32_t back = 0; back < TOTAL - made; back++) {
                end_early(ahead, made, back);
            }
        }
    }
}

static void recall_again(uint32_t stays, uint32_t stays_then, const struct step_segment *segment)
{
    begin_pieces(AHEAD);
    assert_pulses(1, 1);
    TEST_ASSERT_TRUE(step_channel_freeze(&channel, TOTAL - stays));
    struct step_segment first = segment_after(stays, NEW_STEPS);
    step_channel_recall(&channel, TOTAL - stays, &first, false);
    thaw();
    TEST_ASSERT_TRUE(step_channel_freeze(&channel, stays + NEW_STEPS - stays_then));
    step_channel_recall(&channel, stays + NEW_STEPS - stays_then, segment, false);
    thaw();
}

void test_a_move_that_is_recalled_twice_ends_with_the_last_pulse_that_stays(void)
{
    for (uint32_t stays = 2; stays <= TOTAL; stays++) {
        for (uint32_t then = 1; then <= stays + NEW_STEPS; then++) {
            recall_again(stays, then, NULL);
            (void)run_to_the_end();
            TEST_ASSERT_EQUAL_UINT32(START + then * INTERVAL, step_channel_end_tick(&channel));
        }
    }
}

void test_a_move_is_recalled_from_before_where_it_was_recalled(void)
{
    for (uint32_t stays = 2; stays <= TOTAL; stays++) {
        for (uint32_t then = 1; then <= stays + NEW_STEPS; then++) {
            struct step_segment segment = segment_after(then, NEW_STEPS);
            recall_again(stays, then, &segment);
            for (uint32_t k = 2; k <= then + NEW_STEPS; k++) {
                TEST_ASSERT_EQUAL_UINT32(START + k * INTERVAL, laid_make_pulse());
            }
            TEST_ASSERT_FALSE(step_channel_is_running(&channel));
        }
    }
}

void test_a_recall_before_the_last_one_that_comes_too_late_counts_what_is_laid(void)
{
    for (uint32_t stays = 3; stays <= pieces[0].steps + pieces[1].steps; stays++) {
        for (uint32_t late = 1; late < stays; late++) {
            struct step_segment segment = segment_after(stays, NEW_STEPS);
            begin_pieces(AHEAD);
            TEST_ASSERT_TRUE(step_channel_freeze(&channel, TOTAL - stays));
            step_channel_recall(&channel, TOTAL - stays, &segment, false);
            thaw();
            laid.too_late = late;
            TEST_ASSERT_FALSE(step_channel_freeze(&channel, stays + NEW_STEPS - late + 1U));
            TEST_ASSERT_EQUAL_INT64(0, step_channel_position(&channel));
            laid.too_late = 0;
            for (uint32_t k = 1; k <= stays + NEW_STEPS; k++) {
                TEST_ASSERT_EQUAL_UINT32(START + k * INTERVAL, laid_make_pulse());
            }
            TEST_ASSERT_FALSE(step_channel_is_running(&channel));
        }
    }
}

void test_a_second_move_is_recalled_as_the_first(void)
{
    begin_pieces(AHEAD);
    (void)run_to_the_end();
    step_channel_begin(&channel, START, true);
    step_channel_turn(&channel, true);
    push(0, 5);
    step_channel_run(&channel);
    TEST_ASSERT_TRUE(step_channel_freeze(&channel, 3));
    step_channel_recall(&channel, 3, NULL, true);
    thaw();
    TEST_ASSERT_EQUAL_UINT(2, run_to_the_end());
    TEST_ASSERT_EQUAL_INT64(position[TOTAL] - 2, step_channel_position(&channel));
    TEST_ASSERT_EQUAL_UINT32(START + 2U * INTERVAL, step_channel_end_tick(&channel));
}

static void push_fast(uint32_t pulse, uint32_t steps)
{
    struct step_segment segment = segment_every(FAST_TICKS, pulse, steps);
    TEST_ASSERT_TRUE(step_channel_push(&channel, &segment));
}

static void assert_fast(uint32_t from, uint32_t to)
{
    for (uint32_t pulse = from; pulse <= to; pulse++) {
        TEST_ASSERT_EQUAL_UINT32(START + pulse * FAST_TICKS, laid_make_pulse());
        TEST_ASSERT_EQUAL_UINT64(pulse, step_channel_pulses(&channel));
    }
}

static void freeze_fast(uint32_t made, uint32_t stays)
{
    channel_rig_init();
    laid.ahead = FAST_AHEAD;
    step_channel_begin(&channel, START, false);
    push_fast(0, FAST_STEPS);
    push_fast(FAST_STEPS, FAST_STEPS);
    step_channel_run(&channel);
    assert_fast(1, made);
    TEST_ASSERT_TRUE(step_channel_freeze(&channel, 2U * FAST_STEPS - stays));
}

void test_fast_pulses_come_as_before_after_some_of_them_were_taken_back(void)
{
    for (uint32_t made = 0; made < FAST_STEPS; made += 3) {
        for (uint32_t stays = made + 1U; stays <= 2U * FAST_STEPS; stays++) {
            freeze_fast(made, stays);
            thaw();
            assert_fast(made + 1U, 2U * FAST_STEPS);
            TEST_ASSERT_FALSE(step_channel_is_running(&channel));
        }
    }
}

void test_a_fast_move_that_is_recalled_ends_with_the_last_pulse_that_stays(void)
{
    for (uint32_t made = 0; made < FAST_STEPS; made += 3) {
        for (uint32_t stays = made + 1U; stays <= 2U * FAST_STEPS; stays++) {
            freeze_fast(made, stays);
            step_channel_recall(&channel, 2U * FAST_STEPS - stays, NULL, false);
            thaw();
            assert_fast(made + 1U, stays);
            TEST_ASSERT_FALSE(step_channel_is_running(&channel));
            TEST_ASSERT_EQUAL_UINT32(START + stays * FAST_TICKS, step_channel_end_tick(&channel));
        }
    }
}

void test_what_cannot_be_taken_back_any_more_is_not_frozen(void)
{
    for (uint32_t late = 1; late <= pieces[0].steps + pieces[1].steps; late++) {
        begin_pieces(AHEAD);
        laid.too_late = late;
        TEST_ASSERT_TRUE(step_channel_freeze(&channel, TOTAL - late));
        thaw();
        TEST_ASSERT_FALSE(step_channel_freeze(&channel, TOTAL - late + 1U));
        TEST_ASSERT_FALSE(step_channel_freeze(&channel, TOTAL));
        assert_pulses(1, TOTAL);
    }
}

void test_a_pulse_that_was_made_is_not_frozen(void)
{
    begin_pieces(AHEAD);
    assert_pulses(1, 7);
    TEST_ASSERT_FALSE(step_channel_freeze(&channel, TOTAL - 6));
    assert_pulses(8, TOTAL);
}

void test_a_channel_at_rest_takes_what_replaces_nothing(void)
{
    struct step_segment segment = segment_after(TOTAL, NEW_STEPS);
    begin_pieces(AHEAD);
    assert_pulses(1, TOTAL);
    TEST_ASSERT_TRUE(step_channel_freeze(&channel, 0));
    step_channel_recall(&channel, 0, &segment, true);
    thaw();
    (void)run_to_the_end();
    TEST_ASSERT_EQUAL_INT64(position[TOTAL] - NEW_STEPS, step_channel_position(&channel));
}

void test_a_channel_at_rest_may_be_frozen_and_thawed(void)
{
    begin_pieces(AHEAD);
    assert_pulses(1, TOTAL);
    TEST_ASSERT_TRUE(step_channel_freeze(&channel, 0));
    thaw();
    TEST_ASSERT_FALSE(step_channel_is_running(&channel));
    TEST_ASSERT_FALSE(step_channel_freeze(&channel, 1));
    TEST_ASSERT_EQUAL_INT64(position[TOTAL], step_channel_position(&channel));
}
