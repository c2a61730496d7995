#include "unity.h"

#include <setjmp.h>
#include <signal.h>

#include "base_tick.h"
#include "hal_flash.h"
#include "hal_io.h"
#include "hal_run.h"
#include "hal_step.h"
#include "hal_trace.h"
#include "host_machine.h"

static struct host_machine machine;
static jmp_buf before;

static void leave_abort(int number)
{
    (void)number;
    longjmp(before, 1);
}

/* Whether a call ends in an assertion. */
static bool is_refused(void (*call)(void))
{
    bool refused = true;
    (void)signal(SIGABRT, leave_abort);
    if (setjmp(before) == 0) {
        call();
        refused = false;
    }
    (void)signal(SIGABRT, SIG_DFL);
    return refused;
}

static uint64_t pass_that_holds_the_step_interrupt(void *context)
{
    (void)context;
    hal_step_hold();
    return TICK_NEVER;
}

static uint64_t pass_that_holds_the_plan_interrupt(void *context)
{
    (void)context;
    hal_run_hold_plan();
    return TICK_NEVER;
}

void setUp(void)
{
    host_machine_init(&machine, 0);
    host_machine_select(&machine);
}

void tearDown(void)
{
}

static void arm_twice(void)
{
    hal_step_arm(0, 10);
    hal_step_arm(0, 20);
}

static void arm_motor_4(void)
{
    hal_step_arm(UNIT_MOTORS, 10);
}

static void disarm_motor_4(void)
{
    (void)hal_step_disarm(UNIT_MOTORS);
}

static void turn_motor_4(void)
{
    hal_step_set_direction(UNIT_MOTORS, true);
}

static void turn_an_armed_motor(void)
{
    hal_step_arm(0, 10);
    hal_step_set_direction(0, true);
}

static void light_motor_4(void)
{
    hal_io_set_led(UNIT_MOTORS, true);
}

static void trace_motor_5(void)
{
    hal_trace(0, UNIT_MOTORS + 1, HAL_TRACE_END, 0);
}

static void hold_steps_twice(void)
{
    hal_step_hold();
    hal_step_hold();
}

static void hold_plans_twice(void)
{
    hal_run_hold_plan();
    hal_run_hold_plan();
}

static void hold_steps_beyond_a_pass(void)
{
    host_machine_run(&machine, 10, pass_that_holds_the_step_interrupt, NULL, NULL);
}

static void hold_plans_beyond_a_pass(void)
{
    host_machine_run(&machine, 10, pass_that_holds_the_plan_interrupt, NULL, NULL);
}

static void start_without_interrupts(void)
{
    static const struct hal_client client = {0};
    hal_run_start(&client);
}

static void read_beyond_the_end(void)
{
    uint8_t bytes[2];
    hal_flash_read(0, HAL_FLASH_AREA_BYTES - 1, bytes, 2);
}

static void read_from_far_beyond_the_end(void)
{
    uint8_t byte;
    hal_flash_read(0, HAL_FLASH_AREA_BYTES + 1, &byte, 1);
}

static void write_at_the_end(void)
{
    (void)hal_flash_write_word(0, HAL_FLASH_AREA_BYTES, (const uint8_t[HAL_FLASH_WORD_BYTES]){0});
}

static void write_half_way_between_words(void)
{
    (void)hal_flash_write_word(0, 2, (const uint8_t[HAL_FLASH_WORD_BYTES]){0});
}

static void erase_area_2(void)
{
    (void)hal_flash_erase(HAL_FLASH_AREAS);
}

static void give_a_script_with_input_0(void)
{
    static const struct host_input script[] = {{.input = 0}};
    host_machine_set_script(&machine, script, 1);
}

static void give_a_script_with_input_9(void)
{
    static const struct host_input script[] = {{.input = UNIT_INPUTS + 1}};
    host_machine_set_script(&machine, script, 1);
}

static void give_a_script_out_of_order(void)
{
    static const struct host_input script[] = {{.tick = 2, .input = 1}, {.tick = 1, .input = 1}};
    host_machine_set_script(&machine, script, 2);
}

static void use_no_machine(void)
{
    host_machine_select(NULL);
    (void)hal_io_read_inputs();
}

void test_a_motor_can_be_armed_only_once(void)
{
    TEST_ASSERT_TRUE(is_refused(arm_twice));
}

void test_there_are_four_motors(void)
{
    TEST_ASSERT_TRUE(is_refused(arm_motor_4));
    TEST_ASSERT_TRUE(is_refused(disarm_motor_4));
    TEST_ASSERT_TRUE(is_refused(turn_motor_4));
    TEST_ASSERT_TRUE(is_refused(light_motor_4));
    TEST_ASSERT_TRUE(is_refused(trace_motor_5));
}

void test_the_direction_of_an_armed_motor_cannot_be_set(void)
{
    TEST_ASSERT_TRUE(is_refused(turn_an_armed_motor));
}

void test_an_interrupt_is_held_only_once(void)
{
    TEST_ASSERT_TRUE(is_refused(hold_steps_twice));
    TEST_ASSERT_TRUE(is_refused(hold_plans_twice));
}

void test_only_what_is_held_can_be_released(void)
{
    TEST_ASSERT_TRUE(is_refused(hal_step_release));
    TEST_ASSERT_TRUE(is_refused(hal_run_release_plan));
}

void test_nothing_is_held_beyond_a_pass_of_main(void)
{
    TEST_ASSERT_TRUE(is_refused(hold_steps_beyond_a_pass));
    setUp();
    TEST_ASSERT_TRUE(is_refused(hold_plans_beyond_a_pass));
}

void test_interrupts_held_and_released_are_let_through(void)
{
    hal_step_hold();
    hal_step_release();
    hal_run_hold_plan();
    hal_run_release_plan();

    TEST_ASSERT_FALSE(machine.step_held);
    TEST_ASSERT_FALSE(machine.plan_held);
}

void test_both_interrupts_are_needed_to_start(void)
{
    TEST_ASSERT_TRUE(is_refused(start_without_interrupts));
}

void test_flash_ends_where_its_areas_end(void)
{
    TEST_ASSERT_TRUE(is_refused(read_beyond_the_end));
    TEST_ASSERT_TRUE(is_refused(read_from_far_beyond_the_end));
    TEST_ASSERT_TRUE(is_refused(write_at_the_end));
    TEST_ASSERT_TRUE(is_refused(erase_area_2));
}

void test_flash_is_written_at_whole_words_only(void)
{
    TEST_ASSERT_TRUE(is_refused(write_half_way_between_words));
}

void test_a_script_has_inputs_1_to_8_in_order_of_time(void)
{
    TEST_ASSERT_TRUE(is_refused(give_a_script_with_input_0));
    TEST_ASSERT_TRUE(is_refused(give_a_script_with_input_9));
    TEST_ASSERT_TRUE(is_refused(give_a_script_out_of_order));
}

void test_a_machine_must_be_selected(void)
{
    TEST_ASSERT_TRUE(is_refused(use_no_machine));
}
