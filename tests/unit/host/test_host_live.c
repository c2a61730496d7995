/* What those need who run a machine in slices, beside a real clock. */
#include "unity.h"

#include "base_tick.h"
#include "hal_io.h"
#include "hal_run.h"
#include "hal_step.h"
#include "host_machine.h"

#include "given_pulses.h"

static struct host_machine machine;
static uint64_t wanted; /* what main answers */
static unsigned passes;
static unsigned ticks;
static unsigned sensed; /* inputs that the tick interrupt saw */
static uint64_t seen_tick;

static uint64_t main_pass(void *context)
{
    (void)context;
    passes++;
    return wanted;
}

static void tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
    ticks++;
    sensed = hal_io_read_inputs();
}

static void plan_isr(void *context)
{
    (void)context;
}

static void input_seen(void *context, uint64_t tick, uint8_t levels)
{
    (void)context;
    (void)levels;
    seen_tick = tick;
}

void setUp(void)
{
    static const struct hal_client client = {.lay_isr = given_lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    given_clear();
    host_machine_init(&machine, 0);
    host_machine_select(&machine);
    hal_run_start(&client);
    machine.listener.input = input_seen;
    wanted = TICK_NEVER;
    passes = 0;
    ticks = 0;
    sensed = 0;
    seen_tick = 0;
}

void tearDown(void)
{
}

static void run_until(uint64_t until)
{
    host_machine_run(&machine, until, main_pass, NULL, NULL);
}

void test_an_input_set_between_runs_is_sensed_and_told_at_once(void)
{
    run_until(100);

    host_machine_set_input(&machine, 8, true);

    TEST_ASSERT_EQUAL_HEX8(0x80, machine.inputs);
    TEST_ASSERT_EQUAL_HEX8(0x80, sensed);
    TEST_ASSERT_EQUAL_UINT64(100, seen_tick);
}

void test_an_input_set_to_the_level_that_it_has_is_no_event(void)
{
    host_machine_set_input(&machine, 1, false);

    TEST_ASSERT_EQUAL_UINT(0, ticks);
}

void test_an_input_is_set_on_the_machine_that_is_meant(void)
{
    static struct host_machine other;
    host_machine_init(&other, 0);
    host_machine_select(&other);

    host_machine_set_input(&machine, 2, true);

    TEST_ASSERT_EQUAL_HEX8(2, sensed);
    TEST_ASSERT_EQUAL_HEX8(0, other.inputs);
}

void test_an_input_goes_back_to_0(void)
{
    host_machine_set_input(&machine, 3, true);
    host_machine_set_input(&machine, 4, true);
    host_machine_set_input(&machine, 3, false);

    TEST_ASSERT_EQUAL_HEX8(8, machine.inputs);
}

void test_nothing_is_next_when_main_waits_for_nothing(void)
{
    run_until(100);

    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, host_machine_next_tick(&machine));
}

void test_the_pass_that_main_wants_is_next(void)
{
    wanted = 5000;
    run_until(100);

    TEST_ASSERT_EQUAL_UINT64(5000, host_machine_next_tick(&machine));
}

void test_a_pulse_that_waits_is_next(void)
{
    wanted = 5000;
    run_until(100);
    lay_pulse(2, 300);

    TEST_ASSERT_EQUAL_UINT64(300, host_machine_next_tick(&machine));
}

void test_an_input_of_the_script_is_next(void)
{
    static const struct host_input script[] = {{.tick = 200, .input = 1, .level = true}};
    wanted = 5000;
    host_machine_set_script(&machine, script, 1);
    run_until(100);

    TEST_ASSERT_EQUAL_UINT64(200, host_machine_next_tick(&machine));
}

void test_slices_make_the_pulses_of_one_run(void)
{
    lay_pulse(0, 1000);
    for (uint64_t until = 0; until <= 1000; until += 10) {
        run_until(until);
        TEST_ASSERT_EQUAL_UINT64(0, machine.pulses);
    }

    run_until(1001);

    TEST_ASSERT_EQUAL_UINT64(1, machine.pulses);
}
