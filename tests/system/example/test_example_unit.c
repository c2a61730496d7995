/* A unit with another language on the engine's door: it moves, it stops, and it takes nothing else. */
#include "example_unit.h"
#include "unity.h"

#include "base_tick.h"
#include "epoch.h"
#include "host_machine.h"

static struct host_machine machine;
static struct example_unit unit;

void setUp(void)
{
    host_machine_init(&machine, epoch_random());
    host_machine_select(&machine);
    example_unit_start(&unit);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

static uint64_t poll(void *context)
{
    (void)context;
    example_unit_poll(&unit);
    return TICK_NEVER;
}

static void run_ms(uint64_t milliseconds)
{
    host_machine_run(&machine, machine.now + milliseconds * TICKS_PER_MS, poll, NULL, NULL);
}

static void assert_stands(unsigned motor, int64_t position_steps, enum axis_cause cause)
{
    TEST_ASSERT_FALSE(axis_is_busy(&unit.axis[motor]));
    TEST_ASSERT_EQUAL_INT64(position_steps, axis_position_steps(&unit.axis[motor]));
    TEST_ASSERT_EQUAL_INT(cause, axis_cause(&unit.axis[motor]));
}

/* Stopped on its way, it has gone some steps and not all. */
static void assert_stopped(unsigned motor, enum axis_cause cause)
{
    int64_t position = axis_position_steps(&unit.axis[motor]);
    TEST_ASSERT_TRUE(position > 0 && position < 1000);
    assert_stands(motor, position, cause);
}

void test_both_motors_run_as_ordered_and_back_again(void)
{
    example_unit_take(&unit, 'f');
    example_unit_take(&unit, 'B');
    run_ms(1000);
    assert_stands(0, 1000, AXIS_CAUSE_NONE);
    assert_stands(1, -1000, AXIS_CAUSE_NONE);

    example_unit_take(&unit, 'b');
    run_ms(1000);
    assert_stands(0, 0, AXIS_CAUSE_NONE);
    TEST_ASSERT_EQUAL_UINT64(3000, machine.pulses);
}

void test_s_stops_its_motor_and_not_the_other(void)
{
    example_unit_take(&unit, 'f');
    example_unit_take(&unit, 'F');
    run_ms(300);
    example_unit_take(&unit, 'S');
    run_ms(1000);
    assert_stands(0, 1000, AXIS_CAUSE_NONE);
    assert_stopped(1, AXIS_CAUSE_COMMAND);
}

void test_an_input_stops_its_motor_and_not_the_other(void)
{
    example_unit_take(&unit, 'f');
    example_unit_take(&unit, 'F');
    run_ms(300);
    host_machine_set_input(&machine, 2, true);
    run_ms(1000);
    assert_stands(0, 1000, AXIS_CAUSE_NONE);
    assert_stopped(1, AXIS_CAUSE_HIGH);
}

void test_an_input_that_is_1_from_the_start_lets_its_motor_make_no_step(void)
{
    host_machine_set_input(&machine, 1, true);
    example_unit_start(&unit);
    example_unit_take(&unit, 'f');
    run_ms(1000);
    assert_stands(0, 0, AXIS_CAUSE_HIGH);
}

void test_a_motor_that_runs_takes_no_other_order(void)
{
    example_unit_take(&unit, 'f');
    run_ms(100);
    example_unit_take(&unit, 'b');
    run_ms(1000);
    assert_stands(0, 1000, AXIS_CAUSE_NONE);
}

void test_what_is_no_order_moves_nothing(void)
{
    const char letters[] = "aA@zZ{1 \n";
    for (const char *letter = letters; *letter != '\0'; letter++) {
        example_unit_take(&unit, *letter);
    }
    run_ms(1000);
    TEST_ASSERT_EQUAL_UINT64(0, machine.pulses);
}
