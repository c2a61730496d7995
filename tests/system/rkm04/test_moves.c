/* The commands that move a motor (spec, sections 4 and 5.3): F B D R, G and H, G+ and G-, ( and ). With S1000 and a V
 * that is not above it the motor makes one step a millisecond, exactly. */
#include "bench.h"
#include "unity.h"

static struct bench bench;

void setUp(void)
{
    bench_init(&bench);
}

void tearDown(void)
{
    bench_check(&bench);
}

void test_f_and_r_move_forward(void)
{
    bench_do(&bench, 1, "S1000 F7 R");
    TEST_ASSERT_EQUAL_INT64(7, bench_position(&bench, 1));
}

void test_b_and_r_move_backward(void)
{
    bench_do(&bench, 1, "S1000 B7 R");
    TEST_ASSERT_EQUAL_INT64(-7, bench_position(&bench, 1));
}

void test_f_without_r_does_not_move(void)
{
    bench_do(&bench, 1, "S1000 F7");
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_MOVE));
}

void test_r_without_steps_is_skipped(void)
{
    bench_do(&bench, 1, "R T01");
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_MOVE));
    TEST_ASSERT_TRUE(bench_output(&bench, 1));
}

void test_r_repeats_the_move(void)
{
    bench_do(&bench, 1, "S1000 F7 R R");
    TEST_ASSERT_EQUAL_INT64(14, bench_position(&bench, 1));
}

void test_d_reverses_the_moves_that_follow(void)
{
    bench_do(&bench, 1, "S1000 F7 R D R R");
    TEST_ASSERT_EQUAL_INT64(-7, bench_position(&bench, 1));
}

void test_d_twice_is_forward_again(void)
{
    bench_do(&bench, 1, "S1000 F7 D D R");
    TEST_ASSERT_EQUAL_INT64(7, bench_position(&bench, 1));
}

void test_f_after_d_is_forward(void)
{
    bench_do(&bench, 1, "S1000 D F7 R");
    TEST_ASSERT_EQUAL_INT64(7, bench_position(&bench, 1));
}

void test_a_move_is_traced_with_its_signed_steps(void)
{
    bench_do(&bench, 1, "S1000 B7 R");
    TEST_ASSERT_EQUAL_INT64(-7, bench_event(&bench, 1, HAL_TRACE_MOVE, 0)->value);
    TEST_ASSERT_EQUAL_INT64(-7, bench_event(&bench, 1, HAL_TRACE_DONE, 0)->value);
}

void test_done_is_traced_at_the_last_pulse(void)
{
    bench_do(&bench, 1, "S1000 F7 R");
    TEST_ASSERT_EQUAL_UINT64(bench_pulse_tick(&bench, 1, 7), bench_event(&bench, 1, HAL_TRACE_DONE, 0)->tick);
}

void test_the_motors_do_not_disturb_each_other(void)
{
    bench_do(&bench, 2, "S1000 F7 R");
    TEST_ASSERT_EQUAL_UINT32(0, bench_pulses(&bench, 1));
    TEST_ASSERT_EQUAL_UINT32(7, bench_pulses(&bench, 2));
    TEST_ASSERT_EQUAL_UINT32(0, bench_pulses(&bench, 3));
}

void test_motor_0_is_all_four(void)
{
    bench_do(&bench, 0, "S1000 F7 R");
    for (unsigned motor = 1; motor <= UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_INT64(7, bench_position(&bench, motor));
    }
}

/* The start values are S100 V1000 A2000: the pulses are the same as with them. */
void test_the_start_values_are_s100_v1000_a2000(void)
{
    uint64_t start = bench_now(&bench);
    bench_do(&bench, 1, "F900 R");
    uint64_t defaults[2] = {bench_pulse_tick(&bench, 1, 1) - start, bench_pulse_tick(&bench, 1, 900) - start};
    start = bench_now(&bench);
    bench_do(&bench, 2, "A2000 S100 V1000 F900 R");
    TEST_ASSERT_EQUAL_UINT64(defaults[0], bench_pulse_tick(&bench, 2, 1) - start);
    TEST_ASSERT_EQUAL_UINT64(defaults[1], bench_pulse_tick(&bench, 2, 900) - start);
}

TEST_CASE("G15", 15)
TEST_CASE("=20 G15", 15)
TEST_CASE("=-20 G1", 1)
TEST_CASE("=30 H", 0)
TEST_CASE("=-30 H", 0)
TEST_CASE("F5 R H", 0)
void test_g_and_h_go_to_a_position(const char *text, int position)
{
    bench_do(&bench, 1, "S1000");
    bench_do(&bench, 1, text);
    TEST_ASSERT_EQUAL_INT64(position, bench_position(&bench, 1));
}

TEST_CASE("=15 G15")
TEST_CASE("H")
void test_a_way_of_no_steps_is_skipped(const char *text)
{
    bench_do(&bench, 1, text);
    TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, 1, HAL_TRACE_MOVE));
}

TEST_CASE("F4 G10 R", 14)
TEST_CASE("B4 G10 R", 6)
TEST_CASE("F4 R D H R", -4)
TEST_CASE("=-50 B4 H R", -4)
void test_g_and_h_leave_steps_and_direction_as_they_were(const char *text, int position)
{
    bench_do(&bench, 1, "S1000");
    bench_do(&bench, 1, text);
    TEST_ASSERT_EQUAL_INT64(position, bench_position(&bench, 1));
}

void test_c100_zeroes_the_position(void)
{
    bench_do(&bench, 1, "S1000 F7 R C100");
    TEST_ASSERT_EQUAL_INT64(0, bench_position(&bench, 1));
}

TEST_CASE("=2000000000", 2000000000)
TEST_CASE("=-2000000000", -2000000000)
void test_the_position_can_be_written(const char *text, int position)
{
    bench_do(&bench, 1, text);
    TEST_ASSERT_EQUAL_INT64(position, bench_position(&bench, 1));
}

TEST_CASE("G+", 1)
TEST_CASE("G-", -1)
void test_a_run_without_end_goes_on_until_k(const char *text, int direction)
{
    bench_send(&bench, 1, "S1000");
    bench_send(&bench, 1, text);
    bench_run_pulses(&bench, 1, 5000);
    bench_do(&bench, 1, "K");
    TEST_ASSERT_INT64_WITHIN(1, 5000, direction * bench_position(&bench, 1));
    TEST_ASSERT_EQUAL_INT64(0, bench_event(&bench, 1, HAL_TRACE_MOVE, 0)->value);
}

void test_a_run_without_end_is_at_v(void)
{
    bench_send(&bench, 1, "V2000 A60000 G+");
    bench_run_ms(&bench, 1000);
    uint32_t last = bench_pulses(&bench, 1);
    TEST_ASSERT_UINT64_WITHIN(1, TICK_HZ / 2000U,
                              bench_pulse_tick(&bench, 1, last) - bench_pulse_tick(&bench, 1, last - 1));
    bench_do(&bench, 1, "K");
}

TEST_CASE(")05", 1)
TEST_CASE("(05", -1)
void test_a_limit_run_ends_with_the_last_pulse_before_the_input(const char *text, int direction)
{
    bench_plan_input(&bench, 20 * TICKS_PER_MS + 1, 5, true);
    bench_send(&bench, 1, "S1000");
    bench_send(&bench, 1, text);
    bench_run_idle(&bench);
    TEST_ASSERT_EQUAL_INT64(direction * 20, bench_position(&bench, 1));
}

void test_a_limit_run_is_at_s(void)
{
    bench_plan_input(&bench, 90 * TICKS_PER_MS, 5, true);
    bench_do(&bench, 1, "S200 V3000 A60000 )05");
    for (uint32_t pulse = 2; pulse <= 17; pulse++) {
        TEST_ASSERT_UINT64_WITHIN(1, TICK_HZ / 200U,
                                  bench_pulse_tick(&bench, 1, pulse) - bench_pulse_tick(&bench, 1, pulse - 1));
    }
}

void test_a_limit_run_makes_no_step_if_the_input_is_1_already(void)
{
    bench_set_input(&bench, 5, true);
    bench_do(&bench, 1, "S1000 )05 F3 R");
    TEST_ASSERT_EQUAL_UINT32(3, bench_pulses(&bench, 1));
}

void test_a_limit_run_does_not_end_at_another_input(void)
{
    bench_set_input(&bench, 4, true);
    bench_send(&bench, 1, "S1000 )05");
    bench_run_ms(&bench, 20);
    TEST_ASSERT_EQUAL_INT(INTERPRETER_MOVING, bench_state(&bench, 1));
    bench_set_input(&bench, 5, true);
}

/* The program clock is the tick of the last pulse, long before the input was seen; what follows starts when it was. */
void test_the_program_goes_on_when_the_limit_is_seen(void)
{
    uint64_t seen = 20 * TICKS_PER_MS + TICKS_PER_MS / 2;
    bench_plan_input(&bench, seen, 5, true);
    bench_do(&bench, 1, "S1000 )05 F1 R");
    TEST_ASSERT_UINT64_WITHIN(TICKS_PER_MS / 10, seen + TICKS_PER_MS, bench_pulse_tick(&bench, 1, 21));
}
