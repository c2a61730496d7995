/* The switch of homing, found in the very moment in which main does something else. */
#include "pos_home_rig.h"

enum {
    BRAKE_STEPS = 100, /* more than it takes from the feed of homing */
};

static bool finds;

/* The tick interrupt that sees the switch comes in the midst of a pass. */
void plc_pass(struct pos_unit *of)
{
    if (finds) {
        finds = false;
        switch_from = rig_position[0];
        (void)pos_axis_sense_isr(&of->axes[0], 1U << (SWITCH - 1U));
    }
}

void setUp(void)
{
    finds = false;
    set_up_homing();
}

void tearDown(void)
{
}

static void allow(int mp)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, FEED(1000), mp, 1));
}

static void assert_turns_at_switch(void)
{
    run_ms(300);
    TEST_ASSERT_LESS_THAN_INT64(switch_from + BRAKE_STEPS, rig_position[0]);
    run_ms(3000);
    assert_home(0);
    TEST_ASSERT_EQUAL_INT64(switch_from - 1, rig_position[0]);
}

void test_a_switch_that_is_found_as_a_hold_is_taken_back_stops_the_axis(void)
{
    home(19, 0);
    run_ms(100);
    allow(0);
    run_ms(2);
    allow(1);
    finds = true;
    assert_turns_at_switch();
}

void test_a_switch_that_is_found_as_the_axis_leaves_a_stand_stops_it(void)
{
    home(19, 0);
    run_ms(100);
    allow(0);
    run_ms(500);
    allow(1);
    finds = true;
    assert_turns_at_switch();
}

static void assert_homing_is_given_up(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    run_ms(500);
    TEST_ASSERT_EQUAL_HEX(0, rig_values(1).flags & POS_FLAG_HOMING);
    TEST_ASSERT_EQUAL_HEX(0, rig_control(1) & (unsigned)POS_CNT_CONT);
    int64_t stood = rig_position[0];
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 1000, ACCEL, 1));
    allow(1);
    run_ms(1000);
    TEST_ASSERT_EQUAL_INT64(stood + 100, rig_position[0]);
}

void test_a_homing_that_is_given_up_as_the_switch_is_found_leaves_nothing(void)
{
    home(19, 0);
    run_ms(100);
    (void)pos_axis_sense_isr(&unit.axes[0], 1U << (SWITCH - 1U));
    assert_homing_is_given_up();
}

void test_a_homing_that_is_given_up_on_its_brake_at_the_switch_leaves_nothing(void)
{
    home(19, 0);
    run_ms(100);
    switch_from = rig_position[0];
    run_ms(2);
    TEST_ASSERT_TRUE(unit.axes[0].found);
    TEST_ASSERT_TRUE(pos_axis_is_busy(&unit.axes[0]));
    assert_homing_is_given_up();
}

void test_what_is_another_input_than_switch_and_limit_does_not_end_homing(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    rig_run_ms(2);
    set(147, SWITCH, false);
    host_machine_set_input(&machine, 1, true);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    home(19, 0);
    run_ms(3000);
    assert_home(0);
}
