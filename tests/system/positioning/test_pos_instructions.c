/* The instructions: what is refused, and in which order; states and records; instructions that come by the line. */
#include "pos_rig.h"

#define FEED(mm_per_min) ((uint32_t)(mm_per_min) << 16U)

enum {
    ACCEL = 500,
    MP = POS_CNT_MP,
    RESET = POS_CNT_RESET,
    INIC = POS_CNT_INIC,
    CONT = POS_CNT_CONT,
    JEDE = 0x0100,
    POL = 0x0800,
    DISP = 0x0001,
    PROG = 0x0002,
    ERR = 0x0004,
    WATCHDOG = 30,
};

void setUp(void)
{
    rig_set_up();
    rig_run_ms(10);
}

void tearDown(void)
{
}

static void take(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
}

static void mode(int32_t len_um)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, len_um, ACCEL, 1));
}

static void control(uint32_t feed, int mp)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, feed, mp, 1));
}

static void reset(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
}

static void set(uint32_t number, uint16_t value)
{
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, positioning_write(&unit, number, 1, &value));
}

static void assert_bits(unsigned status, unsigned bits, uint32_t feed)
{
    TEST_ASSERT_EQUAL_HEX(status, rig_status(1));
    TEST_ASSERT_EQUAL_HEX(bits, rig_control(1));
    TEST_ASSERT_EQUAL_HEX32(feed, unit.axes[0].feed);
}

static void move(void)
{
    take();
    mode(10000);
    control(FEED(1000), 1);
    rig_run_ms(100);
    assert_bits(JEDE | DISP | PROG, MP | CONT, FEED(1000));
}

static void fail(void)
{
    set(WATCHDOG, 200);
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 03 00 00 00 01"));
    move();
    for (unsigned i = 0; i < 100 && rig_values(1).error == 0; i++) {
        rig_run_ms(1);
    }
}

/* ---- refusals -------------------------------------------------------------------------------------------------- */

void test_an_axis_that_is_not_there_is_refused_and_shows_nothing(void)
{
    struct pos_values values = {.error = 77};
    struct pos_status_record status = {.status1 = 77};
    const unsigned wrong[] = {0, 5, 16};
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(POS_ERROR_AXIS, pos_init(&unit, wrong[i], 7));
        TEST_ASSERT_EQUAL_INT(POS_ERROR_AXIS, pos_mode(&unit, NULL, INT32_MIN, 0, wrong[i]));
        TEST_ASSERT_EQUAL_INT(POS_ERROR_AXIS, pos_mode_abs(&unit, NULL, INT32_MIN, 0, wrong[i]));
        TEST_ASSERT_EQUAL_INT(POS_ERROR_AXIS, pos_home(&unit, NULL, 20, INT32_MIN, 0, wrong[i]));
        TEST_ASSERT_EQUAL_INT(POS_ERROR_AXIS, pos_control(&unit, &status, 1, 1, wrong[i]));
        TEST_ASSERT_EQUAL_INT(POS_ERROR_AXIS, pos_reset(&unit, wrong[i]));
        TEST_ASSERT_EQUAL_INT(POS_ERROR_AXIS, pos_capture(&unit, wrong[i]));
        pos_read(&unit, wrong[i], &values);
    }
    TEST_ASSERT_EQUAL_UINT16(77, values.error);
    TEST_ASSERT_EQUAL_UINT8(77, status.status1);
    for (unsigned axis = 1; axis <= POS_AXES; axis++) {
        TEST_ASSERT_EQUAL_HEX(0, rig_status(axis));
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, axis, 6));
    }
}

/* Each cause is taken away when it has been told. */
void test_of_several_causes_the_first_one_counts(void)
{
    uint32_t *settings = unit.registers.axes[0];
    machine.faults.no_crystal = true;
    unit.settings.damaged = true;
    TEST_ASSERT_EQUAL_INT(POS_ERROR_NOT_TAKEN, pos_home(&unit, NULL, 20, INT32_MIN, 0, 1));
    take();
    TEST_ASSERT_EQUAL_INT(POS_ERROR_METHOD, pos_home(&unit, NULL, 20, INT32_MIN, 0, 1));
    TEST_ASSERT_EQUAL_INT(POS_ERROR_SETTINGS, pos_home(&unit, NULL, 21, INT32_MIN, 0, 1));
    unit.settings.damaged = false;
    TEST_ASSERT_EQUAL_INT(POS_ERROR_NO_CRYSTAL, pos_home(&unit, NULL, 21, INT32_MIN, 0, 1));
    machine.faults.no_crystal = false;
    TEST_ASSERT_EQUAL_INT(POS_ERROR_NO_INPUT, pos_home(&unit, NULL, 19, INT32_MIN, 0, 1));
    settings[POS_AXIS_REFERENCE] = 3;
    TEST_ASSERT_EQUAL_INT(POS_ERROR_ACCEL, pos_home(&unit, NULL, 19, INT32_MIN, 0, 1));
    TEST_ASSERT_EQUAL_INT(POS_ERROR_WAY, pos_home(&unit, NULL, 19, INT32_MIN, 1, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 19, INT32_MIN + 1, 1, 1));
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_METHOD, rig_values(1).error);
}

void test_a_motion_and_a_fault_come_before_what_is_wrong_with_a_measure(void)
{
    move();
    machine.faults.no_crystal = true;
    unit.settings.damaged = true;
    TEST_ASSERT_EQUAL_INT(POS_ERROR_MOVES, pos_home(&unit, NULL, 20, INT32_MIN, 0, 1));
    TEST_ASSERT_EQUAL_HEX(JEDE | DISP | PROG | ERR, rig_status(1));
    unit.settings.damaged = false;
    machine.faults.no_crystal = false;
    reset();
    rig_run_ms(100);
    fail();
    assert_bits(JEDE | DISP | ERR, MP, 0);
    TEST_ASSERT_EQUAL_INT(POS_ERROR_FAULT, pos_home(&unit, NULL, 20, INT32_MIN, 0, 1));
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_INT(POS_ERROR_FAULT, pos_mode(&unit, NULL, 1, ACCEL, 1));
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_SILENT, rig_values(1).error);
}

void test_a_space_is_0_to_6(void)
{
    TEST_ASSERT_EQUAL_INT(POS_ERROR_SPACE, pos_init(&unit, 1, 7));
    assert_bits(ERR, 0, 0);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 6));
    assert_bits(DISP, MP | RESET, 0);
}

void test_a_way_is_too_long_from_2_to_the_31_on(void)
{
    take();
    TEST_ASSERT_EQUAL_INT(POS_ERROR_WAY, pos_mode(&unit, NULL, INT32_MIN, ACCEL, 1));
    TEST_ASSERT_EQUAL_INT(POS_ERROR_WAY, pos_mode_abs(&unit, NULL, INT32_MIN, ACCEL, 1));
    TEST_ASSERT_EQUAL_INT(POS_ERROR_WAY, pos_home(&unit, NULL, 37, INT32_MIN, 0, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode_abs(&unit, NULL, INT32_MIN + 1, ACCEL, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 37, -1, 0, 1));
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_INT(POS_ERROR_WAY, pos_mode_abs(&unit, NULL, INT32_MAX, ACCEL, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode_abs(&unit, NULL, INT32_MAX - 1, ACCEL, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 37, 1, 0, 1));
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_INT(POS_ERROR_WAY, pos_mode_abs(&unit, NULL, INT32_MIN + 1, ACCEL, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode_abs(&unit, NULL, INT32_MIN + 2, ACCEL, 1));
    unit.axes[0].frame.base_um = POS_MEASURE_UM_MAX;
    TEST_ASSERT_EQUAL_INT(POS_ERROR_WAY, pos_mode(&unit, NULL, 1, ACCEL, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, -1, ACCEL, 1));
}

void test_error_is_the_first_refusal_until_pos_init_or_pos_reset(void)
{
    TEST_ASSERT_EQUAL_INT(POS_ERROR_NO_INPUT, pos_capture(&unit, 1));
    TEST_ASSERT_EQUAL_INT(POS_ERROR_NOT_TAKEN, pos_mode(&unit, NULL, 1, ACCEL, 1));
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_NO_INPUT, rig_values(1).error);
    reset();
    TEST_ASSERT_EQUAL_UINT16(POS_OK, rig_values(1).error);
    TEST_ASSERT_EQUAL_INT(POS_ERROR_NOT_TAKEN, pos_mode(&unit, NULL, 1, ACCEL, 1));
    take();
    TEST_ASSERT_EQUAL_UINT16(POS_OK, rig_values(1).error);
}

void test_without_the_crystal_only_measures_are_refused(void)
{
    machine.faults.no_crystal = true;
    take();
    TEST_ASSERT_EQUAL_INT(POS_ERROR_NO_CRYSTAL, pos_mode(&unit, NULL, 1, ACCEL, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 37, 5, 0, 1));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 04 00 04 00 01"));
    TEST_ASSERT_EQUAL_HEX(1, rig_word(0));
    TEST_ASSERT_EQUAL_INT32(5, rig_values(1).position_um);
}

/* ---- states ---------------------------------------------------------------------------------------------------- */

void test_a_free_axis_takes_no_control(void)
{
    control(FEED(1000), 1);
    assert_bits(0, 0, 0);
    TEST_ASSERT_EQUAL_INT(POS_ERROR_NOT_TAKEN, pos_mode_abs(&unit, NULL, 1, ACCEL, 1));
    assert_bits(ERR, 0, 0);
    reset();
    assert_bits(0, RESET, 0);
    rig_run_ms(2);
    assert_bits(0, 0, 0);
}

void test_an_axis_that_is_taken_takes_mp_and_not_the_feed(void)
{
    take();
    assert_bits(DISP, MP | RESET, 0);
    rig_run_ms(2);
    assert_bits(DISP, MP, 0);
    control(FEED(1000), POS_MP_NIL);
    assert_bits(DISP, MP, 0);
    control(FEED(1000), 0);
    assert_bits(DISP, 0, 0);
    mode(10);
    assert_bits(DISP | PROG, INIC, 0);
    reset();
    assert_bits(0, RESET, 0);
}

void test_a_measure_waits_for_feed_and_permit_and_gives_way_to_another(void)
{
    take();
    control(0, 0);
    mode(10000);
    rig_run_ms(2);
    assert_bits(DISP | PROG, CONT, 0);
    control(FEED(1000), POS_MP_NIL);
    rig_run_ms(10);
    assert_bits(DISP | PROG, CONT, FEED(1000));
    TEST_ASSERT_EQUAL_INT32(10000, rig_values(1).way_left_um);
    mode(-50);
    assert_bits(DISP | PROG, INIC, 0);
    TEST_ASSERT_EQUAL_INT32(0, rig_values(1).way_left_um);
    control(FEED(1000), 1);
    rig_run_ms(100);
    assert_bits(POL | 0x0200 | DISP | PROG, MP, FEED(1000));
    TEST_ASSERT_EQUAL_INT64(-5, rig_position[0]);
}

void test_a_hold_keeps_the_measure_and_a_refusal_the_motion(void)
{
    struct pos_status_record status;
    move();
    TEST_ASSERT_EQUAL_INT(POS_ERROR_MOVES, pos_mode(&unit, NULL, 1, ACCEL, 1));
    assert_bits(JEDE | DISP | PROG | ERR, MP | CONT, FEED(1000));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, &status, 0, POS_MP_NIL, 1));
    TEST_ASSERT_EQUAL_HEX8(POS_STV_JEDE, status.status1);
    TEST_ASSERT_EQUAL_HEX8(POS_STV_DISP | POS_STV_PROG | POS_STV_ERR, status.status2);
    rig_run_ms(100);
    assert_bits(DISP | PROG | ERR, MP | CONT, 0);
    control(FEED(1000), 0);
    rig_run_ms(10);
    assert_bits(DISP | PROG | ERR, CONT, FEED(1000));
    control(FEED(1000), 1);
    rig_run_ms(2000);
    assert_bits(POL | DISP | PROG | ERR, MP, FEED(1000));
    TEST_ASSERT_EQUAL_INT64(1000, rig_position[0]);
}

void test_what_has_been_reached_does_not_move_and_takes_the_next_measure(void)
{
    take();
    mode(0);
    assert_bits(DISP | PROG, MP | INIC, 0);
    rig_run_ms(2);
    assert_bits(POL | DISP | PROG, MP, 0);
    control(FEED(1000), 1);
    rig_run_ms(10);
    assert_bits(POL | DISP | PROG, MP, FEED(1000));
    mode(10);
    assert_bits(DISP | PROG, MP | INIC, 0);
    rig_run_ms(2);
    assert_bits(DISP | PROG, MP | CONT, 0);
    take();
    assert_bits(DISP, MP | RESET, 0);
}

void test_a_measure_that_waits_for_the_stand_keeps_its_feed(void)
{
    move();
    take();
    assert_bits(JEDE | DISP, MP | RESET, 0);
    mode(-10000);
    assert_bits(JEDE | DISP | PROG, MP | INIC, 0);
    control(FEED(500), 0);
    rig_run_ms(2);
    assert_bits(JEDE | DISP | PROG, INIC, FEED(500));
    TEST_ASSERT_EQUAL_INT(POS_ERROR_MOVES, pos_mode(&unit, NULL, 1, ACCEL, 1));
    rig_run_ms(100);
    assert_bits(DISP | PROG | ERR, CONT, FEED(500));
    TEST_ASSERT_EQUAL_INT32(-10000, rig_values(1).way_left_um);
    control(FEED(500), 1);
    rig_run_ms(10);
    assert_bits(JEDE | 0x0200 | DISP | PROG | ERR, MP | CONT, FEED(500));
}

void test_a_fault_takes_mp_and_not_the_feed_until_pos_init(void)
{
    fail();
    control(FEED(1000), 0);
    assert_bits(JEDE | DISP | ERR, 0, 0);
    rig_run_ms(100);
    control(FEED(1000), 1);
    rig_run_ms(10);
    assert_bits(DISP | ERR, MP, 0);
    reset();
    assert_bits(0, RESET, 0);
}

void test_pos_reset_brakes_and_the_axis_is_free_at_once(void)
{
    move();
    reset();
    assert_bits(JEDE, RESET, 0);
    rig_run_ms(1);
    assert_bits(JEDE, 0, 0);
    take();
    rig_run_ms(1);
    assert_bits(JEDE | DISP, MP, 0);
    rig_run_ms(100);
    assert_bits(DISP, MP, 0);
}

/* ---- records of the caller ------------------------------------------------------------------------------------- */

void test_a_record_of_the_caller_gives_mp_and_gets_all_other_bits_in_each_pass(void)
{
    struct pos_control_record record = {.control1 = 0xFF, .control2 = 0xFE};
    take();
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, &record, 10000, ACCEL, 1));
    TEST_ASSERT_EQUAL_HEX8(0, record.control1);
    TEST_ASSERT_EQUAL_HEX8(INIC, record.control2);
    control(FEED(1000), POS_MP_NIL);
    rig_run_ms(10);
    assert_bits(DISP | PROG, CONT, FEED(1000));
    record.control2 = MP;
    rig_run_ms(10);
    TEST_ASSERT_EQUAL_HEX8(MP | CONT, record.control2);
    TEST_ASSERT_EQUAL_HEX(JEDE | DISP | PROG, rig_status(1));
    record = (struct pos_control_record){.control1 = 0x55, .control2 = 0xF0};
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_HEX8(0, record.control1);
    TEST_ASSERT_EQUAL_HEX8(CONT, record.control2);
    TEST_ASSERT_EQUAL_HEX(DISP | PROG, rig_status(1));
}

void test_a_record_is_in_use_until_the_next_one_or_pos_reset(void)
{
    struct pos_control_record first = {.control2 = MP};
    struct pos_control_record second = {.control2 = MP};
    take();
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, &first, 0, ACCEL, 1));
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_HEX8(MP, first.control2);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode_abs(&unit, &second, 1000, ACCEL, 1));
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_HEX8(MP, first.control2);
    TEST_ASSERT_EQUAL_HEX8(MP | CONT, second.control2);
    take();
    TEST_ASSERT_EQUAL_HEX8(MP | RESET, second.control2);
    reset();
    TEST_ASSERT_EQUAL_HEX8(0, second.control2);
    assert_bits(0, RESET, 0);
    second.control2 = 0xAA;
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_HEX8(0xAA, second.control2);
    take();
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, &first, 37, 0, 0, 1));
    mode(1000);
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_HEX8(MP | INIC, first.control2);
    assert_bits(DISP | PROG, MP | CONT, 0);
}

/* ---- by the line ----------------------------------------------------------------------------------------------- */

static void assert_instruction(const char *word, unsigned done, unsigned result)
{
    char request[64];
    (void)snprintf(request, sizeof request, "01 17 00 70 00 02 00 64 00 01 02 %s", word);
    TEST_ASSERT_EQUAL_UINT(0, rig_ask(request));
    TEST_ASSERT_EQUAL_HEX(done, rig_word(0));
    TEST_ASSERT_EQUAL_UINT(result, rig_word(1));
}

void test_each_code_is_its_instruction_and_done_and_result_tell_of_it(void)
{
    assert_instruction("01 02", 0x0102, POS_ERROR_NOT_TAKEN);
    assert_instruction("01 04", 0x0104, POS_ERROR_NOT_TAKEN);
    assert_instruction("01 05", 0x0105, POS_ERROR_NOT_TAKEN);
    assert_instruction("01 06", 0x0106, POS_ERROR_NO_INPUT);
    assert_instruction("01 01", 0x0101, POS_OK);
    assert_bits(DISP, MP, 0);
    assert_instruction("02 05", 0x0205, POS_ERROR_METHOD);
    assert_instruction("02 02", 0x0202, POS_ERROR_ACCEL);
    assert_instruction("02 00", 0x0200, POS_OK);
    assert_bits(DISP | ERR, MP, 0);
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 10 00 65 00 04 08 00 25 00 00 04 D2 00 05"));
    assert_instruction("03 05", 0x0305, POS_OK);
    TEST_ASSERT_EQUAL_INT32(1234, rig_values(1).position_um);
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 06 00 65 00 00"));
    assert_instruction("03 04", 0x0304, POS_OK);
    assert_bits(POL | DISP | PROG | ERR, MP, 0);
    assert_instruction("03 02", 0x0302, POS_OK);
    assert_bits(DISP | PROG | ERR, MP | CONT, 0);
    assert_instruction("03 03", 0x0303, POS_OK);
    assert_bits(0, 0, 0);
}

void test_an_instruction_is_executed_once_and_0_stands_for_none(void)
{
    assert_instruction("01 01", 0x0101, POS_OK);
    reset();
    assert_instruction("01 01", 0x0101, POS_OK);
    assert_bits(0, 0, 0);
    assert_instruction("00 00", 0, POS_OK);
    assert_instruction("01 01", 0x0101, POS_OK);
    assert_bits(DISP, MP, 0);
}

void test_a_request_that_brings_the_instruction_sees_reset_and_inic_once(void)
{
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 17 00 69 00 01 00 64 00 01 02 01 01"));
    TEST_ASSERT_EQUAL_HEX(MP | RESET, rig_word(0));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 03 00 69 00 01"));
    TEST_ASSERT_EQUAL_HEX(MP, rig_word(0));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 17 00 69 00 01 00 64 00 05 0A 01 02 00 00 00 00 03 E8 01 F4"));
    TEST_ASSERT_EQUAL_HEX(MP | INIC, rig_word(0));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 03 00 69 00 01"));
    TEST_ASSERT_EQUAL_HEX(MP | CONT, rig_word(0));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 17 00 69 00 01 00 64 00 01 02 01 03"));
    TEST_ASSERT_EQUAL_HEX(RESET, rig_word(0));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 03 00 69 00 01"));
    TEST_ASSERT_EQUAL_HEX(0, rig_word(0));
}

void test_control_and_feed_of_one_request_are_one_pos_control(void)
{
    take();
    mode(10000);
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 10 00 69 00 03 06 00 00 12 34 56 78"));
    assert_bits(DISP | PROG, CONT, 0x12345678);
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 03 00 6A 00 01"));
    TEST_ASSERT_EQUAL_HEX(0x1234, rig_word(0));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 06 00 6A 00 01"));
    assert_bits(DISP | PROG, CONT, 0x00010000);
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 06 00 69 00 0F"));
    rig_run_ms(10);
    assert_bits(JEDE | DISP | PROG, MP | CONT, 0x00010000);
    TEST_ASSERT_EQUAL_UINT(3, rig_ask("01 06 00 69 00 10"));
}

void test_exceptions_come_in_their_order_and_change_nothing(void)
{
    take();
    TEST_ASSERT_EQUAL_UINT(1, rig_ask("01 07"));
    TEST_ASSERT_EQUAL_UINT(1, rig_ask("01 2B 0D 01 00"));
    TEST_ASSERT_EQUAL_UINT(3, rig_ask("01 03 03 E7 00 7E"));
    TEST_ASSERT_EQUAL_UINT(3, rig_ask("01 10 03 E7 00 01 03 00 00 00"));
    TEST_ASSERT_EQUAL_UINT(2, rig_ask("01 03 03 E7 00 01"));
    TEST_ASSERT_EQUAL_UINT(2, rig_ask("01 04 00 64 00 01"));
    TEST_ASSERT_EQUAL_UINT(2, rig_ask("01 10 00 99 00 02 04 00 00 00 00"));
    TEST_ASSERT_EQUAL_UINT(2, rig_ask("01 17 03 E7 00 01 00 64 00 01 02 01 03"));
    TEST_ASSERT_EQUAL_UINT(3, rig_ask("01 06 00 86 00 02"));
    TEST_ASSERT_EQUAL_UINT(6, rig_ask("01 06 00 86 00 01"));
    machine.faults.flash_fail_at = machine.flash_operations + 3U;
    TEST_ASSERT_EQUAL_UINT(6, rig_ask("01 06 00 28 00 01"));
    assert_bits(DISP, MP, 0);
    reset();
    TEST_ASSERT_EQUAL_UINT(4, rig_ask("01 06 00 28 00 01"));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 06 00 86 00 01"));
}

void test_the_way_of_an_absolute_measure_counts_from_where_the_axis_brakes(void)
{
    take();
    mode(10000);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, UINT32_C(1000) << 16U, 1, 1));
    rig_run_ms(300);
    TEST_ASSERT_TRUE(rig_position[0] > 0);
    take();
    TEST_ASSERT_EQUAL_INT(POS_ERROR_WAY, pos_mode_abs(&unit, NULL, -INT32_MAX, 500, 1));
}
