#include "program_listing.h"
#include "program_parser.h"
#include "unity.h"

#include <stdbool.h>
#include <string.h>

/* An instruction and its text, room for a terminator included. */
static uint8_t text[PROGRAM_COMMAND_BYTES_MAX + 1];
static uint32_t length;

void setUp(void)
{
    memset(text, 0, sizeof text);
    length = 0;
}

void tearDown(void)
{
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(PROGRAM_COMMAND_BYTES_MAX, length);
}

static void list(uint8_t opcode, int32_t value, uint8_t io)
{
    struct program_instruction instruction = {.value = value, .opcode = opcode, .io = io};
    memset(text, 0, sizeof text);
    length = program_list_instruction(&instruction, text);
}

static void assert_listed(const char *expected, uint8_t opcode, int32_t value, uint8_t io)
{
    list(opcode, value, io);
    TEST_ASSERT_EQUAL_STRING(expected, (const char *)text);
    TEST_ASSERT_EQUAL_UINT32(strlen(expected), length);
}

void test_commands_without_a_number_are_their_letter(void)
{
    assert_listed("\\", PROGRAM_RESET, 0, 0);
    assert_listed("D", PROGRAM_REVERSE, 0, 0);
    assert_listed("E", PROGRAM_LOOP_END, 0, 0);
    assert_listed("H", PROGRAM_GO_HOME, 0, 0);
    assert_listed("K", PROGRAM_HALT, 0, 0);
    assert_listed("R", PROGRAM_MOVE, 0, 0);
    assert_listed("U", PROGRAM_GUARDS_OFF, 0, 0);
    assert_listed("Y", PROGRAM_APPEND_SECTION, 0, 0);
    assert_listed(".", PROGRAM_RETURN, 0, 0);
    assert_listed("[", PROGRAM_HOLD, 0, 0);
    assert_listed("]", PROGRAM_RELEASE, 0, 0);
}

void test_numbers_are_plain(void)
{
    assert_listed("@1", PROGRAM_LABEL, 1, 0);
    assert_listed("J80", PROGRAM_JUMP, 80, 0);
    assert_listed("L3", PROGRAM_LOOP, 3, 0);
    assert_listed("S9", PROGRAM_START_SPEED, 9, 0);
    assert_listed("F16000000", PROGRAM_STEPS_FORWARD, 16000000, 0);
    assert_listed("W100", PROGRAM_WAIT, 100, 0);
    assert_listed("G2000000000", PROGRAM_GO_TO, 2000000000, 0);
}

void test_numbers_of_inputs_outputs_and_variables_have_two_digits(void)
{
    assert_listed("M05", PROGRAM_GUARD_HIGH, 5, 0);
    assert_listed("N08", PROGRAM_GUARD_LOW, 8, 0);
    assert_listed("O01", PROGRAM_WAIT_INPUT_HIGH, 1, 0);
    assert_listed("O81", PROGRAM_WAIT_VARIABLE_HIGH, 81, 0);
    assert_listed("Z95", PROGRAM_WAIT_VARIABLE_LOW, 95, 0);
    assert_listed("T02", PROGRAM_SET_OUTPUT, 2, 0);
    assert_listed("T40", PROGRAM_FUNCTION_ON, 40, 0);
    assert_listed("C08", PROGRAM_CLEAR_OUTPUT, 8, 0);
    assert_listed("X04", PROGRAM_TOTAL_STOP, 4, 0);
    assert_listed(")05", PROGRAM_LIMIT_FORWARD, 5, 0);
    assert_listed("(05", PROGRAM_LIMIT_BACKWARD, 5, 0);
}

void test_longer_io_numbers_keep_their_digits(void)
{
    assert_listed("C100", PROGRAM_ZERO_POSITION, 100, 0);
}

void test_conditional_jumps_have_two_digits_for_the_input_only(void)
{
    assert_listed("I05H10", PROGRAM_JUMP_IF_HIGH, 10, 5);
    assert_listed("I81L6", PROGRAM_JUMP_IF_LOW, 6, 81);
    assert_listed("I95H80", PROGRAM_JUMP_IF_HIGH, 80, 95);
}

void test_runs_without_end_are_a_sign(void)
{
    assert_listed("G+", PROGRAM_RUN_FORWARD, 0, 0);
    assert_listed("G-", PROGRAM_RUN_BACKWARD, 0, 0);
}

void test_positions_may_be_negative(void)
{
    assert_listed("=2000000000", PROGRAM_SET_POSITION, 2000000000, 0);
    assert_listed("=0", PROGRAM_SET_POSITION, 0, 0);
    assert_listed("=-1", PROGRAM_SET_POSITION, -1, 0);
}

void test_the_longest_command_fills_the_text(void)
{
    assert_listed("=-2000000000", PROGRAM_SET_POSITION, -2000000000, 0);
    TEST_ASSERT_EQUAL_UINT32(PROGRAM_COMMAND_BYTES_MAX, length);
}

void test_a_call_is_listed_with_an_apostrophe(void)
{
    assert_listed("\x27"
                  "3",
                  PROGRAM_CALL, 3, 0);
}

static void assert_same_when_read_again(uint8_t opcode, int32_t value, uint8_t io)
{
    struct program_parser parser;
    struct program_instruction read = {.value = -1};
    uint8_t first[PROGRAM_COMMAND_BYTES_MAX + 1];

    list(opcode, value, io);
    memcpy(first, text, sizeof first);
    program_parser_init(&parser, first, length);
    TEST_ASSERT_EQUAL_MESSAGE(PROGRAM_OK, program_parser_next(&parser, &read), (const char *)first);
    TEST_ASSERT_EQUAL_STRING(program_opcode_name(opcode), program_opcode_name(read.opcode));
    TEST_ASSERT_EQUAL_INT32(value, read.value);
    TEST_ASSERT_EQUAL_UINT8(io, read.io);
    TEST_ASSERT_EQUAL_UINT32(length, parser.next);

    list(read.opcode, read.value, read.io);
    TEST_ASSERT_EQUAL_STRING((const char *)first, (const char *)text);
}

void test_what_is_listed_reads_as_the_same_instruction_for_every_opcode(void)
{
    for (unsigned opcode = 0; opcode < PROGRAM_OPCODES; opcode++) {
        const struct program_row *row = program_opcode_row(opcode);
        bool condition = row->form == PROGRAM_FORM_HIGH || row->form == PROGRAM_FORM_LOW;
        int32_t middle = (int32_t)(((int64_t)row->min + row->max) / 2);
        assert_same_when_read_again((uint8_t)opcode, row->min, condition ? 1 : 0);
        assert_same_when_read_again((uint8_t)opcode, middle, condition ? 80 : 0);
        assert_same_when_read_again((uint8_t)opcode, row->max, condition ? 95 : 0);
    }
}
