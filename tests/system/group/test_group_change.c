/* Stops and changes of a group that come at odd times: early, late, where queues are full, where motors are left out.
 */
#include "group_rig.h"

void setUp(void)
{
    begin(AHEAD_TICKS);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

void test_a_stop_before_the_first_pulse_lets_none_come_after_the_ramp(void)
{
    add_zigzag();
    TEST_ASSERT_TRUE(group_start(&group, hal_time_now() + START_TICKS));
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    run_to_the_end();
    TEST_ASSERT_LESS_OR_EQUAL_INT64(1, position[0]);
    start();
    run_to_the_end();
    assert_arrived();
}

void test_a_motor_may_be_left_out(void)
{
    group_connect(&group, 1, NULL, 0);
    group_connect(&group, 3, NULL, 0);
    add(500, -200, 30, 7, 20000);
    start();
    run_us(10000);
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    run_to_the_end();
    start();
    run_to_the_end();
    TEST_ASSERT_EQUAL_INT64(500, position[0]);
    TEST_ASSERT_EQUAL_INT64(0, position[1]);
    TEST_ASSERT_EQUAL_INT64(30, position[2]);
    TEST_ASSERT_EQUAL_UINT(0, made[3]);
}

void test_vectors_of_a_millisecond_fill_the_queues_and_all_arrive(void)
{
    for (unsigned i = 0; i < RING; i++) {
        add(i % 2 != 0 ? -20 : 20, 7, 11, 3, 30000);
    }
    start();
    run_to_the_end();
    assert_arrived();
}

void test_where_it_is_too_late_to_take_back_a_later_place_is_found(void)
{
    for (uint64_t us = 60000; us < 61000; us += 97) {
        begin(AHEAD_TICKS);
        machine.faults.keep_ticks = 600 * TICKS_PER_US;
        add(5000, 2500, -5000, 5, 50000);
        start();
        run_us(us);
        TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
        run_to_the_end();
        TEST_ASSERT_TRUE(group_has_rest(&group));
        start();
        run_to_the_end();
        assert_arrived();
    }
}

void test_a_motion_is_over_with_its_last_pulse_also_if_that_is_late(void)
{
    begin(0);
    machine.faults.late_step_ticks = 3 * TICKS_PER_MS;
    add(30, 0, 0, 0, 20000);
    start();
    run_to_the_end();
    assert_arrived();
    TEST_ASSERT_GREATER_THAN_UINT64(0, machine.late_steps);
    machine.late_steps = 0;
}

static void stop_and_go_on_to_the_end(void)
{
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    run_to_the_end();
    TEST_ASSERT_TRUE(group_has_rest(&group));
    start();
    run_to_the_end();
}

/* What has been handed over ends after 20 ms, somewhere on the path: the motors stand there, and what comes then is
 * late. */
static void stay_away_ms(uint64_t milliseconds)
{
    begin_ring(AHEAD_TICKS, LONG_RING);
    for (unsigned i = 0; i < LONG_RING; i++) {
        add(40, -13, i % 2 != 0 ? 7 : -7, 1, 20000);
    }
    start();
    run_us(30000);
    busy_until = machine.now + milliseconds * TICKS_PER_MS;
    run_us(milliseconds * 1000U - 1000U);
    int64_t stands = position[0];
    run_us(999);
    TEST_ASSERT_EQUAL_INT64(stands, position[0]);
    TEST_ASSERT_TRUE(stands > 0 && stands < ordered[0]);
}

void test_motors_for_which_a_plan_comes_too_late_wait_on_their_steps_and_go_on(void)
{
    static const uint64_t away_ms[] = {30, 50, 400};
    for (unsigned i = 0; i < sizeof away_ms / sizeof away_ms[0]; i++) {
        stay_away_ms(away_ms[i]);
        TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
        run_to_the_end();
        assert_arrived();
        TEST_ASSERT_GREATER_THAN_UINT64(0, machine.late_steps);
        machine.late_steps = 0;
    }
}

void test_a_stop_of_motors_for_which_a_plan_came_too_late_loses_no_step(void)
{
    stay_away_ms(50);
    stop_and_go_on_to_the_end();
    assert_arrived();
    machine.late_steps = 0;
}

/* Vectors of 5 us, each a segment: the queues end before a change can take effect. */
static void begin_dense(void)
{
    begin_ring(AHEAD_TICKS, LONG_RING);
    struct path_vector fast = vector_of(20000, 0, 0, 0, 200000);
    TEST_ASSERT_TRUE(group_add(&group, &fast));
    for (unsigned i = 1; i < LONG_RING - 1; i++) {
        add(1, 0, 0, 0, 200000);
    }
    struct path_vector last = vector_of(40000, 0, 0, 0, 200000);
    TEST_ASSERT_TRUE(group_add(&group, &last));
    ordered[0] += 60000;
    start();
}

void test_a_stop_waits_where_the_queues_end_before_it_can_take_effect(void)
{
    for (uint64_t us = 199000; us < 201500; us += 11) {
        begin_dense();
        run_us(us);
        TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
        run_to_the_end();
        TEST_ASSERT_TRUE(group_has_rest(&group));
        start();
        run_to_the_end();
        assert_arrived();
    }
}

void test_speeds_wait_where_the_queues_end_before_they_can_take_effect(void)
{
    for (uint64_t us = 199000; us < 201500; us += 11) {
        uint32_t speed = 50000;
        const struct group_speeds speeds = {.of = slow, .context = &speed};
        begin_dense();
        run_us(us);
        group_set_speeds(&group, &speeds);
        run_to_the_end();
        assert_arrived();
        TEST_ASSERT_FALSE(group.speeds_wait);
    }
}

void test_motors_that_were_frozen_thaw_where_another_one_cannot_be(void)
{
    machine.faults.keep_ticks = 600 * TICKS_PER_US;
    group_connect(&group, 1, NULL, 0);
    add(5, 0, -5000, 2500, 50000);
    start();
    run_us(60000);
    stop_and_go_on_to_the_end();
    assert_arrived();
}

static void begin_a_stop_that_finds_no_place(void)
{
    begin(10 * TICKS_PER_MS);
    machine.faults.keep_ticks = 20 * TICKS_PER_MS;
    add(2000, 0, 0, 0, 5000);
    start();
    run_us(60000);
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
}

void test_a_stop_that_finds_no_place_is_planned_later(void)
{
    begin_a_stop_that_finds_no_place();
    run_us(5000);
    machine.faults.keep_ticks = 0;
    run_to_the_end();
    TEST_ASSERT_TRUE(group_has_rest(&group));
    start();
    run_to_the_end();
    assert_arrived();
}

void test_speeds_wait_for_a_stop_that_is_yet_to_be_planned(void)
{
    uint32_t speed = 1000;
    const struct group_speeds speeds = {.of = slow, .context = &speed};
    begin_a_stop_that_finds_no_place();
    group_set_speeds(&group, &speeds);
    TEST_ASSERT_TRUE(group.speeds_wait);
    machine.faults.keep_ticks = 0;
    run_to_the_end();
    TEST_ASSERT_FALSE(group.speeds_wait);
    TEST_ASSERT_EQUAL_UINT32(1000 * PATH_SPEED_UNITS, ring[0].vector.speed);
}

void test_speeds_take_effect_after_a_stop_that_is_taken_back_before_it_is_planned(void)
{
    uint32_t speed = 1000;
    const struct group_speeds speeds = {.of = slow, .context = &speed};
    begin_a_stop_that_finds_no_place();
    group_set_speeds(&group, &speeds);
    machine.faults.keep_ticks = 0;
    TEST_ASSERT_TRUE(group_resume(&group));
    run_us(500000);
    TEST_ASSERT_FALSE(group.speeds_wait);
    TEST_ASSERT_EQUAL_UINT32(1000 * PATH_SPEED_UNITS, group_speed_at(&group, group_first(&group), 1500));
    run_to_the_end();
    assert_arrived();
}

void test_a_fault_takes_the_place_of_a_stop_that_is_yet_to_be_planned(void)
{
    begin(10 * TICKS_PER_MS);
    machine.faults.keep_ticks = 20 * TICKS_PER_MS;
    add(2000, 0, 0, 0, 5000);
    start();
    run_us(60000);
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    TEST_ASSERT_EQUAL_UINT(AXIS_BRAKING, atomic_load(&group.state));
    TEST_ASSERT_TRUE(group_stop_isr(&group, AXIS_CAUSE_FAULT));
    run_us(5000);
    machine.faults.keep_ticks = 0;
    run_to_the_end();
    TEST_ASSERT_EQUAL_INT(AXIS_CAUSE_FAULT, group_cause(&group));
    TEST_ASSERT_TRUE(group_has_rest(&group));
}

void test_a_stop_that_is_yet_to_be_planned_is_taken_back_without_a_plan(void)
{
    begin(10 * TICKS_PER_MS);
    machine.faults.keep_ticks = 20 * TICKS_PER_MS;
    add(2000, 0, 0, 0, 5000);
    start();
    run_us(60000);
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    TEST_ASSERT_EQUAL_UINT(AXIS_BRAKING, atomic_load(&group.state));
    TEST_ASSERT_TRUE(group_resume(&group));
    TEST_ASSERT_EQUAL_UINT(AXIS_MOVING, atomic_load(&group.state));
    TEST_ASSERT_EQUAL_INT(AXIS_CAUSE_NONE, group_cause(&group));
    machine.faults.keep_ticks = 0;
    run_us(5000);
    stop_and_go_on_to_the_end();
    assert_arrived();
}

/* The tick interrupt may put it there between the owner's look at the cause and what it does then. */
void test_a_stop_for_a_fault_is_not_taken_back(void)
{
    add(2000, 0, 0, 0, 5000);
    start();
    run_us(60000);
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_PAUSE));
    TEST_ASSERT_TRUE(group_stop_isr(&group, AXIS_CAUSE_FAULT));
    TEST_ASSERT_FALSE(group_resume(&group));
    group_plan_isr(&group);
    TEST_ASSERT_FALSE(group_resume(&group));
    TEST_ASSERT_EQUAL_INT(AXIS_CAUSE_FAULT, group_cause(&group));
    run_to_the_end();
    TEST_ASSERT_TRUE(group_has_rest(&group));
}

void test_what_has_not_been_handed_over_before_a_place_is_handed_over_first(void)
{
    for (unsigned i = 0; i < RING; i++) {
        add(5, 50, 20, i % 2 != 0 ? 60 : -60, 20000);
    }
    start();
    run_us(500);
    (void)poll(NULL);
    busy_until = machine.now + 20 * TICKS_PER_MS;
    run_us(19900);
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    busy_until = 0;
    run_to_the_end();
    TEST_ASSERT_TRUE(group_has_rest(&group));
    start();
    run_to_the_end();
    assert_arrived();
}

void test_speeds_of_a_group_that_stands_or_stops_are_taken_at_once(void)
{
    uint32_t speed = 5000;
    const struct group_speeds speeds = {.of = slow, .context = &speed};
    add(3000, 0, 0, 0, 50000);
    group_set_speeds(&group, &speeds);
    start();
    run_us(100000);
    TEST_ASSERT_INT64_WITHIN(40, 500, position[0]);
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    speed = 20000;
    group_set_speeds(&group, &speeds);
    run_to_the_end();
    int64_t at = position[0];
    start();
    run_us(71000);
    TEST_ASSERT_INT64_WITHIN(25, at + 200 + 1000, position[0]);
    run_to_the_end();
    assert_arrived();
}

void test_the_plan_interrupt_means_nothing_to_a_group_that_is_not_stopped(void)
{
    group_plan_isr(&group);
    add_zigzag();
    start();
    group_plan_isr(&group);
    run_to_the_end();
    assert_arrived();
}

static void begin_manner(uint32_t fault_accel, bool between_steps)
{
    group_set_manner(&group, &(struct group_manner){.fault_accel = fault_accel, .between_steps = between_steps});
}

void test_a_stop_that_is_taken_back_leaves_the_path_as_it_was(void)
{
    for (uint64_t us = 0; us < 9000; us += 293) {
        begin(AHEAD_TICKS);
        add(500, 250, -500, 5, 50000);
        start();
        run_us(3000);
        TEST_ASSERT_FALSE(group_resume(&group));
        TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_PAUSE));
        run_us(us);
        bool resumes = group_resume(&group);
        TEST_ASSERT_EQUAL(resumes, atomic_load(&group.state) == AXIS_MOVING);
        TEST_ASSERT_EQUAL_INT(resumes ? AXIS_CAUSE_NONE : AXIS_CAUSE_PAUSE, group_cause(&group));
        run_to_the_end();
        TEST_ASSERT_EQUAL(!resumes, group_has_rest(&group));
        if (!resumes) {
            start();
            run_to_the_end();
        }
        assert_arrived();
    }
}

void test_a_stop_at_once_taken_back_moves_no_pulse(void)
{
    add(500, 0, 0, 0, 50000);
    start();
    run_to_the_end();
    static uint64_t plain[500];
    for (unsigned i = 0; i < 500; i++) {
        plain[i] = made_tick[0][i] - made_tick[0][0];
    }
    begin(AHEAD_TICKS);
    add(500, 0, 0, 0, 50000);
    start();
    run_us(3000);
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_PAUSE));
    TEST_ASSERT_TRUE(group_resume(&group));
    run_to_the_end();
    for (unsigned i = 0; i < 500; i++) {
        TEST_ASSERT_UINT64_WITHIN(1, plain[i], made_tick[0][i] - made_tick[0][0]);
    }
}

/* 50 000 steps/s and 1 000 000 steps/s^2: 1250 steps down to a stand; with twice as much 625. */
void test_a_fault_brakes_with_the_acceleration_for_faults(void)
{
    begin_manner(2000000 * STEP_ACCEL_PER_ACCEL, false);
    add(10000, 0, 0, 0, 50000);
    start();
    run_us(100000);
    int64_t before = position[0];
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_FAULT));
    run_to_the_end();
    TEST_ASSERT_INT64_WITHIN(26, before + 625 + 25, position[0]);
}

void test_a_fault_takes_the_place_of_another_stop(void)
{
    begin_manner(8000000 * STEP_ACCEL_PER_ACCEL, false);
    add(10000, 0, 0, 0, 50000);
    start();
    run_us(100000);
    int64_t before = position[0];
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_PAUSE));
    run_us(1000);
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_FAULT));
    TEST_ASSERT_FALSE(group_stop(&group, AXIS_CAUSE_FAULT));
    TEST_ASSERT_EQUAL_INT(AXIS_CAUSE_FAULT, group_cause(&group));
    run_to_the_end();
    TEST_ASSERT_INT64_WITHIN(40, before + 50 + 25 + 156, position[0]);
}

void test_a_fault_on_the_way_down_to_the_end_does_not_lengthen_the_way(void)
{
    begin_manner(100000 * STEP_ACCEL_PER_ACCEL, false);
    add(10000, 0, 0, 0, 50000);
    start();
    while (position[0] < 9000) {
        run_us(100);
    }
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_FAULT));
    run_to_the_end();
    assert_arrived();
    TEST_ASSERT_UINT64_WITHIN(90000, 118794, made_tick[0][9999] - made_tick[0][9998]);
}

/* A step takes a minute. */
void test_a_change_between_two_slow_steps_takes_effect_at_once(void)
{
    begin_manner(0, true);
    uint32_t speed = 1000;
    struct path_vector vector = vector_of(100, 0, 0, 0, 1);
    vector.speed = 4;
    TEST_ASSERT_TRUE(group_add(&group, &vector));
    start();
    run_us(70000000);
    TEST_ASSERT_EQUAL_UINT(1, made[0]);
    group_set_speeds(&group, &(struct group_speeds){.of = slow, .context = &speed});
    run_us(2000);
    TEST_ASSERT_EQUAL_UINT(2, made[0]);
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_PAUSE));
    run_us(2000);
    TEST_ASSERT_TRUE(group_take_end(&group));
}

void test_an_axis_that_has_never_moved_stays_in_step_with_the_others(void)
{
    uint32_t speed = 15000;
    add(200, 0, 0, 0, 20000);
    start();
    for (unsigned i = 0; i < 3 * RING; i++) {
        add(200, 0, 0, 0, 20000);
        run_us(9000);
    }
    add(2000, 0, 0, 0, 20000);
    run_us(3000);
    group_set_speeds(&group, &(struct group_speeds){.of = slow, .context = &speed});
    run_to_the_end();
    assert_arrived();
}
