#include "program_instruction.h"
#include "program_parser.h"
#include "unity.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "exact_text.h"

#define LENGTH(array) (sizeof(array) / sizeof(array)[0])

static struct exact_text text;

void setUp(void)
{
}

void tearDown(void)
{
    exact_text_free(&text);
}

struct range {
    char letter;
    int64_t min;
    int64_t max;
    enum program_opcode opcode;
};

/* Section 4 of the language, row by row. */
static const struct range ranges[] = {
    {'@', 1, 80, PROGRAM_LABEL},
    {'A', 1, 60000, PROGRAM_ACCELERATION},
    {'B', 1, 16000000, PROGRAM_STEPS_BACKWARD},
    {'C', 1, 8, PROGRAM_CLEAR_OUTPUT},
    {'C', 40, 58, PROGRAM_FUNCTION_OFF},
    {'C', 75, 75, PROGRAM_RESUME},
    {'C', 80, 95, PROGRAM_CLEAR_VARIABLE},
    {'C', 100, 100, PROGRAM_ZERO_POSITION},
    {'F', 1, 16000000, PROGRAM_STEPS_FORWARD},
    {'G', 1, 2000000000, PROGRAM_GO_TO},
    {'J', 1, 80, PROGRAM_JUMP},
    {'L', 1, 255, PROGRAM_LOOP},
    {'M', 1, 8, PROGRAM_GUARD_HIGH},
    {'N', 1, 8, PROGRAM_GUARD_LOW},
    {'O', 1, 8, PROGRAM_WAIT_INPUT_HIGH},
    {'O', 80, 95, PROGRAM_WAIT_VARIABLE_HIGH},
    {'S', 1, 2000, PROGRAM_START_SPEED},
    {'T', 1, 8, PROGRAM_SET_OUTPUT},
    {'T', 40, 58, PROGRAM_FUNCTION_ON},
    {'T', 80, 95, PROGRAM_SET_VARIABLE},
    {'V', 1, 16000, PROGRAM_SPEED},
    {'W', 1, 16000000, PROGRAM_WAIT},
    {'X', 1, 8, PROGRAM_TOTAL_STOP},
    {'Z', 1, 8, PROGRAM_WAIT_INPUT_LOW},
    {'Z', 80, 95, PROGRAM_WAIT_VARIABLE_LOW},
    {')', 1, 8, PROGRAM_LIMIT_FORWARD},
    {'(', 1, 8, PROGRAM_LIMIT_BACKWARD},
    {'=', -2000000000, 2000000000, PROGRAM_SET_POSITION},
    {'\'', 1, 80, PROGRAM_CALL},
};

/* The opcode that this letter and number make; PROGRAM_OPCODES where they are none. */
static unsigned expected_opcode(char letter, int64_t number)
{
    for (unsigned i = 0; i < LENGTH(ranges); i++) {
        if (ranges[i].letter == letter && number >= ranges[i].min && number <= ranges[i].max) {
            return ranges[i].opcode;
        }
    }
    return PROGRAM_OPCODES;
}

static void assert_number_makes(char letter, int64_t number, unsigned opcode)
{
    char program[32];
    struct program_parser parser;
    struct program_instruction instruction = {.opcode = PROGRAM_OPCODES};
    (void)snprintf(program, sizeof program, "%c%" PRId64, letter, number);
    exact_text_take(&text, program, strlen(program));
    program_parser_init(&parser, text.bytes, text.length);

    enum program_status status = program_parser_next(&parser, &instruction);

    TEST_ASSERT_EQUAL_MESSAGE(opcode == PROGRAM_OPCODES ? PROGRAM_BAD_VALUE : PROGRAM_OK, status, program);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(opcode, instruction.opcode, program);
    TEST_ASSERT_EQUAL_INT64_MESSAGE(opcode == PROGRAM_OPCODES ? 0 : number, instruction.value, program);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(text.length, parser.next, program);
}

static void assert_number_is_judged(char letter, int64_t number)
{
    assert_number_makes(letter, number, expected_opcode(letter, number));
}

void test_every_range_ends_where_the_language_says(void)
{
    for (unsigned i = 0; i < LENGTH(ranges); i++) {
        for (int64_t step = -1; step <= 1; step++) {
            assert_number_is_judged(ranges[i].letter, ranges[i].min + step);
            assert_number_is_judged(ranges[i].letter, ranges[i].max + step);
        }
    }
}

void test_the_limits_of_one_command_are_not_those_of_another(void)
{
    for (unsigned i = 0; i < LENGTH(ranges); i++) {
        for (unsigned j = 0; j < LENGTH(ranges); j++) {
            assert_number_is_judged(ranges[i].letter, ranges[j].min);
            assert_number_is_judged(ranges[i].letter, ranges[j].max);
        }
    }
}

void test_small_numbers_are_judged_one_by_one(void)
{
    for (unsigned i = 0; i < LENGTH(ranges); i++) {
        for (int64_t number = 0; number <= 300; number++) {
            assert_number_is_judged(ranges[i].letter, number);
        }
    }
}

void test_only_the_position_may_be_negative(void)
{
    for (unsigned i = 0; i < LENGTH(ranges); i++) {
        assert_number_makes(ranges[i].letter, -1, ranges[i].letter == '=' ? PROGRAM_SET_POSITION : PROGRAM_OPCODES);
    }
}

void test_only_the_rows_of_the_language_have_numbers(void)
{
    for (unsigned opcode = 0; opcode < PROGRAM_OPCODES; opcode++) {
        const struct program_row *row = program_opcode_row(opcode);
        if (row->form == PROGRAM_FORM_NUMBER || row->form == PROGRAM_FORM_IO || row->form == PROGRAM_FORM_SIGNED) {
            TEST_ASSERT_EQUAL_UINT_MESSAGE(opcode, expected_opcode((char)row->letter, row->min), row->name);
            TEST_ASSERT_EQUAL_UINT_MESSAGE(opcode, expected_opcode((char)row->letter, row->max), row->name);
        }
    }
}
