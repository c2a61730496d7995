#include "unity.h"

#include "base_tick.h"
#include "hal_io.h"
#include "hal_trace.h"
#include "host_machine.h"

static struct host_machine machine;

static struct {
    unsigned count;
    uint64_t tick;
    unsigned what;
    int64_t value;
    enum hal_trace_event event;
} seen;

static void led_seen(void *context, uint64_t tick, unsigned motor, bool on)
{
    (void)context;
    seen.count++;
    seen.tick = tick;
    seen.what = motor;
    seen.value = on;
}

static void output_seen(void *context, uint64_t tick, uint8_t levels)
{
    (void)context;
    seen.count++;
    seen.tick = tick;
    seen.what = levels;
}

static void pwm_seen(void *context, uint64_t tick, uint32_t permille)
{
    (void)context;
    seen.count++;
    seen.tick = tick;
    seen.value = permille;
}

static void trace_seen(void *context, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    (void)context;
    seen.count++;
    seen.tick = tick;
    seen.what = motor;
    seen.event = event;
    seen.value = value;
}

static uint64_t main_pass(void *context)
{
    (void)context;
    return TICK_NEVER;
}

void setUp(void)
{
    host_machine_init(&machine, 5000);
    host_machine_select(&machine);
    host_machine_run(&machine, 300, main_pass, NULL, NULL);
    machine.listener =
        (struct host_listener){.led = led_seen, .output = output_seen, .pwm = pwm_seen, .trace = trace_seen};
    seen.count = 0;
}

void tearDown(void)
{
}

void test_all_inputs_are_0_at_the_start(void)
{
    TEST_ASSERT_EQUAL_HEX8(0, hal_io_read_inputs());
}

void test_outputs_are_told_with_their_time(void)
{
    hal_io_write_outputs(0xA5);

    TEST_ASSERT_EQUAL_HEX8(0xA5, seen.what);
    TEST_ASSERT_EQUAL_UINT64(300, seen.tick);
}

void test_outputs_that_stay_are_not_told(void)
{
    hal_io_write_outputs(0xA5);
    hal_io_write_outputs(0xA5);

    TEST_ASSERT_EQUAL_UINT(1, seen.count);
}

void test_an_led_is_told_when_it_changes(void)
{
    hal_io_set_led(3, false);
    hal_io_set_led(3, true);
    hal_io_set_led(3, true);

    TEST_ASSERT_EQUAL_UINT(1, seen.count);
    TEST_ASSERT_EQUAL_UINT(3, seen.what);
    TEST_ASSERT_EQUAL_INT64(1, seen.value);
    TEST_ASSERT_EQUAL_UINT64(300, seen.tick);
}

void test_eight_leds_are_told_one_by_one(void)
{
    for (unsigned led = 0; led < HAL_IO_LEDS; led++) {
        hal_io_set_led(led, true);
        TEST_ASSERT_EQUAL_UINT(led, seen.what);
    }

    TEST_ASSERT_EQUAL_UINT(8, seen.count);
}

void test_the_pwm_is_told_when_it_changes(void)
{
    hal_io_write_pwm(0);
    hal_io_write_pwm(HAL_IO_PWM_MAX);
    hal_io_write_pwm(HAL_IO_PWM_MAX);

    TEST_ASSERT_EQUAL_UINT(1, seen.count);
    TEST_ASSERT_EQUAL_INT64(1000, seen.value);
    TEST_ASSERT_EQUAL_UINT64(300, seen.tick);
}

void test_a_restart_switches_outputs_pwm_and_leds_off(void)
{
    hal_io_write_outputs(1);
    hal_io_write_pwm(1);
    hal_io_set_led(7, true);

    host_machine_restart(&machine);

    TEST_ASSERT_EQUAL_HEX8(0, machine.outputs);
    TEST_ASSERT_FALSE(machine.led[7]);
    TEST_ASSERT_EQUAL_UINT32(0, machine.pwm_permille);
    TEST_ASSERT_EQUAL_UINT(6, seen.count);
}

void test_a_trace_event_is_told_in_time_from_the_start(void)
{
    hal_trace(5123, 4, HAL_TRACE_OUT, -7);

    TEST_ASSERT_EQUAL_UINT64(123, seen.tick);
    TEST_ASSERT_EQUAL_UINT(4, seen.what);
    TEST_ASSERT_EQUAL_INT(HAL_TRACE_OUT, seen.event);
    TEST_ASSERT_EQUAL_INT64(-7, seen.value);
}

void test_a_machine_without_listener_keeps_its_pins_all_the_same(void)
{
    machine.listener = (struct host_listener){0};

    hal_io_write_outputs(2);
    hal_io_write_pwm(500);
    hal_io_set_led(1, true);
    hal_trace(5000, 0, HAL_TRACE_END, 0);

    TEST_ASSERT_EQUAL_HEX8(2, machine.outputs);
    TEST_ASSERT_TRUE(machine.led[1]);
    TEST_ASSERT_EQUAL_UINT(0, seen.count);
}

void test_two_machines_do_not_know_of_each_other(void)
{
    static struct host_machine other;
    host_machine_init(&other, 0);
    host_machine_select(&other);

    hal_io_write_outputs(8);

    TEST_ASSERT_EQUAL_HEX8(8, other.outputs);
    TEST_ASSERT_EQUAL_HEX8(0, machine.outputs);
}

static unsigned ticks_called;
static uint64_t called_at;
static uint64_t changed_since;

static void tick_seen(void *context, uint64_t since_tick)
{
    (void)context;
    ticks_called++;
    changed_since = since_tick;
    called_at = machine.now;
}

static void plan_isr(void *context)
{
    (void)context;
}

static unsigned lay_nothing(void *context, unsigned motor, struct hal_step_room *room)
{
    (void)context;
    (void)motor;
    (void)room;
    return 0;
}

/* Two changes within the delay call one interrupt. */
void test_a_tick_interrupt_that_is_late_sees_all_changes_until_then(void)
{
    static const struct host_input script[] = {
        {.tick = 400, .input = 1, .level = true},
        {.tick = 410, .input = 2, .level = true},
    };
    const struct hal_client client = {.lay_isr = lay_nothing, .tick_isr = tick_seen, .plan_isr = plan_isr};
    hal_run_start(&client);
    ticks_called = 0;
    machine.faults.late_tick_ticks = 30;
    host_machine_set_script(&machine, script, 2);

    host_machine_run(&machine, 1000, main_pass, NULL, NULL);

    TEST_ASSERT_EQUAL_UINT(1, ticks_called);
    TEST_ASSERT_EQUAL_UINT64(430, called_at);
    TEST_ASSERT_EQUAL_UINT8(3, hal_io_read_inputs());
    TEST_ASSERT_EQUAL_UINT64(5000 + 400, changed_since);
}
