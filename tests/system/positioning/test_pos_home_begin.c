/* How homing begins, when its switch has changed before; and what takes the place of one that is held. */
#include "pos_home_rig.h"

void setUp(void)
{
    set_up_homing();
}

void tearDown(void)
{
}

void test_a_switch_that_comes_and_goes_before_homing_begins_is_not_its_own(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 19, 60, ACCEL, 1));
    run_ms(5);
    switch_from = 0;
    run_ms(5);
    switch_from = 300;
    run_ms(5);
    TEST_ASSERT_EQUAL_HEX(0x0003, rig_status(1));
    TEST_ASSERT_EQUAL_HEX(POS_CNT_MP | POS_CNT_CONT, rig_control(1));
    TEST_ASSERT_EQUAL_HEX(POS_FLAG_HOMING, rig_values(1).flags);
    (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
    run_ms(100);
    TEST_ASSERT_GREATER_THAN_INT64(10, rig_position[0]);
    run_ms(3000);
    assert_home(60);
    TEST_ASSERT_EQUAL_INT64(299, rig_position[0]);
}

void test_where_homing_goes_first_is_seen_when_it_begins(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 19, 0, ACCEL, 1));
    run_ms(5);
    switch_from = -50;
    run_ms(5);
    (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
    run_ms(100);
    TEST_ASSERT_LESS_THAN_INT64(0, rig_position[0]);
    run_ms(3000);
    assert_home(0);
    TEST_ASSERT_EQUAL_INT64(-51, rig_position[0]);
}

void test_an_axis_that_is_homed_again_is_not_referenced_from_its_begin_on(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 37, 0, 0, 1));
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 19, 0, ACCEL, 1));
    run_ms(5);
    TEST_ASSERT_EQUAL_HEX(POS_FLAG_REFERENCED | POS_FLAG_HOMING, rig_values(1).flags);
    (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
    run_ms(5);
    TEST_ASSERT_EQUAL_HEX(POS_FLAG_HOMING, rig_values(1).flags);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    run_ms(100);
    TEST_ASSERT_EQUAL_HEX(0, rig_values(1).flags);
}

void test_a_measure_takes_the_place_of_a_homing_that_is_held(void)
{
    home(19, 0);
    run_ms(100);
    (void)pos_control(&unit, NULL, FEED(1000), 0, 1);
    run_ms(500);
    int64_t stood = rig_position[0];
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 5000, ACCEL, 1));
    (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
    run_ms(300);
    TEST_ASSERT_EQUAL_HEX(0, rig_values(1).flags & POS_FLAG_HOMING);
    TEST_ASSERT_UINT32_WITHIN(FEED(1), FEED(1000), rig_values(1).speed);
    TEST_ASSERT_NOT_EQUAL_INT32(0, rig_values(1).way_left_um);
    run_ms(3000);
    TEST_ASSERT_EQUAL_HEX(0x0803, rig_status(1));
    TEST_ASSERT_EQUAL_INT64(stood + 500, rig_position[0]);
}

void test_a_homing_is_begun_anew_by_one_that_takes_its_place(void)
{
    home(19, 0);
    run_until(POS_PHASE_LEAVE);
    run_ms(20);
    (void)pos_control(&unit, NULL, FEED(1000), 0, 1);
    run_ms(500);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 19, 0, ACCEL, 1));
    run_ms(5);
    int64_t stood = rig_position[0];
    switch_from = stood + 50;
    run_ms(5);
    TEST_ASSERT_EQUAL_HEX(0x0003, rig_status(1) & 0xFDFFU);
    (void)pos_control(&unit, NULL, FEED(1000), 1, 1);
    run_ms(3000);
    assert_home(0);
    TEST_ASSERT_EQUAL_INT64(stood + 49, rig_position[0]);
}

void test_a_way_of_homing_below_a_step_is_a_fault_at_once(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    rig_run_ms(2);
    set(154, 4, true);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    home(19, 0);
    run_ms(10);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_HOME, rig_values(1).error);
    TEST_ASSERT_EQUAL_UINT(0, rig_pulses[0]);
}
