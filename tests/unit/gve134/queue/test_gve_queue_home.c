/* What the commands of a unit cannot tell apart of reference runs. The rest is in tests/system/gve134. */
#include "gve_queue_rig.h"

enum {
    WAY = -20000,
    WAY_BACK = 1000,
};

void setUp(void)
{
    rig_set_up();
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

static void begin_home(unsigned axis, int32_t way)
{
    const struct gve_home_order order = {
        .axis = axis, .way = way, .speed = 1000, .way_back = WAY_BACK, .speed_back = 500};
    gve_queue_home(&queue, &order, machine.inputs);
}

/* Runs until an axis is at a place. */
static void run_to(unsigned axis, int64_t place)
{
    while (rig_position[axis] != place) {
        host_machine_run(&machine, machine.now + 10U * TICKS_PER_US, rig_poll, NULL, NULL);
        TEST_ASSERT_TRUE(gve_queue_moves(&queue));
    }
}

/* The switch is hit 300 pulses on the way, and lets go a pulse after that place on the way back. */
static void find_switch(unsigned axis)
{
    int64_t begin = rig_position[axis];
    begin_home(axis, WAY);
    run_to(axis, begin - 300);
    host_machine_set_input(&machine, axis + 1U, true);
    run_to(axis, begin - 310);
    run_to(axis, begin - 299);
    host_machine_set_input(&machine, axis + 1U, false);
    rig_run_to_the_end();
}

void test_another_factor_does_not_change_a_reference_run(void)
{
    begin_home(0, -2000);
    rig_run_ms(500);
    int64_t before = rig_position[0];
    gve_queue_change(&queue, 10U * GVE_FACTOR_ONE, true);
    rig_run_ms(500);
    TEST_ASSERT_INT64_WITHIN(2, before - 500, rig_position[0]);
    rig_run_ms(2000);
    TEST_ASSERT_EQUAL_INT64(-2000, rig_position[0]);
    TEST_ASSERT_EQUAL(GVE_HOME_NOT_FOUND, gve_queue_home_result(&queue));
}

void test_the_own_switch_of_each_axis_does_not_interrupt(void)
{
    for (unsigned axis = 0; axis < (unsigned)UNIT_MOTORS; axis++) {
        rig_set_up();
        gve_guards_write(&queue.guards, GVE_STATUS_ENABLED_1, 0x0F);
        find_switch(axis);
        TEST_ASSERT_EQUAL(GVE_HOME_DONE, gve_queue_home_result(&queue));
        TEST_ASSERT_EQUAL_INT64(-298, rig_position[axis]);
        TEST_ASSERT_EQUAL_HEX8(0, gve_guards_read(&queue.guards, GVE_STATUS_CAUSE_1));
    }
}

void test_the_way_back_counts_from_where_it_begins(void)
{
    gve_queue_set_position(&queue, 0, 100000);
    find_switch(0);
    TEST_ASSERT_EQUAL(GVE_HOME_DONE, gve_queue_home_result(&queue));
    TEST_ASSERT_EQUAL_INT64(-298, rig_position[0]);
    gve_queue_set_position(&queue, 0, -100000);
    find_switch(0);
    TEST_ASSERT_EQUAL(GVE_HOME_DONE, gve_queue_home_result(&queue));
}

void test_a_run_knows_nothing_of_the_one_before(void)
{
    find_switch(0);
    begin_home(0, 50);
    rig_run_to_the_end();
    TEST_ASSERT_EQUAL(GVE_HOME_NOT_FOUND, gve_queue_home_result(&queue));
    TEST_ASSERT_EQUAL_INT64(-298 + 50, rig_position[0]);
}

void test_a_way_of_one_pulse_has_a_direction(void)
{
    host_machine_set_input(&machine, 1, true);
    begin_home(0, 1);
    run_to(0, -50);
    host_machine_set_input(&machine, 1, false);
    rig_run_to_the_end();
    TEST_ASSERT_EQUAL(GVE_HOME_DONE, gve_queue_home_result(&queue));
    TEST_ASSERT_EQUAL_INT64(-51, rig_position[0]);
}

/* At 100 000 pulses/s it goes on for less than half a millisecond, then comes its ramp of 625 pulses. */
void test_the_switch_brakes_the_axis_while_main_is_busy(void)
{
    const struct gve_home_order order = {.way = -200000, .speed = 100000, .way_back = WAY_BACK, .speed_back = 1000};
    queue.modal.accel = 8000;
    gve_queue_home(&queue, &order, 0);
    rig_run_ms(50);
    int64_t before = rig_position[0];
    rig_main_is_busy = true;
    host_machine_set_input(&machine, 1, true);
    host_machine_run(&machine, machine.now + 600U * TICKS_PER_US, rig_poll, NULL, NULL);
    rig_main_is_busy = false;
    rig_run_ms(14);
    TEST_ASSERT_INT64_WITHIN(25, before - 25 - 625, rig_position[0]);
    TEST_ASSERT_EQUAL(GVE_HOME_RUNS, gve_queue_home_result(&queue));
}

void test_a_switch_that_is_not_hit_yet_asks_for_nothing(void)
{
    begin_home(0, WAY);
    run_to(0, -300);
    TEST_ASSERT_FALSE(gve_queue_sense_isr(&queue, 0));
    TEST_ASSERT_TRUE(gve_queue_sense_isr(&queue, 1));
    TEST_ASSERT_FALSE(gve_queue_sense_isr(&queue, 1));
}

/* The axis brakes for its switch for half a second. */
static void begin_to_brake(void)
{
    queue.modal.accel = 2;
    begin_home(0, WAY);
    rig_run_ms(1500);
    host_machine_set_input(&machine, 1, true);
    rig_run_ms(50);
    TEST_ASSERT_EQUAL(GVE_HOME_RUNS, gve_queue_home_result(&queue));
    TEST_ASSERT_TRUE(gve_queue_is_stopping(&queue));
}

static void expect_stopped(void)
{
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL(GVE_HOME_STOPPED, gve_queue_home_result(&queue));
    TEST_ASSERT_TRUE(gve_queue_inta(&queue));
    TEST_ASSERT_FALSE(gve_queue_runs(&queue));
}

void test_a_stop_ends_a_reference_run_also_while_it_brakes_for_its_switch(void)
{
    begin_to_brake();
    gve_queue_stop(&queue);
    expect_stopped();
    TEST_ASSERT_FALSE(queue.intcom);
}

void test_a_halt_ends_a_reference_run_also_while_it_brakes_for_its_switch(void)
{
    begin_to_brake();
    TEST_ASSERT_FALSE(gve_queue_halt(&queue));
    expect_stopped();
}

void test_an_interrupt_while_a_run_brakes_for_its_switch_ends_that_run_alone(void)
{
    gve_guards_write(&queue.guards, GVE_STATUS_ENABLED_1, 2);
    begin_to_brake();
    host_machine_set_input(&machine, 2, true);
    expect_stopped();
    host_machine_set_input(&machine, 1, false);
    host_machine_set_input(&machine, 2, false);
    gve_queue_go(&queue, machine.inputs);
    queue.modal.accel = 20;
    find_switch(0);
    TEST_ASSERT_EQUAL(GVE_HOME_DONE, gve_queue_home_result(&queue));
}

void test_intcom_that_was_written_stays_through_a_run_that_is_interrupted(void)
{
    gve_queue_write_flags(&queue, false, true, machine.inputs);
    gve_guards_write(&queue.guards, GVE_STATUS_ENABLED_1, 2);
    begin_home(0, WAY);
    rig_run_ms(500);
    host_machine_set_input(&machine, 2, true);
    expect_stopped();
    TEST_ASSERT_TRUE(queue.intcom);
}

void test_after_an_abort_the_switch_stops_nothing(void)
{
    begin_home(0, WAY);
    rig_run_ms(500);
    gve_queue_abort(&queue);
    TEST_ASSERT_FALSE(gve_queue_sense_isr(&queue, 1));
}
