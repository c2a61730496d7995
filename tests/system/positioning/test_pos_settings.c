/* Settings: taken, kept, lost; which requests may change them. */
#include "pos_rig.h"

enum {
    STORE = 40,
    RATE = 31,
    FORMAT = 32,
    ACCEL_1 = 135,
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
    rig_expect("01 06 00 64 01 01 08 45", "01 06 00 64 01 01 08 45");
}

void test_settings_of_an_axis_that_is_taken_or_brakes_are_refused(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_BUSY, set(ACCEL_1, 1234));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_BUSY, set(STORE, 1));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_BUSY, set(RATE, 96));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(ACCEL_1 + 100, 1234));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 100000, 500, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, UINT32_C(1000) << 16U, 1, 1));
    rig_run_ms(200);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_BUSY, set(ACCEL_1, 1234));
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, set(ACCEL_1, 1234));
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
