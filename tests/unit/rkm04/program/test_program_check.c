#include "program_parser.h"
#include "unity.h"

#include <string.h>

#include "exact_text.h"

static struct exact_text text;

void setUp(void)
{
}

void tearDown(void)
{
    exact_text_free(&text);
}

static struct program_summary check(const char *program)
{
    exact_text_take(&text, program, strlen(program));
    return program_check(text.bytes, text.length);
}

void test_a_good_text_is_summed_up(void)
{
    struct program_summary summary = check("\\ {start} F5000 R");
    TEST_ASSERT_EQUAL(PROGRAM_OK, summary.status);
    TEST_ASSERT_EQUAL_HEX8(0, summary.character);
    TEST_ASSERT_EQUAL_UINT32(3, summary.commands);
    TEST_ASSERT_EQUAL_UINT8(PROGRAM_RESET, summary.first.opcode);
}

void test_a_single_command_is_known_among_blanks_and_comments(void)
{
    struct program_summary summary = check(" {slower} V500 {now}\r\n");
    TEST_ASSERT_EQUAL_UINT32(1, summary.commands);
    TEST_ASSERT_EQUAL_UINT8(PROGRAM_SPEED, summary.first.opcode);
    TEST_ASSERT_EQUAL_INT32(500, summary.first.value);
}

void test_an_empty_text_is_good(void)
{
    struct program_summary summary = program_check(NULL, 0);
    TEST_ASSERT_EQUAL(PROGRAM_OK, summary.status);
    TEST_ASSERT_EQUAL_HEX8(0, summary.character);
    TEST_ASSERT_EQUAL_UINT32(0, summary.commands);
}

void test_a_bad_value_is_told_with_its_letter(void)
{
    struct program_summary summary = check("S100 V16001 q");
    TEST_ASSERT_EQUAL(PROGRAM_BAD_VALUE, summary.status);
    TEST_ASSERT_EQUAL_HEX8('V', summary.character);
    TEST_ASSERT_EQUAL_UINT32(1, summary.commands);
}

void test_an_unknown_command_is_told_with_its_character(void)
{
    struct program_summary summary = check("S100 q V16001");
    TEST_ASSERT_EQUAL(PROGRAM_UNKNOWN_COMMAND, summary.status);
    TEST_ASSERT_EQUAL_HEX8('q', summary.character);
    TEST_ASSERT_EQUAL_UINT32(1, summary.commands);
}

void test_an_unclosed_comment_is_told_with_its_brace(void)
{
    struct program_summary summary = check("S100 {q");
    TEST_ASSERT_EQUAL(PROGRAM_UNKNOWN_COMMAND, summary.status);
    TEST_ASSERT_EQUAL_HEX8('{', summary.character);
}

void test_a_bad_call_is_told_with_the_character_that_was_sent(void)
{
    TEST_ASSERT_EQUAL_HEX8(0xB4, check("\xB4"
                                       "81")
                                     .character);
}

void test_a_message_of_8192_bytes_is_read_whole(void)
{
    static char program[8192];
    memset(program, 'R', sizeof program);
    exact_text_take(&text, program, sizeof program);
    struct program_summary summary = program_check(text.bytes, text.length);
    TEST_ASSERT_EQUAL(PROGRAM_OK, summary.status);
    TEST_ASSERT_EQUAL_UINT32(8192, summary.commands);
}

void test_the_statuses_are_the_negatives_of_the_flags(void)
{
    TEST_ASSERT_EQUAL_INT(-1, PROGRAM_BAD_VALUE);
    TEST_ASSERT_EQUAL_INT(-2, PROGRAM_UNKNOWN_COMMAND);
}
