/* When a change of feed or a hold takes effect where pulses are far apart, and the speed that an axis shows then. */
#include "pos_rig.h"

enum {
    AXIS = 2,
    JEDE = 0x0100,
    SPEED_20 = 12 << 16, /* 20 steps/s */
};

void setUp(void)
{
}

void tearDown(void)
{
}

static void control(unsigned mm_min, int mp)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, (uint32_t)mm_min << 16U, mp, AXIS));
}

/* A measure of 1000 steps. */
static void start(uint16_t accel_mm_s2, unsigned mm_min)
{
    rig_set_up();
    rig_run_ms(10);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, AXIS, 0));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 10000, accel_mm_s2, AXIS));
    control(mm_min, 1);
}

static uint64_t pulse_tick(unsigned pulse)
{
    return rig_tick[AXIS - 1][pulse - 1U];
}

/* On a ramp of 100 steps/s^2, so many ticks before pulse 2, at which it does 20 steps/s. */
static void come_to_second_pulse(uint64_t before_ticks)
{
    start(1, 600);
    uint64_t begin = machine.now;
    rig_run_ms(300);
    uint64_t ticks = pulse_tick(2) - begin;
    start(1, 600);
    rig_run_ticks(ticks - before_ticks);
    TEST_ASSERT_EQUAL_UINT(1, rig_pulses[AXIS - 1]);
}

static void after_second_pulse(uint64_t after_ms)
{
    come_to_second_pulse(TICKS_PER_MS);
    rig_run_ms(1U + after_ms);
    TEST_ASSERT_EQUAL_UINT(2, rig_pulses[AXIS - 1]);
}

static void assert_speed(uint32_t wanted)
{
    TEST_ASSERT_UINT32_WITHIN(1000, wanted, rig_values(AXIS).speed);
}

/* ---- when ------------------------------------------------------------------------------------------------------ */

void test_on_a_slow_ramp_a_hold_takes_effect_at_the_next_pulse_however_near(void)
{
    for (uint64_t us = 5; us < 900; us += 35) {
        come_to_second_pulse(us * TICKS_PER_US);
        control(600, 0);
        rig_run_ms(1000);
        TEST_ASSERT_EQUAL_UINT(4, rig_pulses[AXIS - 1]);
        TEST_ASSERT_BITS_LOW(JEDE, rig_status(AXIS));
    }
}

void test_on_a_slow_ramp_a_feed_takes_effect_at_the_next_pulse_however_near(void)
{
    for (uint64_t us = 5; us < 900; us += 35) {
        come_to_second_pulse(us * TICKS_PER_US);
        control(12, 1);
        rig_run_ms(300);
        TEST_ASSERT_UINT64_WITHIN(3, TICK_HZ / 20U, pulse_tick(4) - pulse_tick(3));
        TEST_ASSERT_UINT64_WITHIN(3, TICK_HZ / 20U, pulse_tick(3) - pulse_tick(2));
    }
}

/* From 20 steps/s at pulse 2 it brakes to 14.1 at pulse 3 and would stand at pulse 4; but speeds up to 20 again. */
void test_a_hold_is_taken_back_at_the_next_pulse_however_near(void)
{
    for (uint64_t us = 5; us < 900; us += 35) {
        come_to_second_pulse(TICKS_PER_MS);
        control(600, 0);
        rig_run_ms(1);
        rig_run_ticks(pulse_tick(2) + TICK_HZ * UINT64_C(585786) / 10000000U - us * TICKS_PER_US - machine.now);
        TEST_ASSERT_EQUAL_UINT(2, rig_pulses[AXIS - 1]);
        control(600, 1);
        rig_run_ms(100);
        TEST_ASSERT_UINT64_WITHIN(10, pulse_tick(3) - pulse_tick(2), pulse_tick(4) - pulse_tick(3));
    }
}

/* The cruise begins 10 ms after the start, pulse 1 comes after 105 ms. */
void test_in_a_slow_cruise_a_hold_does_not_wait_for_the_pulse_of_the_change_before(void)
{
    start(10, 6);
    rig_run_ms(5);
    control(12, 1);
    rig_run_ms(40);
    TEST_ASSERT_BITS_HIGH(JEDE, rig_status(AXIS));
    control(12, 0);
    rig_run_ms(13);
    TEST_ASSERT_EQUAL_UINT(0, rig_pulses[AXIS - 1]);
    TEST_ASSERT_BITS_LOW(JEDE, rig_status(AXIS));
}

void test_in_a_slow_cruise_a_hold_that_waits_for_a_pulse_is_taken_back_and_given_again(void)
{
    start(10, 6);
    rig_run_ms(5);
    control(6, 0);
    rig_run_ms(1);
    control(6, 1);
    rig_run_ms(40);
    control(6, 0);
    rig_run_ms(13);
    TEST_ASSERT_EQUAL_UINT(0, rig_pulses[AXIS - 1]);
    TEST_ASSERT_BITS_LOW(JEDE, rig_status(AXIS));
}

/* ---- the speed ------------------------------------------------------------------------------------------------- */

void test_the_speed_is_that_at_the_last_pulse_while_a_change_is_to_come_at_the_next(void)
{
    after_second_pulse(10);
    assert_speed(SPEED_20);
    control(300, 1);
    assert_speed(SPEED_20);
    rig_run_ms(5);
    assert_speed(SPEED_20);
    control(300, 0);
    rig_run_ms(5);
    assert_speed(SPEED_20);
}

/* It cruises at 20 steps/s when they begin. */
void test_the_speed_is_that_at_the_last_pulse_after_two_changes_between_pulses(void)
{
    start(10, 12);
    rig_run_ms(200);
    assert_speed(SPEED_20);
    unsigned made = rig_pulses[AXIS - 1];
    TEST_ASSERT_GREATER_THAN_UINT(0, made);
    rig_run_ticks(pulse_tick(made) + TICK_HZ / 20U + TICKS_PER_MS - machine.now);
    TEST_ASSERT_EQUAL_UINT(made + 1U, rig_pulses[AXIS - 1]);
    for (unsigned mm_min = 9; mm_min > 5; mm_min--) {
        control(mm_min, 1);
        rig_run_ms(5);
        assert_speed(SPEED_20);
    }
    TEST_ASSERT_EQUAL_UINT(made + 1U, rig_pulses[AXIS - 1]);
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_UINT(made + 2U, rig_pulses[AXIS - 1]);
    assert_speed(SPEED_20 / 2);
}
