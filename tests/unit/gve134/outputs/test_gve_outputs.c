#include "gve_outputs.h"
#include "unity.h"

#include <stddef.h>
#include <string.h>

#include "base_tick.h"
#include "host_machine.h"

/* Outputs of the board. */
enum {
    RELAY = 0x01,
    OUT_0 = 0x10,
    OUT_1 = 0x20,
    OUT_2 = 0x40,
    OUT_3 = 0x80,
};

enum {
    LED_POWER = 0x01,
    LED_RUN = 0x02,
    LED_DATA = 0x04,
    LED_RELAY = 0x08,
    NO_RELAY = 0x07, /* a function that is not used */
    BRAKE_OF_Z = 0x08,
    INTERRUPT = 0x09,
    BLINK_MS = 500,
};

#define COUNT_OF(array) (sizeof(array) / sizeof(array)[0])

static struct host_machine machine;
static struct io io;
static struct gve_memory memory;
static struct gve_outputs outputs;
static struct gve_doing doing;
static uint64_t now;
static uint64_t wake;
static unsigned writes; /* changes of a pin or an LED */
static uint8_t leds;

static void led_seen(void *context, uint64_t tick, unsigned led, bool on)
{
    (void)context;
    (void)tick;
    leds = (uint8_t)(on ? leds | 1U << led : leds & ~(1U << led));
    writes++;
}

static void trace_seen(void *context, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    (void)context;
    (void)value;
    TEST_ASSERT_EQUAL_UINT(0, motor); /* of the unit */
    TEST_ASSERT_EQUAL_UINT64(now, tick);
    TEST_ASSERT_EQUAL(HAL_TRACE_OUT, event);
    writes++;
}

static void begin(bool locked)
{
    doing = (struct gve_doing){.locked = locked};
    gve_outputs_init(&outputs, &io, locked, now);
}

void setUp(void)
{
    host_machine_init(&machine, 0);
    machine.listener = (struct host_listener){.led = led_seen, .trace = trace_seen};
    host_machine_select(&machine);
    leds = 0;
    now = (uint64_t)10 * BLINK_MS * TICKS_PER_MS;
    io_init(&io);
    memset(&memory, 0xFF, sizeof memory);
    memory.bytes[GVE_MEMORY_RELAY] = NO_RELAY;
    memory.bytes[GVE_MEMORY_BRAKE] = 0;
    begin(false);
}

void tearDown(void)
{
}

static void poll(void)
{
    wake = gve_outputs_poll(&outputs, &memory, &doing, now);
}

static void pass_ms(uint64_t ms)
{
    now += ms * TICKS_PER_MS;
    poll();
}

static void assert_relay(bool on)
{
    poll();
    TEST_ASSERT_EQUAL(on, (machine.outputs & RELAY) != 0);
    TEST_ASSERT_EQUAL(on, (leds & LED_RELAY) != 0);
}

void test_after_a_reset_all_is_off(void)
{
    gve_outputs_write(&outputs, 0x00);
    gve_outputs_spindle(&outputs, 500);
    gve_outputs_note_data(&outputs, now);
    doing = (struct gve_doing){.moves = true, .inputs = 0x0F};
    poll();
    begin(false);
    TEST_ASSERT_EQUAL_HEX8(0, leds);
    TEST_ASSERT_EQUAL_UINT32(0, machine.pwm_permille);
    poll();
    TEST_ASSERT_EQUAL_HEX8(0, machine.outputs);
    TEST_ASSERT_EQUAL_HEX8(LED_POWER, leds);
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, wake);
}

void test_each_bit_of_the_port_switches_one_output_and_is_active_at_0(void)
{
    static const uint8_t expected[8] = {OUT_0, OUT_3, OUT_1, OUT_2, 0, 0, 0, 0};
    for (unsigned bit = 0; bit < 8; bit++) {
        gve_outputs_write(&outputs, (uint8_t)~(1U << bit));
        poll();
        TEST_ASSERT_EQUAL_HEX8(expected[bit], machine.outputs);
        gve_outputs_write(&outputs, (uint8_t)(1U << bit));
        poll();
        TEST_ASSERT_EQUAL_HEX8((OUT_0 | OUT_1 | OUT_2 | OUT_3) & ~expected[bit], machine.outputs);
    }
}

void test_each_function_of_the_relay_follows_its_bit_of_the_port(void)
{
    static const unsigned bits[] = {0, 0, 2, 3, 4, 5, 6}; /* of the functions 00 to 06 */
    for (unsigned function = 0; function < COUNT_OF(bits); function++) {
        memory.bytes[GVE_MEMORY_RELAY] = (uint8_t)function;
        for (unsigned bit = 0; bit < 8; bit++) {
            gve_outputs_write(&outputs, (uint8_t)~(1U << bit));
            assert_relay(bit == bits[function]);
        }
        gve_outputs_write(&outputs, 0xFF);
        assert_relay(false);
    }
}

void test_the_relay_of_interrupts_is_on_with_inta(void)
{
    memory.bytes[GVE_MEMORY_RELAY] = INTERRUPT;
    gve_outputs_write(&outputs, 0x00);
    assert_relay(false);
    doing.inta = true;
    gve_outputs_write(&outputs, 0xFF);
    assert_relay(true);
}

void test_other_functions_never_switch_the_relay_on(void)
{
    gve_outputs_write(&outputs, 0x00);
    doing.inta = true;
    now += (uint64_t)10 * TICK_HZ;
    for (unsigned function = 0; function < 256; function++) {
        if (function == 0x07 || function > INTERRUPT) {
            memory.bytes[GVE_MEMORY_RELAY] = (uint8_t)function;
            assert_relay(false);
        }
    }
}

void test_the_brake_is_released_after_its_time(void)
{
    static const struct {
        uint8_t byte;
        unsigned ms;
    } times[] = {{0x00, 0}, {0x01, 100}, {0x0A, 1000}, {0x31, 4900}, {0x32, 5000}, {0x33, 5000}, {0xFF, 5000}};
    memory.bytes[GVE_MEMORY_RELAY] = BRAKE_OF_Z;
    for (size_t i = 0; i < COUNT_OF(times); i++) {
        memory.bytes[GVE_MEMORY_BRAKE] = times[i].byte;
        begin(false);
        if (times[i].ms != 0) {
            uint64_t release = now + times[i].ms * (uint64_t)TICKS_PER_MS;
            assert_relay(false);
            TEST_ASSERT_EQUAL_UINT64(release, wake);
            now = release - 1U;
            assert_relay(false);
            now = release;
        }
        assert_relay(true);
        TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, wake);
    }
}

void test_the_brake_is_not_released_while_the_unit_is_locked(void)
{
    memory.bytes[GVE_MEMORY_RELAY] = BRAKE_OF_Z;
    memory.bytes[GVE_MEMORY_BRAKE] = 1;
    begin(true);
    pass_ms(60000);
    assert_relay(false);
    gve_outputs_unlock(&outputs, now);
    doing.locked = false;
    assert_relay(false);
    pass_ms(99);
    assert_relay(false);
    pass_ms(1);
    assert_relay(true);
    doing.locked = true;
    assert_relay(false);
}

void test_the_spindle_has_its_pwm_and_switches_its_output(void)
{
    gve_outputs_spindle(&outputs, 1);
    poll();
    TEST_ASSERT_EQUAL_UINT32(1, machine.pwm_permille);
    TEST_ASSERT_EQUAL_HEX8(OUT_0, machine.outputs);
    gve_outputs_spindle(&outputs, GVE_SPINDLE_MAX);
    TEST_ASSERT_EQUAL_UINT32(1000, machine.pwm_permille);
    gve_outputs_spindle(&outputs, 0);
    poll();
    TEST_ASSERT_EQUAL_UINT32(0, machine.pwm_permille);
    TEST_ASSERT_EQUAL_HEX8(0, machine.outputs);
}

void test_the_spindle_leaves_the_other_bits(void)
{
    gve_outputs_write(&outputs, 0xF0);
    gve_outputs_spindle(&outputs, 0);
    poll();
    TEST_ASSERT_EQUAL_HEX8(OUT_1 | OUT_2 | OUT_3, machine.outputs);
    gve_outputs_spindle(&outputs, 9);
    poll();
    TEST_ASSERT_EQUAL_HEX8(OUT_0 | OUT_1 | OUT_2 | OUT_3, machine.outputs);
    gve_outputs_write(&outputs, 0xFF);
    gve_outputs_spindle(&outputs, 9);
    poll();
    TEST_ASSERT_EQUAL_HEX8(OUT_0, machine.outputs);
}

void test_of_port_and_spindle_the_last_one_wins_and_the_pwm_stays(void)
{
    gve_outputs_spindle(&outputs, 300);
    gve_outputs_write(&outputs, 0xFF);
    poll();
    TEST_ASSERT_EQUAL_HEX8(0, machine.outputs);
    TEST_ASSERT_EQUAL_UINT32(300, machine.pwm_permille);
    gve_outputs_write(&outputs, 0xFE);
    poll();
    TEST_ASSERT_EQUAL_HEX8(OUT_0, machine.outputs);
    TEST_ASSERT_EQUAL_UINT32(300, machine.pwm_permille);
}

void test_run_is_lit_while_axes_move(void)
{
    doing.moves = true;
    poll();
    TEST_ASSERT_EQUAL_HEX8(LED_POWER | LED_RUN, leds);
    doing.moves = false;
    poll();
    TEST_ASSERT_EQUAL_HEX8(LED_POWER, leds);
}

void test_data_is_lit_for_20_ms_after_a_byte(void)
{
    gve_outputs_note_data(&outputs, now);
    pass_ms(10);
    TEST_ASSERT_EQUAL_HEX8(LED_POWER | LED_DATA, leds);
    gve_outputs_note_data(&outputs, now);
    uint64_t end = now + (uint64_t)20 * TICKS_PER_MS;
    poll();
    TEST_ASSERT_EQUAL_UINT64(end, wake);
    now = end - 1U;
    poll();
    TEST_ASSERT_EQUAL_HEX8(LED_POWER | LED_DATA, leds);
    now = end;
    poll();
    TEST_ASSERT_EQUAL_HEX8(LED_POWER, leds);
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, wake);
}

void test_each_reference_switch_has_an_led_that_is_lit_while_it_is_closed(void)
{
    for (unsigned input = 0; input < 8; input++) {
        doing.inputs = (uint8_t)(1U << input);
        poll();
        TEST_ASSERT_EQUAL_HEX8(LED_POWER | (input < 4 ? 0x10U << input : 0U), leds);
    }
}

void test_power_blinks_each_half_second_while_the_unit_is_locked(void)
{
    begin(true);
    for (unsigned i = 0; i < 4; i++) {
        poll();
        TEST_ASSERT_EQUAL_HEX8(i % 2U == 0 ? LED_POWER : 0, leds);
        uint64_t next = now + (uint64_t)BLINK_MS * TICKS_PER_MS;
        TEST_ASSERT_EQUAL_UINT64(next, wake);
        now = next - 1U;
        poll();
        TEST_ASSERT_EQUAL_HEX8(i % 2U == 0 ? LED_POWER : 0, leds);
        TEST_ASSERT_EQUAL_UINT64(next, wake);
        now = next;
    }
}

void test_of_several_times_the_next_is_that_of_the_call(void)
{
    memory.bytes[GVE_MEMORY_BRAKE] = 1;
    begin(false);
    poll();
    TEST_ASSERT_EQUAL_UINT64(now + (uint64_t)100 * TICKS_PER_MS, wake);
    gve_outputs_note_data(&outputs, now);
    poll();
    TEST_ASSERT_EQUAL_UINT64(now + (uint64_t)20 * TICKS_PER_MS, wake);
    begin(true);
    gve_outputs_note_data(&outputs, now);
    poll();
    TEST_ASSERT_EQUAL_UINT64(now + (uint64_t)20 * TICKS_PER_MS, wake);
}

void test_pins_and_leds_are_written_when_they_change_only(void)
{
    memory.bytes[GVE_MEMORY_RELAY] = 0;
    gve_outputs_write(&outputs, 0x00);
    poll();
    writes = 0;
    poll();
    TEST_ASSERT_EQUAL_UINT(0, writes);
}
