/* Power-on, errors at run time and faults: what the unit does and what it tells. */
#include "gve_rig.h"

enum {
    POWER_LED = 0x01,
};

void setUp(void)
{
    rig_set_up();
}

void tearDown(void)
{
}

/* Off and on again, with what must be wrong at the start. */
static void start_with(enum hal_board_cause cause, bool no_crystal)
{
    host_machine_restart(&machine);
    rig_pwm = 0;
    rig_outputs = 0;
    machine.faults.start_cause = cause;
    machine.faults.no_crystal = no_crystal;
    rig_begin();
}

static void expect_locked(const char *flags)
{
    rig_expect("0?", "8,IP134/200 v1 22.11.2026");
    rig_expect("0SR6", flags);
    rig_expect("0L100", "F");
    rig_expect("0C100", "F");
    rig_expect("0WX100,100,100,100", "F");
    rig_expect("0G", "E");
    rig_send("!0*S\r!0C100\r");
    rig_expect("0*E1", "F,0");
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_UINT(0, rig_pulses[0]);
}

static void expect_free(void)
{
    rig_expect("0SR6", "0,00");
    rig_expect("0L100", "0");
    rig_run_ms(1000);
    rig_expect("0P", "0,100,0");
}

void test_without_a_crystal_there_is_no_motion_for_good(void)
{
    start_with(HAL_BOARD_CAUSE_POWER, true);
    expect_locked("8,84");
    rig_expect("0D", "8");
    expect_locked("8,84");
    rig_expect("0J", "8");
    expect_locked("8,84");
}

void test_after_each_fault_there_is_no_motion_until_d_or_j(void)
{
    static const enum hal_board_cause causes[] = {HAL_BOARD_CAUSE_WATCHDOG, HAL_BOARD_CAUSE_FAULT};
    for (unsigned i = 0; i < 2; i++) {
        rig_set_up();
        start_with(causes[i], false);
        expect_locked("8,88");
        rig_expect("0D", "0");
        expect_free();
        rig_set_up();
        start_with(causes[i], false);
        expect_locked("8,88");
        rig_expect("0J", "0");
        expect_free();
    }
}

void test_a_fault_without_a_crystal_is_told_until_d(void)
{
    start_with(HAL_BOARD_CAUSE_WATCHDOG, true);
    expect_locked("8,8C");
    rig_expect("0D", "8");
    expect_locked("8,84");
}

void test_after_power_on_and_the_reset_pin_the_unit_is_free(void)
{
    start_with(HAL_BOARD_CAUSE_POWER, false);
    expect_free();
    rig_set_up();
    start_with(HAL_BOARD_CAUSE_RESET, false);
    expect_free();
}

void test_what_moves_nothing_works_while_the_unit_is_locked(void)
{
    start_with(HAL_BOARD_CAUSE_WATCHDOG, false);
    rig_expect("0NX5", "8");
    rig_expect("0P", "8,5,0");
    rig_expect("0EW40,07", "8");
    rig_expect("0ER40", "8,07");
    rig_expect("0O0,FB", "8");
    rig_expect("7V300", "8");
    TEST_ASSERT_EQUAL_HEX8(0x31, rig_outputs);
    TEST_ASSERT_EQUAL_UINT32(300, rig_pwm);
}

void test_damaged_content_of_the_eeprom_reads_as_delivered_and_locks(void)
{
    rig_expect("0EW40,07", "0");
    rig_expect("0EW01,09", "0");
    for (unsigned area = 0; area < HAL_FLASH_AREAS; area++) {
        for (unsigned i = 0; i < 400; i++) {
            machine.flash[area][i] &= 0x5A;
        }
    }
    start_with(HAL_BOARD_CAUSE_POWER, false);
    rig_expect("0ER40", "8,FF");
    rig_expect("0ER01", "8,00");
    rig_expect("0ERFD", "8,0A");
    expect_locked("8,88");
    rig_expect("0D", "0");
    expect_free();
}

void test_a_write_that_fails_is_refused_and_changes_nothing(void)
{
    rig_expect("0EW40,07", "0");
    machine.faults.flash_fail_at = machine.flash_operations + 1U;
    rig_expect("0EW40,08", "7");
    rig_expect("0ER40", "0,07");
    rig_expect("0EW40,09", "0");
    rig_expect("0ER40", "0,09");
}

void test_the_brake_is_released_after_its_time_but_not_while_locked(void)
{
    rig_expect("0EW01,08", "0");
    rig_expect("0EWFD,05", "0");
    start_with(HAL_BOARD_CAUSE_POWER, false);
    rig_run_ms(495);
    TEST_ASSERT_EQUAL_HEX8(0x00, rig_outputs);
    rig_run_ms(10);
    TEST_ASSERT_EQUAL_HEX8(0x01, rig_outputs);

    start_with(HAL_BOARD_CAUSE_WATCHDOG, false);
    rig_run_ms(2000);
    TEST_ASSERT_EQUAL_HEX8(0x00, rig_outputs);
    rig_expect("0D", "0");
    rig_run_ms(490);
    TEST_ASSERT_EQUAL_HEX8(0x00, rig_outputs);
    rig_run_ms(15);
    TEST_ASSERT_EQUAL_HEX8(0x01, rig_outputs);
    rig_expect("0D", "0");
    rig_run_ms(10);
    TEST_ASSERT_EQUAL_HEX8(0x01, rig_outputs);

    start_with(HAL_BOARD_CAUSE_POWER, true);
    rig_run_ms(2000);
    rig_expect("0D", "8");
    rig_run_ms(2000);
    TEST_ASSERT_EQUAL_HEX8(0x00, rig_outputs);
}

void test_the_brake_is_not_released_by_d_where_the_crystal_does_not_run(void)
{
    rig_expect("0EW01,08", "0");
    start_with(HAL_BOARD_CAUSE_WATCHDOG, true);
    rig_expect("0D", "8");
    rig_run_ms(6000);
    TEST_ASSERT_EQUAL_HEX8(0x00, rig_outputs);
}

void test_after_j_the_brake_has_its_time_again(void)
{
    rig_expect("0EW01,08", "0");
    rig_expect("0EWFD,05", "0");
    start_with(HAL_BOARD_CAUSE_POWER, false);
    rig_run_ms(600);
    TEST_ASSERT_EQUAL_HEX8(0x01, rig_outputs);
    rig_expect("0J", "0");
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_HEX8(0x00, rig_outputs);
    rig_run_ms(490);
    TEST_ASSERT_EQUAL_HEX8(0x00, rig_outputs);
    rig_run_ms(15);
    TEST_ASSERT_EQUAL_HEX8(0x01, rig_outputs);
}

void test_power_blinks_while_the_unit_is_locked(void)
{
    start_with(HAL_BOARD_CAUSE_WATCHDOG, false);
    unsigned changes = 0;
    uint8_t before = rig_leds;
    for (unsigned i = 0; i < 400; i++) {
        rig_run_ms(10);
        changes += (rig_leds ^ before) & POWER_LED;
        before = rig_leds;
    }
    TEST_ASSERT_UINT_WITHIN(1, 8, changes);
    rig_expect("0D", "0");
    rig_run_ms(30);
    TEST_ASSERT_EQUAL_HEX8(POWER_LED, rig_leds);
}

void test_late_pulses_are_counted_up_to_ff_and_the_path_is_kept(void)
{
    rig_expect("0V100000", "0");
    rig_expect("0A8000", "0");
    machine.faults.late_step_ticks = 200 * TICKS_PER_US;
    machine.ahead_ticks = 0;
    rig_expect("0L10", "0");
    rig_run_ms(100);
    TEST_ASSERT_GREATER_THAN_UINT64(0, machine.late_steps);
    TEST_ASSERT_LESS_THAN_UINT64(10, machine.late_steps);
    char answer[20];
    (void)snprintf(answer, sizeof answer, "0,%02X", (unsigned)machine.late_steps);
    rig_expect("0SR7", answer);
    rig_expect("0L1000,500", "0");
    rig_run_ms(1000);
    TEST_ASSERT_GREATER_THAN_UINT64(255, machine.late_steps);
    rig_expect("0SR7", "0,FF");
    rig_expect("0P", "0,1010,500");
    TEST_ASSERT_EQUAL_INT64(1010, rig_position[0]);
    TEST_ASSERT_EQUAL_INT64(500, rig_position[1]);
    rig_expect("0J", "0");
    rig_expect("0SR7", "0,00");
}

void test_outputs_stay_through_halts_and_interrupts(void)
{
    rig_expect("0O0,FB", "0");
    rig_expect("7V400", "0");
    rig_expect("0SW0,01", "0");
    rig_expect("0L10000", "0");
    rig_run_ms(200);
    rig_expect("0H", "8");
    rig_expect("0G", "0");
    rig_input(1, false);
    rig_run_ms(2000);
    TEST_ASSERT_EQUAL_HEX8(0x31, rig_outputs);
    TEST_ASSERT_EQUAL_UINT32(400, rig_pwm);
}

void test_a_line_that_falls_silent_stops_nothing(void)
{
    rig_expect("0L3000", "0");
    rig_send("!0V5");
    rig_run_ms(5000);
    TEST_ASSERT_EQUAL_INT64(3000, rig_position[0]);
}
