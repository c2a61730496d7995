/* Limits, capture, backlash and the watchdog of the bus. */
#include "pos_rig.h"

#include "hal_time.h"

#define FEED(mm_per_min) ((uint32_t)(mm_per_min) << 16U)

enum {
    ACCEL = 500,
    LIMIT_MINUS = 146,
    LIMIT_PLUS = 147,
    CAPTURE = 149,
    BACKLASH = 141,
    ERROR_ACCEL = 140,
    SOFT_MIN = 142,
    SOFT_MAX = 144,
    WATCHDOG = 30,
};

static void set(uint32_t number, int64_t value, bool wide)
{
    const uint16_t words[] = {(uint16_t)((uint64_t)value >> 16U & 0xFFFFU), (uint16_t)((uint64_t)value & 0xFFFFU)};
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE,
                          positioning_write(&unit, number, wide ? 2 : 1, wide ? words : &words[1]));
}

void setUp(void)
{
    rig_set_up();
    rig_run_ms(10);
}

void tearDown(void)
{
}

static void mode(int32_t len_um)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, len_um, ACCEL, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, FEED(1000), 1, 1));
}

static void take(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
}

static void move(int32_t len_um)
{
    mode(len_um);
    rig_run_ms(2);
    rig_run_until_rest(1, 100000);
}

/* From 1666.7 steps/s with 50 000 steps/s^2: 27.8 steps. */
void test_a_limit_input_stops_the_motion_in_its_direction(void)
{
    set(LIMIT_PLUS, 1, false);
    set(LIMIT_MINUS, -2, false);
    take();
    mode(10000);
    rig_run_ms(200);
    host_machine_set_input(&machine, 1, true);
    int64_t before = rig_position[0];
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_HEX(0x0105, rig_status(1));
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_HEX(0x0005, rig_status(1));
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_LIMIT, rig_values(1).error);
    TEST_ASSERT_INT64_WITHIN(2, before + 28, rig_position[0]);
    TEST_ASSERT_EQUAL_INT(POS_ERROR_FAULT, pos_mode(&unit, NULL, -10, ACCEL, 1));
}

void test_no_pulse_comes_towards_a_limit_that_is_active(void)
{
    set(LIMIT_PLUS, 1, false);
    host_machine_set_input(&machine, 1, true);
    rig_run_ms(2);
    take();
    mode(10000);
    rig_run_ms(20);
    TEST_ASSERT_EQUAL_UINT(0, rig_pulses[0]);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_LIMIT, rig_values(1).error);
    take();
    move(-1000);
    TEST_ASSERT_EQUAL_INT64(-100, rig_position[0]);
}

void test_a_limit_does_not_wait_for_main(void)
{
    set(LIMIT_PLUS, 1, false);
    take();
    mode(10000);
    rig_run_ms(200);
    host_machine_set_input(&machine, 1, true);
    int64_t before = rig_position[0];
    rig_run_without_main(10 * TICKS_PER_MS);
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_LIMIT, rig_values(1).error);
    TEST_ASSERT_INT64_WITHIN(2, before + 28, rig_position[0]);
}

void test_a_limit_of_the_last_axis_does_not_wait_for_main_either(void)
{
    set(LIMIT_PLUS + 300, 1, false);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 4, 0));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 10000, ACCEL, 4));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, FEED(1000), 1, 4));
    rig_run_ms(200);
    host_machine_set_input(&machine, 1, true);
    int64_t before = rig_position[3];
    rig_run_without_main(10 * TICKS_PER_MS);
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_LIMIT, rig_values(4).error);
    TEST_ASSERT_INT64_WITHIN(2, before + 28, rig_position[3]);
}

void test_a_fault_brakes_with_its_own_acceleration(void)
{
    set(LIMIT_PLUS, 1, false);
    set(ERROR_ACCEL, 5000, false);
    take();
    mode(10000);
    rig_run_ms(200);
    host_machine_set_input(&machine, 1, true);
    int64_t before = rig_position[0];
    rig_run_ms(100);
    TEST_ASSERT_INT64_WITHIN(2, before + 3, rig_position[0]);
}

void test_an_axis_that_is_given_back_brakes_with_the_acceleration_of_its_measure(void)
{
    set(ERROR_ACCEL, 5000, false);
    take();
    mode(10000);
    rig_run_ms(200);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    int64_t before = rig_position[0];
    rig_run_ms(100);
    TEST_ASSERT_INT64_WITHIN(2, before + 28, rig_position[0]);
}

void test_a_limit_counts_also_while_the_axis_is_being_held(void)
{
    set(LIMIT_PLUS, 1, false);
    set(ERROR_ACCEL, 50000, false);
    take();
    mode(10000);
    rig_run_ms(200);
    (void)pos_control(&unit, NULL, FEED(1000), 0, 1);
    rig_run_ms(3);
    host_machine_set_input(&machine, 1, true);
    int64_t before = rig_position[0];
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_LIMIT, rig_values(1).error);
    TEST_ASSERT_INT64_WITHIN(2, before + 1, rig_position[0]);
}

/* POS_RESET alone takes 0.33 s and 278 steps; the limit 0.03 s. Of an axis that is free nothing is told. */
void test_a_limit_brakes_an_axis_that_has_been_given_back(void)
{
    set(LIMIT_PLUS, 1, false);
    set(ERROR_ACCEL, ACCEL, false);
    take();
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 20000, ACCEL / 10, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, FEED(1000), 1, 1));
    rig_run_ms(500);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    rig_run_ms(2);
    int64_t before = rig_position[0];
    host_machine_set_input(&machine, 1, true);
    rig_run_ms(50);
    TEST_ASSERT_EQUAL_HEX(0, rig_status(1));
    TEST_ASSERT_EQUAL_UINT16(POS_OK, rig_values(1).error);
    TEST_ASSERT_INT64_WITHIN(3, before + 28, rig_position[0]);
}

void test_a_measure_is_cut_at_a_software_limit(void)
{
    set(SOFT_MIN, -500, true);
    set(SOFT_MAX, 1234, true);
    take();
    move(2000);
    TEST_ASSERT_EQUAL_HEX(0x0803, rig_status(1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 37, 0, 0, 1));
    rig_run_ms(2);
    move(2000);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_SOFT, rig_values(1).error);
    TEST_ASSERT_EQUAL_INT32(1230, rig_values(1).position_um);
    take();
    mode(10);
    rig_run_ms(3);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_SOFT, rig_values(1).error);
    TEST_ASSERT_EQUAL_INT32(1230, rig_values(1).position_um);
    take();
    move(-5000);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_SOFT, rig_values(1).error);
    TEST_ASSERT_EQUAL_INT32(-500, rig_values(1).position_um);
}

void test_a_capture_keeps_the_position_at_the_edge(void)
{
    TEST_ASSERT_EQUAL_INT(POS_ERROR_NO_INPUT, pos_capture(&unit, 1));
    take();
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    rig_run_ms(2);
    set(CAPTURE, 5, false);
    take();
    mode(10000);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_capture(&unit, 1));
    TEST_ASSERT_EQUAL_HEX(POS_FLAG_ARMED, rig_values(1).flags);
    rig_run_ms(300);
    host_machine_set_input(&machine, 5, true);
    int64_t at = rig_position[0];
    rig_run_ms(50);
    host_machine_set_input(&machine, 5, false);
    rig_run_ms(5);
    host_machine_set_input(&machine, 5, true);
    rig_run_ms(1000);
    struct pos_values values = rig_values(1);
    TEST_ASSERT_EQUAL_HEX(POS_FLAG_CAPTURE, values.flags);
    TEST_ASSERT_EQUAL_UINT16(1, values.captures);
    TEST_ASSERT_EQUAL_INT32((int32_t)at, values.captured_steps);
    TEST_ASSERT_EQUAL_INT32(10 * (int32_t)at, values.captured_um);
}

void test_backlash_is_taken_up_where_the_direction_changes(void)
{
    set(BACKLASH, 50, false);
    take();
    move(1000);
    TEST_ASSERT_EQUAL_INT64(100, rig_position[0]);
    move(-1000);
    TEST_ASSERT_EQUAL_INT64(-5, rig_position[0]);
    TEST_ASSERT_EQUAL_INT32(0, rig_values(1).position_steps);
    move(10);
    TEST_ASSERT_EQUAL_INT64(1, rig_position[0]);
    TEST_ASSERT_EQUAL_INT32(1, rig_values(1).position_steps);
    move(0);
    TEST_ASSERT_EQUAL_INT64(1, rig_position[0]);
    TEST_ASSERT_EQUAL_HEX(0x0803, rig_status(1));
}

void test_a_silent_bus_is_a_fault_of_every_axis_that_is_taken(void)
{
    set(WATCHDOG, 200, false);
    rig_expect("01 06 00 64 01 01 08 45", "01 06 00 64 01 01 08 45");
    rig_expect("01 10 00 64 00 08 10 02 02 00 00 00 00 27 10 01 F4 00 01 03 E8 00 00 D6 42", "01 10 00 64 00 08 80 10");
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_HEX(0x0103, rig_status(1));
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_HEX(0x0105, rig_status(1));
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_SILENT, rig_values(1).error);
    rig_run_ms(200);
    TEST_ASSERT_EQUAL_HEX(0x0005, rig_status(1));
    TEST_ASSERT_EQUAL_HEX(0, rig_status(2));
    TEST_ASSERT_EQUAL_UINT32(1, unit.silences);
}

void test_a_silent_bus_is_seen_by_each_axis_alone(void)
{
    set(WATCHDOG, 200, false);
    for (unsigned axis = 2; axis <= POS_AXES; axis++) {
        TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 03 00 00 00 01"));
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, axis, 0));
        rig_run_ms(300);
        for (unsigned other = 1; other <= POS_AXES; other++) {
            bool acts = other <= axis && other != 1U;
            TEST_ASSERT_EQUAL_HEX(acts ? 0x0005 : 0x0000, rig_status(other));
        }
        TEST_ASSERT_EQUAL_UINT32(axis - 1U, unit.silences);
    }
}

void test_a_silent_bus_is_one_of_the_very_time(void)
{
    unit.registers.unit[POS_UNIT_WATCHDOG] = 200;
    take();
    unit.server.heard_tick = hal_time_now() + 1U - 200 * TICKS_PER_MS;
    (void)positioning_poll(&unit);
    TEST_ASSERT_EQUAL_HEX(0x0001, rig_status(1));
    unit.server.heard_tick--;
    (void)positioning_poll(&unit);
    TEST_ASSERT_EQUAL_HEX(0x0005, rig_status(1));
}

void test_an_input_that_is_active_at_the_start_is_no_edge(void)
{
    static const uint16_t one = 1;
    set(CAPTURE, 5, false);
    set(CAPTURE + 300, 5, false);
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, positioning_write(&unit, 40, 1, &one));
    host_machine_set_input(&machine, 5, true);
    host_machine_restart(&machine);
    rig_begin();
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_capture(&unit, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_capture(&unit, 4));
    host_machine_set_input(&machine, 6, true);
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_UINT16(0, rig_values(1).captures);
    TEST_ASSERT_EQUAL_UINT16(0, rig_values(4).captures);
}

void test_an_input_that_is_active_when_it_is_set_is_no_edge(void)
{
    host_machine_set_input(&machine, 5, true);
    rig_run_ms(2);
    set(CAPTURE, 5, false);
    take();
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_capture(&unit, 1));
    host_machine_set_input(&machine, 6, true);
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_UINT16(0, rig_values(1).captures);
    host_machine_set_input(&machine, 5, false);
    rig_run_ms(2);
    host_machine_set_input(&machine, 5, true);
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_UINT16(1, rig_values(1).captures);
}

/* Until the LEDs change; they are looked at each millisecond. */
static uint64_t led_ms(void)
{
    uint8_t before = rig_leds;
    uint64_t ms = 0;
    while (rig_leds == before && ms < 10000U) {
        rig_run_ms(1);
        ms++;
    }
    return ms;
}

void test_leds_show_pulses_and_errors(void)
{
    for (unsigned axis = 1; axis <= (unsigned)POS_AXES; axis++) {
        rig_set_up();
        rig_run_ms(10);
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, axis, 0));
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 10000, ACCEL, axis));
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, FEED(1000), 1, axis));
        rig_run_ms(50);
        TEST_ASSERT_EQUAL_HEX(1U << (axis - 1U), rig_leds);
        rig_run_ms(1000);
        TEST_ASSERT_EQUAL_HEX(0, rig_leds);
        TEST_ASSERT_EQUAL_INT(POS_ERROR_ACCEL, pos_mode(&unit, NULL, 1, 0, axis));
        (void)led_ms();
        (void)led_ms();
        for (unsigned i = 0; i < 3; i++) {
            TEST_ASSERT_UINT64_WITHIN(3, 500, led_ms());
            TEST_ASSERT_BITS_LOW(~(1U << (axis - 1U)), rig_leds);
        }
    }
}

void test_only_the_first_edge_of_its_own_input_is_captured(void)
{
    set(CAPTURE, 5, false);
    host_machine_set_input(&machine, 5, true);
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_capture(&unit, 1));
    host_machine_set_input(&machine, 6, true);
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_UINT16(0, rig_values(1).captures);
    host_machine_set_input(&machine, 5, false);
    rig_run_ms(2);
    host_machine_set_input(&machine, 6, false);
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_UINT16(0, rig_values(1).captures);
    host_machine_set_input(&machine, 5, true);
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_UINT16(1, rig_values(1).captures);
    TEST_ASSERT_EQUAL_HEX(POS_FLAG_CAPTURE, rig_values(1).flags);
}

void test_an_edge_elsewhere_while_a_limit_stops_the_axis_changes_nothing(void)
{
    set(LIMIT_PLUS, 1, false);
    take();
    mode(10000);
    rig_run_ms(200);
    host_machine_set_input(&machine, 1, true);
    int64_t before = rig_position[0];
    rig_run_ms(5);
    host_machine_set_input(&machine, 6, true);
    rig_run_ms(100);
    host_machine_set_input(&machine, 6, false);
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_LIMIT, rig_values(1).error);
    TEST_ASSERT_INT64_WITHIN(2, before + 28, rig_position[0]);
    TEST_ASSERT_EQUAL_HEX(0x0005, rig_status(1));
}

/* Both edges come before main has looked. */
void test_a_second_edge_before_main_has_looked_is_no_capture(void)
{
    set(CAPTURE, 5, false);
    take();
    mode(10000);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_capture(&unit, 1));
    rig_run_ms(200);
    int64_t at = rig_position[0];
    for (unsigned i = 0; i < 4; i++) {
        host_machine_set_input(&machine, 5, i % 2U == 0);
        rig_run_without_main(TICKS_PER_MS / 2U);
    }
    TEST_ASSERT_TRUE(rig_position[0] > at + 1);
    rig_run_ms(5);
    struct pos_values values = rig_values(1);
    TEST_ASSERT_EQUAL_UINT16(1, values.captures);
    TEST_ASSERT_EQUAL_INT32((int32_t)at, values.captured_steps);
    TEST_ASSERT_EQUAL_INT32(10 * (int32_t)at, values.captured_um);
    TEST_ASSERT_EQUAL_HEX(0, values.flags);
}

void test_a_limit_that_is_active_at_0_acts_when_its_input_goes_to_0(void)
{
    set(LIMIT_MINUS, -2, false);
    host_machine_set_input(&machine, 2, true);
    rig_run_ms(2);
    take();
    mode(-10000);
    rig_run_ms(200);
    TEST_ASSERT_EQUAL_HEX(0x0303, rig_status(1));
    TEST_ASSERT_EQUAL_HEX(0, rig_values(1).flags);
    host_machine_set_input(&machine, 2, false);
    int64_t before = rig_position[0];
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_LIMIT, rig_values(1).error);
    TEST_ASSERT_EQUAL_HEX(POS_FLAG_LIMIT_MINUS, rig_values(1).flags);
    TEST_ASSERT_INT64_WITHIN(2, before - 28, rig_position[0]);
}
