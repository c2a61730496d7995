#include "program_instruction.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

void test_opcodes_have_the_names_of_the_table(void)
{
    TEST_ASSERT_EQUAL_STRING("RESET", program_opcode_name(PROGRAM_RESET));
    TEST_ASSERT_EQUAL_STRING("STEPS_FORWARD", program_opcode_name(PROGRAM_STEPS_FORWARD));
    TEST_ASSERT_EQUAL_STRING("RELEASE", program_opcode_name(PROGRAM_RELEASE));
}

void test_a_number_that_is_no_opcode_has_an_empty_name(void)
{
    TEST_ASSERT_EQUAL_STRING("RELEASE", program_opcode_name(PROGRAM_OPCODES - 1));
    TEST_ASSERT_EQUAL_STRING("", program_opcode_name(PROGRAM_OPCODES));
    TEST_ASSERT_EQUAL_STRING("", program_opcode_name(UINT8_MAX));
}

void test_a_row_tells_letter_form_and_range(void)
{
    const struct program_row *row = program_opcode_row(PROGRAM_SET_POSITION);
    TEST_ASSERT_EQUAL_HEX8('=', row->letter);
    TEST_ASSERT_EQUAL(PROGRAM_FORM_SIGNED, row->form);
    TEST_ASSERT_EQUAL_INT32(-2000000000, row->min);
    TEST_ASSERT_EQUAL_INT32(2000000000, row->max);
}

void test_the_opcodes_of_a_letter_are_found_one_after_the_other(void)
{
    TEST_ASSERT_EQUAL_UINT(PROGRAM_WAIT_INPUT_HIGH, program_opcode_find(0, 'O'));
    TEST_ASSERT_EQUAL_UINT(PROGRAM_WAIT_VARIABLE_HIGH, program_opcode_find(PROGRAM_WAIT_INPUT_HIGH + 1U, 'O'));
    TEST_ASSERT_EQUAL_UINT(PROGRAM_OPCODES, program_opcode_find(PROGRAM_WAIT_VARIABLE_HIGH + 1U, 'O'));
    TEST_ASSERT_EQUAL_UINT(PROGRAM_RELEASE, program_opcode_find(0, ']'));
    TEST_ASSERT_EQUAL_UINT(PROGRAM_OPCODES, program_opcode_find(0, '?'));
}

void test_an_instruction_has_8_bytes(void)
{
    TEST_ASSERT_EQUAL_UINT(8, sizeof(struct program_instruction));
}
