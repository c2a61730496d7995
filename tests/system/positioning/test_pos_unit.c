/* The unit as a whole: what it tells of itself, its line under load, when it is idle. */
#include "pos_rig.h"

#include "hal_board.h"
#include "hal_time.h"

#define FEED(mm_per_min) ((uint32_t)(mm_per_min) << 16U)

enum {
    ACCEL = 500,
    CONDITION_DAMAGED = 2,
    CONDITION_OTHER = 4,
    STORE = 40,
};

static unsigned passes;
static unsigned writes_seen;

/* The PLC program of this test. */
void plc_pass(struct pos_unit *of)
{
    passes++;
    writes_seen += of->write.count == 1U && of->axes[3].state == (uint8_t)POS_TAKEN;
}

void setUp(void)
{
    rig_set_up();
    rig_run_ms(10);
}

void tearDown(void)
{
}

static void restart(void)
{
    host_machine_restart(&machine);
    rig_begin();
    rig_run_ms(10);
}

static unsigned read(const char *number)
{
    char request[32];
    (void)snprintf(request, sizeof request, "01 04 %s 00 01", number);
    TEST_ASSERT_EQUAL_UINT(0, rig_ask(request));
    return rig_word(0);
}

static void move(unsigned axis, int32_t len_um)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, axis, 0));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, len_um, ACCEL, axis));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, FEED(1000), 1, axis));
}

/* ---- what it tells --------------------------------------------------------------------------------------------- */

void test_the_cause_of_the_start_is_told(void)
{
    for (unsigned cause = HAL_BOARD_CAUSE_POWER; cause <= HAL_BOARD_CAUSE_FAULT; cause++) {
        machine.faults.start_cause = (enum hal_board_cause)cause;
        TEST_ASSERT_EQUAL_UINT(cause, read("00 03"));
    }
}

void test_a_setting_that_is_not_stored_shows_in_condition(void)
{
    TEST_ASSERT_EQUAL_HEX(0, read("00 04"));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 06 00 87 00 05"));
    TEST_ASSERT_EQUAL_HEX(CONDITION_OTHER, read("00 04"));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 06 00 87 FF FF"));
    TEST_ASSERT_EQUAL_HEX(0, read("00 04"));
}

static void assert_damaged(void)
{
    TEST_ASSERT_EQUAL_HEX(CONDITION_DAMAGED | CONDITION_OTHER, read("00 04"));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 06 00 87 00 05"));
    TEST_ASSERT_EQUAL_HEX(CONDITION_DAMAGED | CONDITION_OTHER, read("00 04"));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    TEST_ASSERT_EQUAL_INT(POS_ERROR_SETTINGS, pos_mode(&unit, NULL, 1, ACCEL, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 37, 0, 0, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 06 00 28 00 01"));
    TEST_ASSERT_EQUAL_HEX(0, read("00 04"));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 1, ACCEL, 1));
    restart();
    TEST_ASSERT_EQUAL_HEX(0, read("00 04"));
    TEST_ASSERT_EQUAL_UINT32(5, unit.registers.axes[0][POS_AXIS_HIGHEST_ACCEL]);
}

void test_stored_settings_whose_bits_have_changed_are_never_used(void)
{
    static const uint16_t one = 1;
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, positioning_write(&unit, STORE, 1, &one));
    uint32_t at = unit.settings.store.image[POS_SETTINGS_SLOT];
    machine.flash[unit.settings.store.area][at + 40U] ^= 4U;
    restart();
    assert_damaged();
}

void test_a_text_of_another_unit_is_no_settings(void)
{
    uint8_t text[600] = "1 program";
    TEST_ASSERT_EQUAL_INT(STORE_OK, store_save(&unit.settings.store, POS_SETTINGS_SLOT, text, 10));
    restart();
    assert_damaged();
}

void test_a_text_of_another_version_is_no_settings(void)
{
    uint8_t text[600];
    static const uint16_t one = 1;
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, positioning_write(&unit, STORE, 1, &one));
    uint32_t length = store_load(&unit.settings.store, POS_SETTINGS_SLOT, text);
    TEST_ASSERT_LESS_THAN(sizeof text, length);
    TEST_ASSERT_EQUAL_UINT32(4 + 4 * (3 + POS_AXES * 17), length); /* settings of the unit and of an axis */
    TEST_ASSERT_EQUAL_MEMORY("POS\1\0\0\0\0\0\0\0\xC0", text, 12);
    text[3]++;
    TEST_ASSERT_EQUAL_INT(STORE_OK, store_save(&unit.settings.store, POS_SETTINGS_SLOT, text, length));
    restart();
    assert_damaged();
}

static uint32_t wide(unsigned index)
{
    return (uint32_t)rig_word(index) << 16U | rig_word(index + 1U);
}

void test_each_value_of_an_axis_has_its_register(void)
{
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 06 01 5D 00 05"));
    move(3, -10000);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_capture(&unit, 3));
    rig_run_ms(200);
    host_machine_set_input(&machine, 5, true);
    rig_run_ms(20);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, FEED(1000), 0, 3));
    TEST_ASSERT_EQUAL_INT(POS_ERROR_MOVES, pos_mode(&unit, NULL, 1, ACCEL, 3));
    rig_run_ms(100);
    struct pos_values values = rig_values(3);
    TEST_ASSERT_TRUE(values.captured_um < -2000 && values.position_um < values.captured_um);
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 04 01 36 00 12"));
    TEST_ASSERT_EQUAL_HEX(0x0207, rig_word(0));
    TEST_ASSERT_EQUAL_UINT(POS_ERROR_MOVES, rig_word(1));
    TEST_ASSERT_EQUAL_HEX(POS_FLAG_CAPTURE, rig_word(4));
    TEST_ASSERT_EQUAL_UINT(1, rig_word(5));
    TEST_ASSERT_EQUAL_HEX32(values.position_um, wide(6));
    TEST_ASSERT_EQUAL_HEX32(values.way_left_um, wide(8));
    TEST_ASSERT_EQUAL_HEX32(0, wide(10));
    TEST_ASSERT_EQUAL_HEX32(values.position_steps, wide(12));
    TEST_ASSERT_EQUAL_HEX32(values.captured_um, wide(14));
    TEST_ASSERT_EQUAL_HEX32(values.captured_steps, wide(16));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 03 01 31 00 03"));
    TEST_ASSERT_EQUAL_HEX(POS_CNT_CONT, rig_word(0));
    TEST_ASSERT_EQUAL_HEX32(FEED(1000), wide(1));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 06 01 31 00 01"));
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 04 01 40 00 02"));
    TEST_ASSERT_UINT32_WITHIN(FEED(1), FEED(1000), wide(0));
}

void test_outputs_are_0_from_the_start_on(void)
{
    machine.outputs = 0x55;
    rig_begin();
    TEST_ASSERT_EQUAL_HEX8(0, machine.outputs);
}

void test_inputs_are_shown(void)
{
    host_machine_set_input(&machine, 3, true);
    host_machine_set_input(&machine, 8, true);
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_HEX(0x84, read("00 05"));
}

/* ---- passes ---------------------------------------------------------------------------------------------------- */

void test_the_next_pass_comes_in_a_millisecond_or_at_once(void)
{
    TEST_ASSERT_EQUAL_UINT64(hal_time_now() + TICKS_PER_MS, positioning_poll(&unit));
    move(2, 10000);
    TEST_ASSERT_EQUAL_UINT64(hal_time_now(), positioning_poll(&unit));
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, FEED(900), 1, 2));
    TEST_ASSERT_EQUAL_UINT64(hal_time_now(), positioning_poll(&unit));
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 10, ACCEL, 2));
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, FEED(900), 1, 2));
    TEST_ASSERT_EQUAL_UINT64(hal_time_now(), positioning_poll(&unit));
}

void test_the_plc_program_is_called_once_in_a_pass_after_the_line(void)
{
    passes = 0;
    (void)positioning_poll(&unit);
    TEST_ASSERT_EQUAL_UINT(1, passes);
    writes_seen = 0;
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 06 01 90 01 01"));
    TEST_ASSERT_GREATER_THAN_UINT(0, writes_seen);
}

void test_what_a_pass_plans_for_several_axes_is_handed_over_in_it(void)
{
    for (unsigned axis = 1; axis <= POS_AXES; axis++) {
        move(axis, 10000);
    }
    rig_run_ms(100);
    for (unsigned axis = 1; axis <= POS_AXES; axis++) {
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, FEED(900), 1, axis));
    }
    (void)positioning_poll(&unit);
    for (unsigned axis = 0; axis < POS_AXES; axis++) {
        TEST_ASSERT_FALSE(pos_drive_is_stirred(&unit.axes[axis].drive));
    }
}

/* ---- the line -------------------------------------------------------------------------------------------------- */

void test_a_long_answer_goes_out_while_axes_move(void)
{
    move(1, 10000);
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 04 02 80 00 20"));
    TEST_ASSERT_EQUAL_UINT32(69, rig_heard_count);
    TEST_ASSERT_EQUAL_HEX(0x0103, rig_word(0));
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_INT64(1000, rig_position[0]);
}

static uint64_t first_byte_tick;

static void note_byte(void *context, uint64_t tick, uint8_t value)
{
    first_byte_tick = rig_heard_count == 0U ? tick : first_byte_tick;
    rig_line(context, tick, value);
}

/* T after the last byte, and its own time. */
void test_an_answer_begins_as_soon_as_the_request_has_come(void)
{
    machine.listener.line = note_byte;
    uint64_t end = machine.now + 8U * machine.line.byte_ticks;
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 04 00 05 00 01"));
    uint64_t begin = first_byte_tick - machine.line.byte_ticks;
    TEST_ASSERT_UINT64_WITHIN(TICKS_PER_MS / 10U, end + (machine.line.byte_ticks * 7U) / 2U, begin);
}

void test_all_axes_are_written_by_one_request(void)
{
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 10 02 58 00 20 40"
                                      " 01 01 00 00 00 00 03 E8 01 F4 00 00 00 00 00 00"
                                      " 01 01 00 00 00 00 03 E8 01 F4 00 01 00 00 00 00"
                                      " 01 01 00 00 00 00 03 E8 01 F4 00 00 00 00 00 00"
                                      " 01 01 00 00 00 00 03 E8 01 F4 00 00 00 00 00 00"));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 10 01 90 00 08 10 02 02 00 00 00 00 03 E8 01 F4 00 01 03 E8 00 00"));
    rig_run_ms(1000);
    for (unsigned axis = 1; axis < POS_AXES; axis++) {
        TEST_ASSERT_EQUAL_HEX(0x0001, rig_status(axis));
        TEST_ASSERT_EQUAL_HEX(axis == 2 ? POS_CNT_MP : 0, rig_control(axis));
    }
    TEST_ASSERT_EQUAL_HEX(0x0803, rig_status(4));
    TEST_ASSERT_EQUAL_INT64(100, rig_position[3]);
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 04 01 9A 00 01"));
    TEST_ASSERT_EQUAL_HEX(0x0803, rig_word(0));
}

void test_reads_are_refused_where_a_register_is_not_there(void)
{
    TEST_ASSERT_EQUAL_UINT(2, rig_ask("01 03 00 6C 00 01"));
    TEST_ASSERT_EQUAL_UINT(2, rig_ask("01 04 00 64 00 01"));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 03 00 64 00 08"));
}

/* The bytes come on time, and main only when all of them are there. */
static void send_unheard(const char *text, uint64_t gap_ticks)
{
    uint8_t bytes[RIG_FRAME];
    uint32_t count = rig_bytes_of(text, bytes);
    uint64_t tick = machine.now;
    for (uint32_t i = 0; i < count; i++) {
        tick += machine.line.byte_ticks;
        tick += i % 8U == 0U ? gap_ticks : 0U;
        rig_script[i] = (struct host_line_byte){.tick = tick, .value = bytes[i]};
    }
    rig_heard_count = 0;
    host_machine_set_line(&machine, rig_script, count);
    rig_run_without_main(tick + 1U - machine.now);
}

static uint64_t poll_late(void *context)
{
    (void)context;
    return positioning_poll(&unit);
}

void test_each_count_has_its_register(void)
{
    for (unsigned i = 0; i < MODBUS_COUNTS_TOTAL; i++) {
        unit.server.counts[i] = UINT32_C(0x10000) * (i + 1U);
    }
    unit.silences = 0x12345678;
    machine.late_steps = 0x00AB0007;
    send_unheard("01 04 00 06 00 16 91 C5", 0);
    uint64_t asked_ms = machine.now / TICKS_PER_MS;
    host_machine_run(&machine, machine.now + 60U * TICKS_PER_MS, poll_late, NULL, NULL);
    TEST_ASSERT_EQUAL_UINT32(49, rig_heard_count);
    TEST_ASSERT_EQUAL_HEX32(0x00AB0007, wide(0));
    TEST_ASSERT_UINT32_WITHIN(4, (uint32_t)asked_ms + 2U, wide(2));
    for (unsigned i = 0; i < MODBUS_COUNTS_TOTAL; i++) {
        bool own = i == (unsigned)MODBUS_COUNT_FRAMES;
        TEST_ASSERT_EQUAL_HEX32(UINT32_C(0x10000) * (i + 1U) + (own ? 1U : 0U), wide(4U + 2U * i));
    }
    TEST_ASSERT_EQUAL_HEX32(0x12345678, wide(20));
}

void test_requests_that_main_finds_at_once_are_executed_one_after_the_other(void)
{
    send_unheard("01 06 00 64 01 01 08 45 01 06 00 6A 01 F4 A9 C1 01 06 00 64 03 01 09 25", 5 * TICKS_PER_MS);
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_UINT32(3, unit.server.counts[MODBUS_COUNT_FRAMES]);
    TEST_ASSERT_EQUAL_UINT32(0, unit.server.counts[MODBUS_COUNT_LENGTH]);
    TEST_ASSERT_EQUAL_HEX(1, rig_status(1));
}

void test_more_bytes_than_a_pass_hears_are_heard_in_the_next_ones(void)
{
    char text[3 * 100] = "";
    for (unsigned i = 0; i < 99; i++) {
        (void)snprintf(&text[3U * i], 4, "%02X ", i + 16U);
    }
    send_unheard(text, 0);
    rig_run_ms(50);
    TEST_ASSERT_EQUAL_UINT32(1, unit.server.counts[MODBUS_COUNT_CRC]);
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 06 00 64 01 01"));
}

/* ---- idle ------------------------------------------------------------------------------------------------------ */

static void assert_idle_at_rest_only(unsigned axis)
{
    TEST_ASSERT_TRUE(positioning_is_idle(&unit));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, axis, 0));
    TEST_ASSERT_TRUE(positioning_is_idle(&unit));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 100, ACCEL, axis));
    TEST_ASSERT_FALSE(positioning_is_idle(&unit));
    rig_run_ms(2);
    TEST_ASSERT_TRUE(positioning_is_idle(&unit));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, FEED(1000), 1, axis));
    TEST_ASSERT_FALSE(positioning_is_idle(&unit));
    rig_run_ms(5);
    TEST_ASSERT_FALSE(positioning_is_idle(&unit));
    rig_run_ms(1000);
    TEST_ASSERT_TRUE(positioning_is_idle(&unit));
}

void test_the_unit_is_idle_when_nothing_moves_waits_or_is_sent(void)
{
    for (unsigned axis = 1; axis <= (unsigned)POS_AXES; axis++) {
        assert_idle_at_rest_only(axis);
    }
}

void test_the_unit_is_not_idle_while_an_answer_is_sent(void)
{
    rig_send("01 04 02 80 00 20 F1 82");
    rig_run_ms(2);
    TEST_ASSERT_TRUE(modbus_is_sending(&unit.server));
    TEST_ASSERT_FALSE(positioning_is_idle(&unit));
    rig_run_ms(20);
    TEST_ASSERT_FALSE(modbus_is_sending(&unit.server));
    TEST_ASSERT_FALSE(positioning_is_idle(&unit));
    rig_run_ms(100);
    TEST_ASSERT_TRUE(positioning_is_idle(&unit));
}
