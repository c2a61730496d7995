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

#include "given_pulses.h"

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

static void tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
}

static void plan_isr(void *context)
{
    (void)context;
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
    static const struct hal_client client = {.lay_isr = given_lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    given_clear();
    host_machine_init(&machine, 0);
    host_machine_select(&machine);
    hal_run_start(&client);
}

void tearDown(void)
{
}

static void run_motor_4(void)
{
    hal_step_hold();
    hal_step_run(UNIT_MOTORS);
}

static void ask_for_motor_4(void)
{
    hal_step_hold();
    (void)hal_step_waiting(UNIT_MOTORS);
}

static void take_back_of_motor_4(void)
{
    hal_step_hold();
    (void)hal_step_take_back(UNIT_MOTORS, 1);
}

static void connect_motor_4(void)
{
    hal_step_connect(UNIT_MOTORS, true);
}

static void run_without_a_hold(void)
{
    hal_step_run(0);
}

static void ask_without_a_hold(void)
{
    (void)hal_step_waiting(0);
}

static void take_back_without_a_hold(void)
{
    (void)hal_step_take_back(0, 1);
}

static void turn_motor_4(void)
{
    hal_step_set_direction(UNIT_MOTORS, true);
}

static void turn_a_motor_with_a_pulse_to_come(void)
{
    lay_pulse(0, 10);
    hal_step_set_direction(0, true);
}

static void disconnect_a_motor_with_a_pulse_to_come(void)
{
    lay_pulse(0, 10);
    hal_step_connect(0, false);
}

static void turn_the_levels_of_motor_4(void)
{
    hal_step_set_polarity(UNIT_MOTORS, true, false);
}

static void turn_the_levels_of_a_motor_with_a_pulse_to_come(void)
{
    lay_pulse(0, 10);
    hal_step_set_polarity(0, true, false);
}

static void write_a_pwm_above_1000(void)
{
    hal_io_write_pwm(HAL_IO_PWM_MAX + 1);
}

static void light_led_9(void)
{
    hal_io_set_led(HAL_IO_LEDS, true);
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

void test_pulses_are_laid_counted_and_taken_back_only_in_a_hold(void)
{
    TEST_ASSERT_TRUE(is_refused(run_without_a_hold));
    TEST_ASSERT_TRUE(is_refused(ask_without_a_hold));
    TEST_ASSERT_TRUE(is_refused(take_back_without_a_hold));
}

void test_there_are_four_motors(void)
{
    TEST_ASSERT_TRUE(is_refused(run_motor_4));
    setUp();
    TEST_ASSERT_TRUE(is_refused(ask_for_motor_4));
    setUp();
    TEST_ASSERT_TRUE(is_refused(take_back_of_motor_4));
    TEST_ASSERT_TRUE(is_refused(connect_motor_4));
    TEST_ASSERT_TRUE(is_refused(turn_motor_4));
    TEST_ASSERT_TRUE(is_refused(turn_the_levels_of_motor_4));
    TEST_ASSERT_TRUE(is_refused(write_a_pwm_above_1000));
    TEST_ASSERT_TRUE(is_refused(light_led_9));
    TEST_ASSERT_TRUE(is_refused(trace_motor_5));
}

void test_while_a_pulse_waits_a_motor_is_neither_turned_nor_disconnected(void)
{
    TEST_ASSERT_TRUE(is_refused(turn_a_motor_with_a_pulse_to_come));
    setUp();
    TEST_ASSERT_TRUE(is_refused(disconnect_a_motor_with_a_pulse_to_come));
    TEST_ASSERT_TRUE(is_refused(turn_the_levels_of_a_motor_with_a_pulse_to_come));
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
