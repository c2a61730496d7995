/* What onlookers are told of the queue: each motion begins and ends for every axis, and why it was stopped. */
#include "gve_queue_rig.h"

#include "axis_cause.h"

void setUp(void)
{
    rig_set_up();
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

static void expect_told(unsigned place, unsigned motor, enum hal_trace_event event, int64_t value)
{
    TEST_ASSERT_LESS_THAN(rig_told_count, place);
    TEST_ASSERT_EQUAL_UINT(motor, rig_told[place].motor);
    TEST_ASSERT_EQUAL(event, rig_told[place].event);
    TEST_ASSERT_EQUAL_INT64(value, rig_told[place].value);
}

/* Of each axis in its turn. */
static void expect_of_all(unsigned place, enum hal_trace_event event, const int64_t values[UNIT_MOTORS])
{
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        expect_told(place + motor, motor + 1U, event, values[motor]);
        TEST_ASSERT_EQUAL_UINT64(rig_told[place].tick, rig_told[place + motor].tick);
    }
}

static const int64_t nothing[UNIT_MOTORS] = {0};

void test_a_motion_begins_and_ends_for_each_axis_with_the_steps_it_made(void)
{
    gve_queue_set_position(&queue, 2, 1000);
    gve_queue_enter(&queue, (const int32_t[]){60, -50, 40, 7});
    gve_queue_begin(&queue, machine.inputs);
    uint64_t begun = machine.now;
    rig_run_to_the_end();
    TEST_ASSERT_EQUAL_UINT(2 * UNIT_MOTORS, rig_told_count);
    expect_of_all(0, HAL_TRACE_MOVE, nothing);
    expect_of_all(UNIT_MOTORS, HAL_TRACE_DONE, (const int64_t[]){60, -50, 40, 7});
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(begun + 500 * TICKS_PER_US, rig_told[0].tick);
    TEST_ASSERT_LESS_OR_EQUAL_UINT64(begun + TICKS_PER_MS, rig_told[0].tick);
    TEST_ASSERT_LESS_THAN_UINT64(rig_first_tick[0], rig_told[0].tick);
}

void test_a_motion_ends_with_its_last_pulse_which_may_be_a_tick_after_its_rest(void)
{
    unsigned later = 0;
    for (int32_t way = 1; way < 120; way++) {
        rig_told_count = 0;
        rig_move(0, way);
        rig_run_to_the_end();
        TEST_ASSERT_EQUAL_UINT64(rig_last_tick[0], rig_told[UNIT_MOTORS].tick);
        later += group_end_tick(&queue.chain[0].group) - machine.epoch < rig_last_tick[0] ? 1U : 0U;
    }
    TEST_ASSERT_GREATER_THAN_UINT(0, later);
}

void test_a_halt_is_told_of_the_unit_with_its_cause(void)
{
    rig_move(0, 5000);
    rig_run_ms(500);
    (void)gve_queue_halt(&queue);
    expect_told(UNIT_MOTORS, 0, HAL_TRACE_STOP, AXIS_CAUSE_COMMAND);
    (void)gve_queue_halt(&queue);
    TEST_ASSERT_EQUAL_UINT(UNIT_MOTORS + 1, rig_told_count);
    rig_run_to_the_end();
    expect_told(UNIT_MOTORS + 1, 1, HAL_TRACE_DONE, rig_position[0]);
}

void test_an_interrupt_is_told_of_the_unit_with_its_cause(void)
{
    gve_guards_write(&queue.guards, GVE_STATUS_ENABLED_1, 1);
    rig_move(0, 5000);
    rig_run_ms(500);
    host_machine_set_input(&machine, 1, true);
    rig_run_ms(1);
    TEST_ASSERT_EQUAL_UINT(UNIT_MOTORS + 1, rig_told_count);
    expect_told(UNIT_MOTORS, 0, HAL_TRACE_STOP, AXIS_CAUSE_HIGH);
    rig_run_to_the_end();
}

void test_what_goes_on_begins_where_it_stood(void)
{
    rig_move(0, 2000);
    rig_run_ms(500);
    (void)gve_queue_halt(&queue);
    rig_run_to_the_end();
    int64_t stood = rig_position[0];
    rig_told_count = 0;
    gve_queue_go(&queue, machine.inputs);
    rig_run_to_the_end();
    expect_told(UNIT_MOTORS, 1, HAL_TRACE_DONE, 2000 - stood);
}

void test_what_is_stopped_before_its_first_pulse_ends_at_its_start(void)
{
    rig_move(0, 50);
    rig_run_to_the_end();
    rig_told_count = 0;
    rig_move(0, 50);
    (void)gve_queue_halt(&queue);
    rig_run_to_the_end();
    expect_told(UNIT_MOTORS + 1, 1, HAL_TRACE_DONE, 0);
    TEST_ASSERT_EQUAL_UINT64(rig_told[0].tick, rig_told[UNIT_MOTORS + 1].tick);
}

void test_an_abort_is_a_stop_and_the_end_of_what_moves(void)
{
    rig_move(0, 5000);
    rig_run_ms(500);
    gve_queue_abort(&queue);
    TEST_ASSERT_EQUAL_UINT(2 * UNIT_MOTORS + 1, rig_told_count);
    expect_told(UNIT_MOTORS, 0, HAL_TRACE_STOP, AXIS_CAUSE_ABORT);
    expect_told(UNIT_MOTORS + 1, 1, HAL_TRACE_DONE, rig_position[0]);
    expect_told(2 * UNIT_MOTORS, 4, HAL_TRACE_DONE, 0);
}

void test_an_abort_at_rest_tells_nothing(void)
{
    gve_queue_abort(&queue);
    TEST_ASSERT_EQUAL_UINT(0, rig_told_count);
}
