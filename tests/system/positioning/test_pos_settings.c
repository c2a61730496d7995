/* Settings: taken, kept, lost; which requests may change them. */
#include "pos_rig.h"

enum {
    STORE = 40,
    RATE = 31,
    FORMAT = 32,
    WATCHDOG = 30,
    ACCEL_1 = 135,
    AXIS_1_SETTINGS = 130,
    SETTINGS = 26, /* registers with settings of an axis */
};

void setUp(void)
{
    rig_set_up();
    rig_run_ms(10);
}

void tearDown(void)
{
}

static enum modbus_exception set(uint32_t number, uint16_t value)
{
    return positioning_write(&unit, number, 1, &value);
}

static void restart(void)
{
    host_machine_restart(&machine);
    rig_begin();
    rig_run_ms(10);
}

void test_settings_that_are_stored_are_there_after_a_start(void)
{
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(ACCEL_1, 1234));
    TEST_ASSERT_TRUE(unit.settings.other);
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(STORE, 1));
    TEST_ASSERT_FALSE(unit.settings.other);
    restart();
    TEST_ASSERT_EQUAL_UINT32(1234, unit.registers.axes[0][POS_AXIS_HIGHEST_ACCEL]);
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(STORE, 2));
    TEST_ASSERT_EQUAL_UINT32(65535, unit.registers.axes[0][POS_AXIS_HIGHEST_ACCEL]);
    TEST_ASSERT_TRUE(unit.settings.other);
    restart();
    TEST_ASSERT_EQUAL_UINT32(1234, unit.registers.axes[0][POS_AXIS_HIGHEST_ACCEL]);
}

/* Registers 30 to 55 of an axis, in which no value is that of another axis or as delivered. */
static void put_settings(uint16_t n, uint16_t values[SETTINGS])
{
    const uint16_t all[SETTINGS] = {
        0,  100 + n, 0,       200 + n, n % 2, 300 + n, n, 400 + n, n, 500 + n, 600 + n, 700 + n, (uint16_t)-n,
        60, n,       800 + n, n,       -n,    n + 1,   8, n,       0, n,       1,       n,       2,
    };
    memcpy(values, all, sizeof all);
}

void test_all_settings_of_all_axes_are_there_after_a_start(void)
{
    uint16_t values[SETTINGS];
    uint16_t read[SETTINGS];
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(WATCHDOG, 12345));
    for (unsigned axis = 1; axis <= POS_AXES; axis++) {
        put_settings((uint16_t)axis, values);
        TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE,
                              positioning_write(&unit, AXIS_1_SETTINGS + 100U * (axis - 1U), SETTINGS, values));
    }
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(STORE, 1));
    restart();
    TEST_ASSERT_FALSE(unit.settings.damaged);
    TEST_ASSERT_FALSE(unit.settings.other);
    TEST_ASSERT_EQUAL_UINT32(12345, unit.registers.unit[POS_UNIT_WATCHDOG]);
    for (unsigned axis = 1; axis <= POS_AXES; axis++) {
        put_settings((uint16_t)axis, values);
        pos_registers_read(&unit.registers, AXIS_1_SETTINGS + 100U * (axis - 1U), SETTINGS, read);
        TEST_ASSERT_EQUAL_HEX16_ARRAY(values, read, SETTINGS);
    }
}

/* The settings by themselves. */
void test_without_stored_settings_the_delivered_ones_are_taken_and_what_is_stored_is_in_force(void)
{
    struct pos_settings settings;
    struct pos_registers registers;
    pos_registers_init(&registers);
    registers.unit[POS_UNIT_RATE] = 96;
    pos_settings_init(&settings, &registers);
    TEST_ASSERT_EQUAL_UINT32(192, registers.unit[POS_UNIT_RATE]);
    TEST_ASSERT_FALSE(settings.other);
    registers.axes[3][POS_AXIS_HOME_WAY] = 5;
    pos_settings_compare(&settings, &registers);
    TEST_ASSERT_TRUE(settings.other);
    TEST_ASSERT_TRUE(pos_settings_store(&settings, &registers));
    TEST_ASSERT_FALSE(settings.other);
    pos_settings_compare(&settings, &registers);
    TEST_ASSERT_FALSE(settings.other);
}

void test_settings_that_are_not_stored_are_gone_after_a_start(void)
{
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(ACCEL_1, 1234));
    restart();
    TEST_ASSERT_EQUAL_UINT32(65535, unit.registers.axes[0][POS_AXIS_HIGHEST_ACCEL]);
    TEST_ASSERT_FALSE(unit.settings.other);
}

void test_the_line_has_the_stored_rate_and_format_from_the_next_start_on(void)
{
    TEST_ASSERT_EQUAL_UINT32(19200, machine.line.rate_bd);
    TEST_ASSERT_EQUAL_INT(HAL_LINE_8E1, machine.line.format);
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(RATE, 1152));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(FORMAT, 2));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(STORE, 1));
    TEST_ASSERT_EQUAL_UINT32(19200, machine.line.rate_bd);
    restart();
    TEST_ASSERT_EQUAL_UINT32(115200, machine.line.rate_bd);
    TEST_ASSERT_EQUAL_INT(HAL_LINE_8N1, machine.line.format);
    TEST_ASSERT_EQUAL_UINT32(TICK_HZ / 11520U, unit.server.receiver.character_ticks);
    rig_expect("01 06 00 64 01 01 08 45", "01 06 00 64 01 01 08 45");
}

void test_settings_of_an_axis_that_is_taken_or_brakes_are_refused(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_BUSY, set(ACCEL_1, 1234));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_BUSY, set(STORE, 1));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_BUSY, set(RATE, 96));
    TEST_ASSERT_EQUAL_UINT32(65535, unit.registers.axes[0][POS_AXIS_HIGHEST_ACCEL]);
    TEST_ASSERT_EQUAL_UINT32(192, unit.registers.unit[POS_UNIT_RATE]);
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(ACCEL_1 + 100, 1234));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 100000, 500, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, UINT32_C(1000) << 16U, 1, 1));
    rig_run_ms(200);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_BUSY, set(ACCEL_1, 1234));
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(ACCEL_1, 1234));
}

void test_settings_of_an_axis_concern_no_other_axis(void)
{
    for (uint32_t taken = 1; taken <= POS_AXES; taken++) {
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, taken, 0));
        for (uint32_t axis = 1; axis <= POS_AXES; axis++) {
            TEST_ASSERT_EQUAL_INT(axis == taken ? MODBUS_EXCEPTION_BUSY : MODBUS_EXCEPTION_NONE,
                                  set(ACCEL_1 + 100U * (axis - 1U), (uint16_t)(10U * taken + axis)));
        }
        TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_BUSY, set(STORE, 1));
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, taken));
    }
}

void test_a_store_has_two_seconds_for_its_answer(void)
{
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 06 00 28 00 01"));
    TEST_ASSERT_EQUAL_UINT64(2000U * TICKS_PER_MS, unit.server.patience_ticks);
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 06 00 1E 00 0A"));
    TEST_ASSERT_EQUAL_UINT64(20U * TICKS_PER_MS, unit.server.patience_ticks);
}

void test_a_store_that_fails_leaves_what_was_stored(void)
{
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(ACCEL_1, 1));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(STORE, 1));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(ACCEL_1, 2));
    machine.faults.flash_fail_at = machine.flash_operations + 3U;
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_FAILURE, set(STORE, 1));
    restart();
    TEST_ASSERT_EQUAL_UINT32(1, unit.registers.axes[0][POS_AXIS_HIGHEST_ACCEL]);
}

static void set_accels(uint16_t accel_mm_s2)
{
    for (uint32_t axis = 0; axis < (uint32_t)POS_AXES; axis++) {
        TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(ACCEL_1 + 100U * axis, accel_mm_s2));
    }
}

/* Whether all axes have one of two settings, and which. */
static uint32_t all_accels(void)
{
    uint32_t accel_mm_s2 = unit.registers.axes[0][POS_AXIS_HIGHEST_ACCEL];
    for (unsigned axis = 1; axis < (unsigned)POS_AXES; axis++) {
        TEST_ASSERT_EQUAL_UINT32(accel_mm_s2, unit.registers.axes[axis][POS_AXIS_HIGHEST_ACCEL]);
    }
    return accel_mm_s2;
}

void test_after_a_power_cut_at_any_word_all_old_settings_are_there_or_all_others(void)
{
    uint32_t operations = 1;
    for (uint32_t cut = 1; cut <= operations; cut++) {
        for (unsigned done = 0; done <= (unsigned)HOST_FLASH_ALL; done++) {
            rig_set_up();
            set_accels(1);
            TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(STORE, 1));
            set_accels(2);
            uint32_t before = machine.flash_operations;
            machine.faults.flash_done = (enum host_flash_done)done;
            machine.faults.flash_cut_after = before + cut;
            (void)set(STORE, 1);
            operations = machine.flash_operations - before;
            restart();
            TEST_ASSERT_FALSE(unit.settings.damaged);
            uint32_t accel_mm_s2 = all_accels();
            TEST_ASSERT_TRUE(accel_mm_s2 == 1U || (accel_mm_s2 == 2U && cut + 4U > operations));
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(SETTINGS * 4U / 2U, operations);
}

void test_a_change_of_the_scale_makes_the_present_place_zero(void)
{
    static const uint16_t scale[] = {0, 3200, 0, 40000};
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 37, 1000, 0, 1));
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_INT32(1000, rig_values(1).position_um);
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, positioning_write(&unit, 130, 4, scale));
    TEST_ASSERT_EQUAL_INT32(0, rig_values(1).position_um);
    TEST_ASSERT_EQUAL_HEX(0, rig_values(1).flags);
}

/* STEPS, MICROMETRES, INVERT and BACKLASH, each alone; what is written once more changes nothing. */
void test_a_change_of_the_axis_itself_makes_the_present_place_zero_and_the_same_once_more_does_not(void)
{
    static const struct {
        uint32_t number;
        uint32_t count;
        uint16_t values[2];
    } writes[] = {{130, 2, {0, 2}}, {132, 2, {0, 30}}, {134, 1, {1}}, {141, 1, {20}}};
    for (unsigned i = 0; i < 4; i++) {
        for (unsigned again = 0; again < 2; again++) {
            TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
            TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 37, 1000, 0, 1));
            rig_run_ms(2);
            TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
            TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE,
                                  positioning_write(&unit, writes[i].number, writes[i].count, writes[i].values));
            TEST_ASSERT_EQUAL_INT32(again != 0 ? 1000 : 0, rig_values(1).position_um);
            TEST_ASSERT_EQUAL_HEX(again != 0 ? POS_FLAG_REFERENCED : 0, rig_values(1).flags);
        }
    }
    TEST_ASSERT_TRUE(machine.turned[0]);
}

/* 50 um are 5 steps. INVERT is another setting: the motor has them before it, as it went backward last. */
void test_a_direction_that_is_turned_round_keeps_the_slack_that_there_is(void)
{
    static const uint16_t backlash_um = 50;
    static const uint16_t inverted = 1;
    static const int32_t ways_um[] = {-100, 100};
    static const unsigned pulses[] = {15, 30};
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, positioning_write(&unit, 141, 1, &backlash_um));
    for (unsigned i = 0; i < 2; i++) {
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, ways_um[i], 500, 1));
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, UINT32_C(1000) << 16U, 1, 1));
        rig_run_ms(500);
        TEST_ASSERT_EQUAL_UINT(pulses[i], rig_pulses[0]);
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
        rig_run_ms(2);
        TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, positioning_write(&unit, 134, 1, &inverted));
    }
}
