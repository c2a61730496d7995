/* Homing: to the switch, off it, and back to where it was left; by which measures then count. The switch is input 3. */
#include "pos_home_rig.h"

void setUp(void)
{
    set_up_homing();
}

void tearDown(void)
{
}

void test_an_axis_stands_where_the_switch_was_left(void)
{
    home(19, 5000);
    run_ms(100);
    TEST_ASSERT_EQUAL_HEX(0x0103, rig_status(1));
    TEST_ASSERT_EQUAL_HEX(POS_FLAG_HOMING, rig_values(1).flags & (POS_FLAG_REFERENCED | POS_FLAG_HOMING));
    run_ms(3000);
    assert_home(5000);
    TEST_ASSERT_EQUAL_INT64(299, rig_position[0]);
    TEST_ASSERT_EQUAL_INT32(299, rig_values(1).position_steps);
}

void test_an_axis_on_the_switch_leaves_it_at_once(void)
{
    switch_from = -50;
    home(19, -5000);
    run_ms(3000);
    assert_home(-5000);
    TEST_ASSERT_EQUAL_INT64(-51, rig_position[0]);
}

void test_a_switch_that_was_active_before_it_was_the_reference_is_left_too(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    rig_run_ms(2);
    set(148, 0, false);
    switch_from = -50;
    run_ms(2);
    set(148, SWITCH, false);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    home(19, 0);
    run_ms(3000);
    assert_home(0);
    TEST_ASSERT_EQUAL_INT64(-51, rig_position[0]);
}

void test_the_negative_method_goes_the_other_way(void)
{
    switch_from = -100000;
    switch_to = -200;
    home(21, 0);
    run_ms(5000);
    assert_home(0);
    TEST_ASSERT_EQUAL_INT64(-199, rig_position[0]);
}

void test_a_short_switch_that_is_passed_is_found_again_on_the_way_back(void)
{
    switch_to = 303;
    home(19, 0);
    run_ms(5000);
    assert_home(0);
    TEST_ASSERT_EQUAL_INT64(299, rig_position[0]);
}

void test_the_present_place_can_be_the_reference(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 37, 123456, 0, 1));
    rig_run_ms(2);
    assert_home(123456);
    TEST_ASSERT_EQUAL_UINT(0, rig_pulses[0]);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode_abs(&unit, NULL, 122456, ACCEL, 1));
    (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_INT64(-100, rig_position[0]);
    TEST_ASSERT_EQUAL_INT32(122456, rig_values(1).position_um);
}

void test_a_switch_that_is_not_found_is_a_fault(void)
{
    switch_from = 100000;
    home(19, 0);
    run_ms(4000);
    TEST_ASSERT_EQUAL_HEX(0x0005, rig_status(1));
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_HOME, rig_values(1).error);
    TEST_ASSERT_EQUAL_INT64(2000, rig_position[0]);
    TEST_ASSERT_EQUAL_HEX(0, rig_values(1).flags & POS_FLAG_REFERENCED);
}

void test_a_switch_that_is_never_left_is_a_fault(void)
{
    switch_from = -100000;
    home(19, 0);
    run_ms(25000);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_HOME, rig_values(1).error);
    TEST_ASSERT_EQUAL_INT64(-2000, rig_position[0]);
}

void test_homing_is_held_and_goes_on_in_each_of_its_parts(void)
{
    home(19, 0);
    for (unsigned i = 0; i < 200 && (rig_status(1) & 0x0800U) == 0; i++) {
        (void)pos_control(&unit, NULL, FEED(1000), 0, 1);
        run_ms(10 + i % 7);
        (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
        run_ms(20 + i % 13);
    }
    assert_home(0);
    TEST_ASSERT_EQUAL_INT64(299, rig_position[0]);
}

void test_a_switch_that_becomes_active_while_homing_is_held_is_not_missed(void)
{
    home(19, 0);
    run_ms(100);
    (void)pos_control(&unit, NULL, FEED(1000), 0, 1);
    run_ms(500);
    int64_t stood = rig_position[0];
    switch_from = stood - 3;
    run_ms(10);
    (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
    run_ms(3000);
    assert_home(0);
    TEST_ASSERT_EQUAL_INT64(stood - 4, rig_position[0]);
}

void test_a_switch_that_is_left_while_homing_is_held_has_been_left_where_the_axis_stands(void)
{
    home(19, 70);
    for (unsigned i = 0; i < 5000 && unit.axes[0].phase != (uint8_t)POS_PHASE_LEAVE; i++) {
        run_ms(1);
    }
    (void)pos_control(&unit, NULL, FEED(1000), 0, 1);
    run_ms(300);
    TEST_ASSERT_EQUAL_HEX(0x0003, rig_status(1) & 0xFDFFU);
    int64_t stood = rig_position[0];
    TEST_ASSERT_TRUE(stood >= 300);
    switch_from = stood + 1;
    run_ms(10);
    assert_home(70);
    (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
    run_ms(3000);
    assert_home(70);
    TEST_ASSERT_EQUAL_INT64(stood, rig_position[0]);
}

void test_a_homing_that_is_given_up_leaves_positions_as_they_were(void)
{
    home(19, 777);
    run_ms(150);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    run_ms(200);
    TEST_ASSERT_EQUAL_HEX(0x0001, rig_status(1));
    TEST_ASSERT_EQUAL_INT32(10 * (int32_t)rig_position[0], rig_values(1).position_um);
    TEST_ASSERT_EQUAL_HEX(0, rig_values(1).flags & (POS_FLAG_REFERENCED | POS_FLAG_HOMING));
}

void test_homing_is_refused_without_its_input_or_with_another_method(void)
{
    TEST_ASSERT_EQUAL_INT(POS_ERROR_METHOD, pos_home(&unit, NULL, 20, 0, ACCEL, 1));
    TEST_ASSERT_EQUAL_INT(POS_ERROR_ACCEL, pos_home(&unit, NULL, 21, 0, 0, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    rig_run_ms(2);
    set(148, 0, false);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    TEST_ASSERT_EQUAL_INT(POS_ERROR_NO_INPUT, pos_home(&unit, NULL, 21, 0, ACCEL, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 37, 0, 0, 1));
}

void test_the_limit_input_may_be_the_switch(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    rig_run_ms(2);
    set(147, SWITCH, false);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    home(19, 0);
    run_ms(3000);
    assert_home(0);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 1000, ACCEL, 1));
    (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
    run_ms(100);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_LIMIT, rig_values(1).error);
}

void test_another_limit_input_ends_homing(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    rig_run_ms(2);
    set(147, (uint32_t)-4, false);
    host_machine_set_input(&machine, 4, true);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    home(19, 0);
    run_ms(100);
    host_machine_set_input(&machine, 4, false);
    run_ms(100);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_LIMIT, rig_values(1).error);
    TEST_ASSERT_EQUAL_HEX(0x0005, rig_status(1));
}

/* ---- a fast way off the switch, which has to be come back to ---------------------------------------------------- */

static void set_up_fast(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    rig_run_ms(2);
    set(152, FEED(1000), true);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
}

void test_an_axis_that_has_gone_past_the_edge_comes_back_to_it(void)
{
    set_up_fast();
    home(19, 40);
    run_until(POS_PHASE_RETURN);
    TEST_ASSERT_TRUE(rig_position[0] < 299);
    TEST_ASSERT_EQUAL_HEX(0x0103, rig_status(1) & 0xFDFFU);
    TEST_ASSERT_EQUAL_INT32(0, rig_values(1).way_left_um);
    run_ms(100);
    assert_home(40);
    TEST_ASSERT_EQUAL_INT64(299, rig_position[0]);
}

static void hold_in(enum pos_phase phase)
{
    run_until(phase);
    run_ms(4);
    (void)pos_control(&unit, NULL, FEED(1000), 0, 1);
    run_ms(200);
    TEST_ASSERT_EQUAL_HEX(0x0003, rig_status(1) & 0xFDFFU);
    TEST_ASSERT_EQUAL_UINT8(phase, unit.axes[0].phase);
    (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
}

void test_each_part_of_homing_is_held_and_goes_on(void)
{
    set_up_fast();
    home(19, 0);
    hold_in(POS_PHASE_FIND);
    hold_in(POS_PHASE_LEAVE);
    hold_in(POS_PHASE_RETURN);
    run_ms(500);
    assert_home(0);
    TEST_ASSERT_EQUAL_INT64(299, rig_position[0]);
}

/* It brakes, as the switch has been found, when the permit goes. */
void test_homing_that_is_held_between_two_parts_stands_and_goes_on(void)
{
    home(19, 0);
    for (unsigned i = 0; i < 5000 && !unit.axes[0].found; i++) {
        run_ms(1);
    }
    (void)pos_control(&unit, NULL, FEED(1000), 0, 1);
    run_ms(200);
    TEST_ASSERT_EQUAL_UINT8(POS_PHASE_LEAVE, unit.axes[0].phase);
    TEST_ASSERT_EQUAL_HEX(0x0003, rig_status(1));
    (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
    run_ms(5000);
    assert_home(0);
    TEST_ASSERT_EQUAL_INT64(299, rig_position[0]);
}

void test_homing_goes_no_faster_than_the_feed(void)
{
    home(19, 0);
    (void)pos_control(&unit, NULL, FEED(60), 1, 1);
    run_ms(200);
    TEST_ASSERT_UINT32_WITHIN(FEED(1), FEED(60), rig_values(1).speed);
    (void)pos_control(&unit, NULL, FEED(6000), 1, 1);
    run_ms(200);
    TEST_ASSERT_UINT32_WITHIN(FEED(1), FEED(600), rig_values(1).speed);
}

void test_another_input_that_changes_does_not_end_the_way_off_the_switch(void)
{
    home(19, 0);
    run_until(POS_PHASE_LEAVE);
    run_ms(10);
    host_machine_set_input(&machine, 7, true);
    run_ms(10);
    TEST_ASSERT_FALSE(unit.axes[0].found);
    run_ms(3000);
    assert_home(0);
    TEST_ASSERT_EQUAL_INT64(299, rig_position[0]);
}

/* The switch is between, so it comes and goes on the way back. */
void test_another_input_that_changes_before_a_switch_that_was_passed_does_not_end_the_way_off_it(void)
{
    switch_to = 303;
    home(19, 0);
    run_until(POS_PHASE_LEAVE);
    TEST_ASSERT_TRUE(rig_position[0] > switch_to + 2);
    run_ms(3);
    host_machine_set_input(&machine, 7, true);
    run_ms(1);
    TEST_ASSERT_TRUE(rig_position[0] > switch_to);
    TEST_ASSERT_FALSE(unit.axes[0].found);
    run_ms(3000);
    assert_home(0);
    TEST_ASSERT_EQUAL_INT64(299, rig_position[0]);
}

void test_a_limit_of_the_same_input_the_other_way_round_is_the_switch_too(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    rig_run_ms(2);
    set(147, (uint32_t)-SWITCH, false);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    home(19, 0);
    run_ms(3000);
    assert_home(0);
}

/* It has left the switch, comes back to it for a moment, and main is late. */
void test_the_first_edge_off_the_switch_is_the_reference(void)
{
    switch_from = -100000;
    home(19, 0);
    run_until(POS_PHASE_LEAVE);
    run_ms(50);
    int64_t left = rig_position[0];
    (void)pos_axis_sense_isr(&unit.axes[0], 0);
    rig_run_without_main(TICKS_PER_MS);
    (void)pos_axis_sense_isr(&unit.axes[0], 1U << (SWITCH - 1U));
    (void)pos_axis_sense_isr(&unit.axes[0], 0);
    TEST_ASSERT_TRUE(rig_position[0] < left);
    switch_from = 100000;
    run_ms(3000);
    assert_home(0);
    TEST_ASSERT_EQUAL_INT64(left, rig_position[0]);
}

void test_a_homing_that_is_given_up_at_the_switch_leaves_no_hold_that_stays(void)
{
    home(19, 0);
    for (unsigned i = 0; i < 5000 && !unit.axes[0].found; i++) {
        run_ms(1);
    }
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    run_ms(100);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 100000, ACCEL, 1));
    (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
    run_ms(200);
    (void)pos_control(&unit, NULL, FEED(1000), 0, 1);
    run_ms(10);
    (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
    run_ms(8);
    TEST_ASSERT_TRUE(rig_values(1).speed > FEED(700));
}

/* The tick interrupt, between the resume and the look at what it has found. */
static void find_now(void *context, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    (void)context;
    (void)tick;
    (void)motor;
    (void)value;
    if (event == HAL_TRACE_SPEED) {
        switch_from = rig_position[0];
        if (pos_axis_sense_isr(&unit.axes[0], 1U << (SWITCH - 1U))) {
            hal_run_plan();
        }
    }
}

void test_a_switch_that_is_found_in_the_moment_of_a_resume_stops_the_axis(void)
{
    home(19, 0);
    run_ms(100);
    (void)pos_control(&unit, NULL, FEED(1000), 0, 1);
    run_ms(5);
    int64_t found = rig_position[0];
    machine.listener.trace = find_now;
    (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
    rig_run_ticks(1);
    machine.listener.trace = NULL;
    TEST_ASSERT_TRUE(unit.axes[0].watch.reference_hit);
    run_until(POS_PHASE_LEAVE);
    TEST_ASSERT_TRUE(rig_position[0] < found + 15);
    run_ms(3000);
    assert_home(0);
    TEST_ASSERT_EQUAL_INT64(found - 1, rig_position[0]);
}

/* It brakes, as the switch has been found, when the permit goes and comes back. */
void test_a_hold_that_ends_before_the_stand_at_the_switch_changes_nothing(void)
{
    home(19, 0);
    for (unsigned i = 0; i < 5000 && !unit.axes[0].found; i++) {
        run_ms(1);
    }
    (void)pos_control(&unit, NULL, FEED(1000), 0, 1);
    run_ms(3);
    (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
    run_ms(3000);
    assert_home(0);
    TEST_ASSERT_EQUAL_INT64(299, rig_position[0]);
}
