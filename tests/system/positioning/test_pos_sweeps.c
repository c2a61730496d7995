/*
 * Trouble at every pulse of a move: limits, a bus that falls silent, the power; and the same request a thousand times.
 */
#include "pos_wire.h"

enum {
    PULSES = 120,
    STEP_UM = 10,
    ACCEL = 500,        /* 50 000 steps/s^2 */
    CRUISE_PULSES = 28, /* of a ramp to 1000 mm/min */
    LIMIT_MINUS = 146,
    LIMIT_PLUS = 147,
    SOFT_MIN = 142,
    WATCHDOG = 30,
    PATIENCE_MS = 50,
    LEAD_TICKS = 400 * TICKS_PER_US,
    ERR_ONLY = 4,
};

#define FEED (UINT32_C(1000) << 16U)

static struct host_input edge;
static uint64_t due[PULSES]; /* ticks from the start of a move that nothing disturbs */

static void begin(void)
{
    rig_set_up();
    rig_run_ms(10);
}

void setUp(void)
{
    begin();
}

void tearDown(void)
{
}

static void set(uint32_t number, uint16_t value)
{
    TEST_ASSERT_EQUAL_UINT(0, wire_write(MODBUS_WRITE_ONE, number, value, false));
}

/* POS_INIT, then a measure with its feed, as frames. */
static uint64_t move(int32_t len_um)
{
    static uint8_t number;
    struct wire_frame init = {.bytes = {1, MODBUS_WRITE_ONE, 0, 100, ++number, 1}, .length = 6};
    struct wire_frame mode = {.bytes = {1, MODBUS_WRITE, 0, 100, 0, 8, 16, ++number, 2, 0, 0}, .length = 11};
    wire_word(&mode, (uint32_t)len_um >> 16U);
    wire_word(&mode, (uint32_t)len_um & 0xFFFFU);
    wire_word(&mode, ACCEL);
    wire_word(&mode, 1);
    wire_word(&mode, FEED >> 16U);
    wire_word(&mode, 0);
    set(101, 0);
    TEST_ASSERT_EQUAL_UINT(0, wire_ask(&init));
    TEST_ASSERT_EQUAL_UINT(0, wire_ask(&mode));
    return machine.now;
}

static void learn_move(int32_t sign)
{
    uint64_t start = move(sign * PULSES * STEP_UM);
    rig_run_ms(2000);
    TEST_ASSERT_EQUAL_UINT(PULSES, rig_pulses[0]);
    for (unsigned i = 0; i < (unsigned)PULSES; i++) {
        due[i] = rig_tick[0][i] - start;
    }
}

static unsigned least(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

/* After an edge it brakes from the first pulse on that is far enough ahead to be taken back: as many pulses as it took
 * to be so fast, or as are left. */
static unsigned stop_pulses_max(uint64_t edge_ticks)
{
    unsigned from = 1;
    while (from <= (unsigned)PULSES && due[from - 1U] <= edge_ticks + (uint64_t)LEAD_TICKS) {
        from++;
    }
    return least(from + least(from, CRUISE_PULSES) + 1U, PULSES);
}

static void assert_fault(unsigned error)
{
    TEST_ASSERT_EQUAL_HEX(0x0005, rig_status(1) & 0xFDFFU);
    TEST_ASSERT_EQUAL_UINT16(error, rig_values(1).error);
    TEST_ASSERT_EQUAL_INT64(rig_position[0], rig_values(1).position_steps);
    TEST_ASSERT_EQUAL_INT32((int32_t)rig_position[0] * STEP_UM, rig_values(1).position_um);
}

/* From where it stands, a measure back arrives to the step. */
static void assert_goes_back(int32_t sign)
{
    int64_t stand = rig_position[0];
    host_machine_set_input(&machine, 1, false);
    (void)move(-sign * 50 * STEP_UM);
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_HEX(0x0803, rig_status(1) & 0xFDFFU);
    TEST_ASSERT_EQUAL_INT64(stand - sign * 50, rig_position[0]);
}

static void hit_limit(unsigned pulse, int32_t sign, uint64_t later_ticks)
{
    begin();
    set(sign > 0 ? LIMIT_PLUS : LIMIT_MINUS, 1);
    uint64_t start = move(sign * PULSES * STEP_UM);
    edge = (struct host_input){.tick = start + due[pulse - 1U] + later_ticks, .input = 1, .level = true};
    host_machine_set_script(&machine, &edge, 1);
    rig_run_ms(2000);
    if (rig_status(1) != 0x0803 && rig_status(1) != 0x0A03) {
        assert_fault(POS_ERROR_LIMIT);
    } else {
        TEST_ASSERT_EQUAL_UINT(PULSES, pulse); /* it stood already */
    }
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(pulse, rig_pulses[0]);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(stop_pulses_max(due[pulse - 1U] + later_ticks), rig_pulses[0]);
    assert_goes_back(sign);
}

void test_a_limit_that_is_hit_at_any_pulse_stops_down_the_ramp(void)
{
    for (int32_t sign = -1; sign <= 1; sign += 2) {
        begin();
        learn_move(sign);
        for (unsigned pulse = 1; pulse <= (unsigned)PULSES; pulse++) {
            hit_limit(pulse, sign, 0);
            hit_limit(pulse, sign, 1);
            hit_limit(pulse, sign, 500U * TICKS_PER_US);
        }
    }
}

void test_a_limit_in_the_other_direction_disturbs_no_pulse(void)
{
    learn_move(1);
    for (unsigned pulse = 1; pulse <= (unsigned)PULSES; pulse += 7) {
        begin();
        set(LIMIT_MINUS, 1);
        uint64_t start = move(PULSES * STEP_UM);
        edge = (struct host_input){.tick = start + due[pulse - 1U], .input = 1, .level = true};
        host_machine_set_script(&machine, &edge, 1);
        rig_run_ms(2000);
        TEST_ASSERT_EQUAL_HEX(0x0803, rig_status(1));
        for (unsigned i = 0; i < (unsigned)PULSES; i++) {
            TEST_ASSERT_EQUAL_UINT64(due[i], rig_tick[0][i] - start);
        }
    }
}

static void set_limits(int32_t min_um, int32_t max_um)
{
    struct wire_frame frame = {.bytes = {1, MODBUS_WRITE, 0, SOFT_MIN, 0, 4, 8}, .length = 7};
    wire_word(&frame, (uint32_t)min_um >> 16U);
    wire_word(&frame, (uint32_t)min_um & 0xFFFFU);
    wire_word(&frame, (uint32_t)max_um >> 16U);
    wire_word(&frame, (uint32_t)max_um & 0xFFFFU);
    TEST_ASSERT_EQUAL_UINT(0, wire_ask(&frame));
}

/* At every micrometre: positions are rounded to 10 um, and the last step inside is the last. */
void test_a_software_limit_at_any_place_of_a_move_is_never_passed(void)
{
    for (int32_t sign = -1; sign <= 1; sign += 2) {
        for (int32_t limit_um = 0; limit_um <= PULSES * STEP_UM + 12; limit_um += 3) {
            begin();
            set_limits(sign > 0 ? -5 : -limit_um, sign > 0 ? limit_um : 5);
            TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
            TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 37, 0, 0, 1));
            rig_run_ms(2);
            (void)move(sign * PULSES * STEP_UM);
            rig_run_ms(2000);
            int64_t inside = limit_um / STEP_UM < PULSES ? limit_um / STEP_UM : PULSES;
            TEST_ASSERT_EQUAL_INT64(sign * inside, rig_position[0]);
            if (inside < PULSES) {
                assert_fault(POS_ERROR_SOFT);
            } else {
                TEST_ASSERT_EQUAL_HEX(0x0803, rig_status(1) & 0xFDFFU);
            }
        }
    }
}

/* ---- the bus --------------------------------------------------------------------------------------------------- */

static void assert_silent(uint64_t last_tick)
{
    uint64_t patience = (uint64_t)PATIENCE_MS * TICKS_PER_MS;
    rig_run_ticks(last_tick + patience - machine.now - 1U);
    TEST_ASSERT_EQUAL_UINT16(0, rig_values(1).error);
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_SILENT, rig_values(1).error);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_SILENT, rig_values(2).error);
    TEST_ASSERT_EQUAL_UINT16(0, rig_values(3).error);
    rig_run_ms(2000);
    assert_fault(POS_ERROR_SILENT);
}

/* The last good frame to this unit ends so long after the move began. Axis 2 waits for its feed, axis 3 is free. */
void test_a_bus_that_falls_silent_at_any_time_of_a_move_stops_it(void)
{
    for (unsigned ms = 0; ms < 60; ms++) {
        begin();
        set(WATCHDOG, PATIENCE_MS);
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 2, 0));
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 1000, ACCEL, 2));
        (void)move(100 * PULSES * STEP_UM);
        rig_run_ticks((uint64_t)ms * TICKS_PER_MS / 2U);
        TEST_ASSERT_EQUAL_UINT(0, wire_read(MODBUS_READ, 0, 1));
        assert_silent(wire_tick);
        TEST_ASSERT_EQUAL_UINT32(1, unit.silences);
        TEST_ASSERT_EQUAL_UINT(0, rig_pulses[1]);
    }
}

/* Of all frames only those count that are good and for this unit; a refused request does. */
void test_what_others_say_does_not_keep_the_watchdog_quiet(void)
{
    static const char *const frames[] = {"00 06 00 64 00 00", "02 03 00 00 00 01", "01 03 00 00 00 01"};
    for (unsigned i = 0; i < 3; i++) {
        begin();
        set(WATCHDOG, PATIENCE_MS);
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 2, 0));
        (void)move(100 * PULSES * STEP_UM);
        struct wire_frame refused = {.bytes = {1, 1}, .length = 2};
        TEST_ASSERT_EQUAL_UINT(1, wire_ask(&refused));
        uint64_t last = wire_tick;
        struct wire_frame other = wire_sealed(frames[i]);
        other.bytes[5] ^= i == 2 ? 1U : 0U; /* for this unit, but damaged */
        for (unsigned n = 0; n < 5; n++) {
            wire_send(&other);
            TEST_ASSERT_EQUAL_UINT32(0, rig_heard_count);
        }
        assert_silent(last);
    }
}

void test_after_the_watchdog_nothing_moves_before_pos_init(void)
{
    set(WATCHDOG, PATIENCE_MS);
    (void)move(100 * PULSES * STEP_UM);
    rig_run_ms(500);
    int64_t stand = rig_position[0];
    struct wire_frame control = {.bytes = {1, MODBUS_WRITE, 0, 105, 0, 3, 6, 0, 1, 3, 0xE8, 0, 0}, .length = 13};
    struct wire_frame mode = {.bytes = {1, MODBUS_WRITE, 0, 100, 0, 5, 10, 0x77, 2, 0, 0, 0, 0, 3, 0xE8, 0, 100},
                              .length = 17};
    TEST_ASSERT_EQUAL_UINT(0, wire_ask(&control));
    TEST_ASSERT_EQUAL_UINT(0, wire_ask(&mode));
    TEST_ASSERT_EQUAL_UINT(0, wire_ask(&control));
    TEST_ASSERT_EQUAL_UINT(POS_ERROR_FAULT, unit.registers.axes[0][POS_AXIS_RESULT]);
    rig_run_ms(500);
    TEST_ASSERT_EQUAL_INT64(stand, rig_position[0]);
    (void)move(50 * STEP_UM);
    for (unsigned i = 0; i < 50; i++) {
        TEST_ASSERT_EQUAL_UINT(0, wire_ask(&control));
        rig_run_ms(10);
    }
    TEST_ASSERT_EQUAL_INT64(stand + 50, rig_position[0]);
}

/* ---- repeats --------------------------------------------------------------------------------------------------- */

/* As fast as the line allows, in motion and after it: one measure, and not a pulse out of its place. */
void test_the_same_request_a_thousand_times_is_executed_once(void)
{
    uint64_t start = move(100 * PULSES * STEP_UM);
    rig_run_ms(8000);
    TEST_ASSERT_EQUAL_UINT(100 * PULSES, rig_pulses[0]);
    static uint64_t alone[100 * PULSES];
    for (unsigned i = 0; i < 100U * PULSES; i++) {
        alone[i] = rig_tick[0][i] - start;
    }
    begin();
    start = move(100 * PULSES * STEP_UM);
    const struct wire_frame again = {.bytes = {0}, .length = wire_length};
    struct wire_frame frame = again;
    for (uint32_t i = 0; i < wire_length; i++) {
        frame.bytes[i] = wire_script[i].value;
    }
    for (unsigned n = 0; n < 1000; n++) {
        wire_send(&frame);
        TEST_ASSERT_EQUAL_UINT32(8, rig_heard_count);
        rig_run_ms(n % 7U);
    }
    rig_run_ms(2000);
    TEST_ASSERT_EQUAL_UINT(100 * PULSES, rig_pulses[0]);
    for (unsigned i = 0; i < 100U * PULSES; i++) {
        TEST_ASSERT_EQUAL_UINT64(alone[i], rig_tick[0][i] - start);
    }
    TEST_ASSERT_EQUAL_HEX(0x0803, rig_status(1));
    TEST_ASSERT_EQUAL_UINT32(0, unit.server.counts[MODBUS_COUNT_EXCEPTIONS]);
}

/* ---- power ----------------------------------------------------------------------------------------------------- */

/* What a PLC still repeats after it moves nothing, as the axis is not taken. */
void test_power_that_goes_at_any_pulse_leaves_nothing_that_moves(void)
{
    learn_move(1);
    for (unsigned pulse = 1; pulse <= (unsigned)PULSES; pulse++) {
        begin();
        uint64_t start = move(PULSES * STEP_UM);
        rig_run_ticks(start + due[pulse - 1U] + 1U - machine.now);
        TEST_ASSERT_EQUAL_UINT(pulse, rig_pulses[0]);
        struct wire_frame frame = {.length = wire_length};
        for (uint32_t i = 0; i < wire_length; i++) {
            frame.bytes[i] = wire_script[i].value;
        }
        host_machine_restart(&machine);
        rig_begin();
        rig_run_ms(20);
        for (unsigned n = 0; n < 3; n++) {
            wire_send(&frame);
            TEST_ASSERT_EQUAL_UINT32(8, rig_heard_count);
            rig_run_ms(50);
        }
        TEST_ASSERT_EQUAL_UINT(pulse, rig_pulses[0]);
        TEST_ASSERT_EQUAL_HEX(ERR_ONLY, rig_status(1));
        TEST_ASSERT_EQUAL_INT32(0, rig_values(1).position_um);
    }
}
