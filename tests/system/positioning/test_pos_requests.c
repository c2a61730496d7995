/*
 * Whole frames whose request is wrong: registers that are not there, half values, wrong numbers and lengths, every
 * value at its limits and one past. Each gets its exception, and nothing changes. What is there is told by a list made
 * from the table, not by the code that serves it.
 */
#include "pos_wire.h"

enum {
    NUMBERS = 1024,
    READABLE = 1,
    WRITABLE = 2,
    WIDE_HIGH = 4,
    WIDE_LOW = 8,
    ALONE = 16, /* the upper word of FEED */
    VALUE = MODBUS_EXCEPTION_VALUE,
    ADDRESS = MODBUS_EXCEPTION_ADDRESS,
};

static uint8_t map[NUMBERS];

static void map_row(uint32_t number, const struct pos_row *row)
{
    uint8_t flags = (uint8_t)(READABLE | (row->use != (uint8_t)POS_USE_READ ? WRITABLE : 0));
    if (row->type == (uint8_t)POS_TYPE_U32 || row->type == (uint8_t)POS_TYPE_I32) {
        bool feed = row->use == (uint8_t)POS_USE_MOTION;
        map[number] = (uint8_t)(flags | WIDE_HIGH | (feed ? ALONE : 0));
        map[number + 1U] = (uint8_t)(flags | WIDE_LOW);
    } else {
        map[number] = flags;
    }
}

static const struct pos_row *row_of(unsigned axis, unsigned index)
{
    const struct pos_place place = {.axis = (uint8_t)axis, .index = (uint8_t)index};
    return pos_row(&place);
}

static void map_image(uint32_t number, uint32_t words, uint32_t from, uint32_t skip)
{
    for (uint32_t axis = 0; axis < (uint32_t)POS_AXES; axis++) {
        for (uint32_t i = 0; i < words; i++) {
            uint32_t source = 100U * (axis + 1U) + from + i + (i >= 2U ? skip : 0U);
            map[number + axis * words + i] = map[source];
        }
    }
}

static void make_map(void)
{
    memset(map, 0, sizeof map);
    for (unsigned i = 0; i < (unsigned)POS_UNIT_REGISTERS; i++) {
        map_row(row_of(0, i)->number, row_of(0, i));
    }
    for (unsigned axis = 1; axis <= (unsigned)POS_AXES; axis++) {
        for (unsigned i = 0; i < (unsigned)POS_AXIS_REGISTERS; i++) {
            map_row(100U * axis + row_of(axis, i)->number, row_of(axis, i));
        }
    }
    map_image(500, 3, 5, 0);
    map_image(520, 4, 10, 4); /* STATUS, ERROR, POSITION */
    map_image(600, 8, 0, 0);
    map_image(640, 8, 10, 0);
}

void setUp(void)
{
    rig_set_up();
    rig_run_ms(10);
    make_map();
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 2, 0)); /* so there are settings that are not to be written */
    rig_run_ms(10);
    wire_keep();
}

void tearDown(void)
{
}

static uint8_t flags_of(uint32_t number)
{
    return number < (uint32_t)NUMBERS ? map[number] : 0;
}

/* Whether a range is there, whole, with these flags. */
static bool is_there(uint32_t first, uint32_t count, uint8_t flags)
{
    bool there = (flags_of(first) & WIDE_LOW) == 0;
    uint8_t last = flags_of(first + count - 1U);
    for (uint32_t i = 0; i < count; i++) {
        there = there && (flags_of(first + i) & flags) == flags;
    }
    return there && ((last & WIDE_HIGH) == 0 || (last & ALONE) != 0);
}

/* Whether none of it can be written. */
static bool is_input(uint32_t first, uint32_t count)
{
    bool input = is_there(first, count, READABLE);
    for (uint32_t i = 0; i < count; i++) {
        input = input && (flags_of(first + i) & WRITABLE) == 0;
    }
    return input;
}

static void assert_reads(uint32_t first, uint32_t count)
{
    unsigned wanted = is_there(first, count, READABLE) ? 0 : ADDRESS;
    TEST_ASSERT_EQUAL_UINT_MESSAGE(wanted, wire_read(MODBUS_READ, first, count), "3");
    wanted = is_input(first, count) ? 0 : ADDRESS;
    TEST_ASSERT_EQUAL_UINT_MESSAGE(wanted, wire_read(MODBUS_READ_INPUTS, first, count), "4");
}

void test_what_is_not_there_cannot_be_read_nor_half_of_it(void)
{
    for (uint32_t first = 0; first < (uint32_t)NUMBERS; first++) {
        for (uint32_t count = 1; count <= 9; count++) {
            assert_reads(first, count);
        }
    }
    for (uint32_t trial = 0; trial < 3000; trial++) {
        uint32_t first = (uint32_t)(epoch_chance() % 0x10000U);
        assert_reads(trial % 2U == 0 ? first : first % (uint32_t)NUMBERS, (uint32_t)(epoch_chance() % 125U) + 1U);
    }
    assert_reads(0xFFFF, 1);
    assert_reads(0xFFFF, 2);
    assert_reads(0xFF83, 125);
    wire_assert_same();
}

/* With a value that would be taken where it is there; an exception 6 is one that has been found to be there. */
static void assert_writes(uint32_t first, uint32_t count)
{
    struct wire_frame frame = {.bytes = {1, MODBUS_WRITE}, .length = 2};
    wire_word(&frame, first);
    wire_word(&frame, count);
    frame.bytes[frame.length++] = (uint8_t)(count * 2U);
    for (uint32_t i = 0; i < count; i++) {
        wire_word(&frame, 0x7777); /* no code, no switch, no rate: of what is there, 3 */
    }
    unsigned exception = wire_ask(&frame);
    if (!is_there(first, count, WRITABLE)) {
        TEST_ASSERT_EQUAL_UINT(ADDRESS, exception);
    } else {
        TEST_ASSERT_NOT_EQUAL(ADDRESS, exception);
    }
}

void test_what_is_not_there_or_only_read_cannot_be_written_nor_half_of_it(void)
{
    for (uint32_t first = 0; first < (uint32_t)NUMBERS; first++) {
        bool wrong = !is_there(first, 1, WRITABLE);
        struct wire_frame one = {.bytes = {1, MODBUS_WRITE_ONE}, .length = 2};
        wire_word(&one, first);
        wire_word(&one, 0x7777);
        TEST_ASSERT_EQUAL_INT(wrong, wire_ask(&one) == ADDRESS);
        for (uint32_t count = 1; count <= 9; count++) {
            assert_writes(first, count);
        }
    }
    assert_writes(0xFFFF, 1);
    assert_writes(0xFFFF, 2);
}

void test_where_the_read_of_a_request_is_wrong_nothing_is_written(void)
{
    struct wire_frame frame = {.bytes = {1, MODBUS_WRITE_AND_READ}, .length = 2};
    static const uint16_t words[] = {108, 1, 100, 8, 0x1002, 0x0101, 6, 0, 1000, 500, 1, 1000, 0};
    for (unsigned i = 0; i < 4; i++) {
        wire_word(&frame, words[i]);
    }
    frame.bytes[frame.length++] = 16;
    for (unsigned i = 5; i < 13; i++) {
        wire_word(&frame, words[i]);
    }
    TEST_ASSERT_EQUAL_UINT(ADDRESS, wire_ask(&frame));
    wire_assert_same();
}

/* ---- values ---------------------------------------------------------------------------------------------------- */

static void assert_value(unsigned axis, unsigned index, uint32_t value, bool good)
{
    char message[80];
    const struct pos_row *row = row_of(axis, index);
    bool wide = row->type >= (uint8_t)POS_TYPE_U32;
    uint32_t number = row->number + 100U * axis;
    (void)snprintf(message, sizeof message, "register %u, value %X", (unsigned)number, (unsigned)value);
    wire_keep();
    unsigned exception = wire_write(wide ? MODBUS_WRITE : MODBUS_WRITE_ONE, number, value, wide);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(good ? 0 : VALUE, exception, message);
    if (!good) {
        wire_assert_same();
    } else if (row->use != (uint8_t)POS_USE_STORE && row->use != (uint8_t)POS_USE_MOTION) {
        TEST_ASSERT_EQUAL_UINT(0, wire_read(MODBUS_READ, number, wide ? 2 : 1));
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(value, wide ? rig_word(0) << 16U | rig_word(1) : rig_word(0), message);
    }
}

/* The factors are looked at as a pair below. */
static void assert_limits(unsigned axis, unsigned index)
{
    const struct pos_row *row = row_of(axis, index);
    bool wide = row->type >= (uint8_t)POS_TYPE_U32;
    bool is_signed = row->type == (uint8_t)POS_TYPE_I16 || row->type == (uint8_t)POS_TYPE_I32;
    uint32_t mask = wide ? UINT32_MAX : 0xFFFFU;
    uint32_t min = (uint32_t)row->min & mask;
    if (row->form == (uint8_t)POS_FORM_ANY) {
        assert_value(axis, index, 0, true);
        assert_value(axis, index, mask, true);
        assert_value(axis, index, (mask >> 1U) + 1U, true);
        return;
    }
    if (row->form == (uint8_t)POS_FORM_RANGE || row->form == (uint8_t)POS_FORM_ZERO_OR) {
        assert_value(axis, index, min, true);
        assert_value(axis, index, row->max, true);
        if (is_signed || row->min > 0) {
            assert_value(axis, index, (min - 1U) & mask, false);
        }
        if (row->max < mask) {
            assert_value(axis, index, row->max + 1U, false);
            assert_value(axis, index, is_signed ? (mask >> 1U) + 1U : mask, false);
        }
    }
    if (row->form == (uint8_t)POS_FORM_ZERO_OR) {
        assert_value(axis, index, 0, true);
        assert_value(axis, index, 1, false);
    }
}

void test_every_value_is_taken_up_to_its_limits_and_refused_one_past(void)
{
    static const unsigned axes[] = {0, 1, 3};
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 2));
    for (unsigned a = 0; a < sizeof axes / sizeof axes[0]; a++) {
        unsigned count = axes[a] == 0 ? (unsigned)POS_UNIT_REGISTERS : (unsigned)POS_AXIS_REGISTERS;
        for (unsigned i = 0; i < count; i++) {
            if (row_of(axes[a], i)->use != (uint8_t)POS_USE_READ) {
                assert_limits(axes[a], i);
            }
        }
    }
}

void test_the_rates_are_five_and_no_others(void)
{
    static const uint16_t rates[] = {96, 192, 384, 576, 1152};
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 2));
    for (unsigned i = 0; i < 5; i++) {
        assert_value(0, POS_UNIT_RATE, rates[i], true);
        assert_value(0, POS_UNIT_RATE, rates[i] - 1U, false);
        assert_value(0, POS_UNIT_RATE, rates[i] + 1U, false);
    }
    assert_value(0, POS_UNIT_RATE, 0, false);
    assert_value(0, POS_UNIT_RATE, 0xFFFF, false);
}

void test_every_code_above_6_and_every_bit_of_control_above_3_is_refused(void)
{
    for (uint32_t code = 0; code < 256; code++) {
        assert_value(1, POS_AXIS_INSTRUCTION, 0x4200U + code, code <= 6);
    }
    for (unsigned bit = 0; bit < 16; bit++) {
        assert_value(1, POS_AXIS_CONTROL, 1U << bit, bit < 4);
    }
}

static unsigned write_scale(uint32_t steps, uint32_t micrometres)
{
    struct wire_frame frame = {.bytes = {1, MODBUS_WRITE}, .length = 2};
    wire_word(&frame, 130);
    wire_word(&frame, 4);
    frame.bytes[frame.length++] = 8;
    wire_word(&frame, steps >> 16U);
    wire_word(&frame, steps & 0xFFFFU);
    wire_word(&frame, micrometres >> 16U);
    wire_word(&frame, micrometres & 0xFFFFU);
    wire_keep();
    return wire_ask(&frame);
}

void test_the_scale_is_taken_up_to_its_limits_and_refused_one_past(void)
{
    static const uint32_t good[][2] = {{1, 10000},           {500, 1}, {INT32_MAX, INT32_MAX}, {214748, 2147480000},
                                       {INT32_MAX, 4294968}, {1, 1}};
    static const uint32_t bad[][2] = {{1, 10001},
                                      {501, 1},
                                      {0, 1},
                                      {1, 0},
                                      {0, 0},
                                      {UINT32_C(0x80000000), INT32_MAX},
                                      {INT32_MAX, UINT32_C(0x80000000)},
                                      {214748, 2147480001},
                                      {INT32_MAX, 4294967},
                                      {UINT32_MAX, UINT32_MAX}};
    for (unsigned i = 0; i < sizeof good / sizeof good[0]; i++) {
        TEST_ASSERT_EQUAL_UINT(0, write_scale(good[i][0], good[i][1]));
        TEST_ASSERT_EQUAL_UINT32(good[i][0], unit.registers.axes[0][POS_AXIS_STEPS]);
        TEST_ASSERT_EQUAL_UINT32(good[i][1], unit.registers.axes[0][POS_AXIS_MICROMETRES]);
    }
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_EQUAL_UINT(VALUE, write_scale(bad[i][0], bad[i][1]));
        wire_assert_same();
    }
}

/* One wrong value, at any place of a write of all four axes. */
void test_one_wrong_value_among_many_changes_nothing(void)
{
    for (unsigned wrong = 0; wrong < 4; wrong++) {
        for (unsigned which = 0; which < 2; which++) {
            struct wire_frame frame = {.bytes = {1, MODBUS_WRITE, 0x02, 0x58, 0, 32, 64}, .length = 7};
            for (unsigned axis = 0; axis < 4; axis++) {
                wire_word(&frame, axis == wrong && which == 0 ? 0x1107 : 0x1101);
                for (unsigned i = 1; i < 8; i++) {
                    wire_word(&frame, i == 5 ? (axis == wrong && which == 1 ? 0x0010 : 1) : 2);
                }
            }
            wire_keep();
            TEST_ASSERT_EQUAL_UINT(VALUE, wire_ask(&frame));
            wire_assert_same();
        }
    }
}

/* ---- forms ----------------------------------------------------------------------------------------------------- */

/* Exception 3 for a known function, 1 for another one; broadcasts get none. */
static void assert_form_refused(const struct wire_frame *request)
{
    struct wire_frame frame = *request;
    uint8_t function = frame.bytes[1];
    bool known = function == 3 || function == 4 || function == 6 || function == 16 || function == 23;
    bool identify = function == 43;
    bool type = identify && (frame.length < 3 || frame.bytes[2] == 14);
    wire_keep();
    if (frame.bytes[0] == 0) {
        wire_seal(&frame);
        wire_send(&frame);
        TEST_ASSERT_EQUAL_UINT32(0, rig_heard_count);
        TEST_ASSERT_EQUAL_UINT32(1, wire_counted(MODBUS_COUNT_EXCEPTIONS));
    } else {
        TEST_ASSERT_EQUAL_UINT(known || type ? 3 : 1, wire_ask(&frame));
    }
    wire_assert_same();
}

void test_a_request_of_another_length_is_refused(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        struct wire_frame whole;
        memset(whole.bytes, 0, sizeof whole.bytes);
        whole.length = rig_bytes_of(modbus_corpus[i], whole.bytes);
        struct wire_frame frame = whole;
        for (frame.length = 2; frame.length < 254; frame.length++) {
            if (frame.length != whole.length) {
                assert_form_refused(&frame);
            }
        }
    }
}

void test_a_byte_count_that_does_not_suit_is_refused(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_CORPUS; i++) {
        struct wire_frame frame;
        frame.length = rig_bytes_of(modbus_corpus[i], frame.bytes);
        unsigned place = frame.bytes[1] == 16 ? 6 : frame.bytes[1] == 23 ? 10 : 0;
        uint8_t right = frame.bytes[place];
        for (unsigned count = 0; place != 0 && count < 256; count++) {
            frame.bytes[place] = (uint8_t)count;
            if (count != right) {
                assert_form_refused(&frame);
            }
        }
    }
}

void test_a_number_of_registers_that_is_0_or_too_large_is_refused(void)
{
    static const uint32_t counts[] = {0, 126, 127, 255, 256, 257, 0x100 + 8, 0x7FFF, 0x8000, 0xFFFF};
    for (unsigned i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        TEST_ASSERT_EQUAL_UINT(VALUE, wire_read(MODBUS_READ, 0, counts[i]));
        TEST_ASSERT_EQUAL_UINT(VALUE, wire_read(MODBUS_READ_INPUTS, 0xFFFF, counts[i]));
    }
    TEST_ASSERT_EQUAL_UINT(ADDRESS, wire_read(MODBUS_READ, 0xFFFF, 125));
    wire_assert_same();
}

void test_every_function_that_is_not_known_is_refused_with_1(void)
{
    for (unsigned function = 0; function < 128; function++) {
        struct wire_frame frame = {.bytes = {1, (uint8_t)function, 0, 100, 1, 1}, .length = 6};
        bool known = function == 3 || function == 4 || function == 6 || function == 16 || function == 23;
        if (!known) {
            TEST_ASSERT_EQUAL_UINT(1, wire_ask(&frame));
        }
    }
    wire_assert_same();
}
