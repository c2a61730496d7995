#include "program_listing.h"
#include "program_parser.h"
#include "unity.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "exact_text.h"

#define LENGTH(array) (sizeof(array) / sizeof(array)[0])

enum {
    LOG_BYTES_MAX = 4096,
    TEXT_BYTES_MAX = 1024
};

static struct exact_text text;

/* What was read, one word for each find: the canonical command, or !place for a bad value, or ?place for an unknown
 * command. */
static char finds[LOG_BYTES_MAX];

void setUp(void)
{
    finds[0] = '\0';
}

void tearDown(void)
{
    exact_text_free(&text);
}

static void log_find(const char *word)
{
    size_t used = strlen(finds);
    TEST_ASSERT_TRUE(used + strlen(word) + 2 <= sizeof finds);
    (void)snprintf(&finds[used], sizeof finds - used, "%s%s", used > 0 ? " " : "", word);
}

static void log_status(enum program_status status, uint32_t place, const struct program_instruction *instruction)
{
    char word[PROGRAM_COMMAND_BYTES_MAX + 1] = "";
    if (status == PROGRAM_OK) {
        (void)program_list_instruction(instruction, (uint8_t *)word);
    } else {
        (void)snprintf(word, sizeof word, "%c%" PRIu32, status == PROGRAM_BAD_VALUE ? '!' : '?', place);
    }
    log_find(word);
}

/* Reads the text to its end. Every find lies after the last one, and every call gets further. */
static void read_text(void)
{
    struct program_parser parser;
    struct program_instruction instruction = {.value = 0};
    finds[0] = '\0';
    program_parser_init(&parser, text.bytes, text.length);
    for (;;) {
        uint32_t before = parser.next;
        enum program_status status = program_parser_next(&parser, &instruction);
        TEST_ASSERT_TRUE(parser.place >= before && parser.next <= text.length);
        if (status == PROGRAM_END) {
            TEST_ASSERT_EQUAL_UINT32(text.length, parser.place);
            return;
        }
        TEST_ASSERT_TRUE(parser.next > parser.place);
        log_status(status, parser.place, &instruction);
    }
}

static void assert_reads(const char *program, const char *expected)
{
    exact_text_take(&text, program, strlen(program));
    read_text();
    TEST_ASSERT_EQUAL_STRING_MESSAGE(expected, finds, program);
}

/* ---- between the commands ---- */

void test_an_empty_text_has_no_command(void)
{
    assert_reads("", "");
}

void test_blanks_tabs_and_line_ends_are_skipped(void)
{
    assert_reads(" \t\r\nF5000 \t\r\n R\r\n", "F5000 R");
    assert_reads(" \t\r\n", "");
}

void test_commands_need_nothing_between_them(void)
{
    assert_reads("C100S100V1000A2000F5000RB2000RH", "C100 S100 V1000 A2000 F5000 R B2000 R H");
}

void test_other_control_characters_are_unknown(void)
{
    assert_reads("R\vR\fR", "R ?1 R ?3 R");
}

void test_comments_are_skipped(void)
{
    assert_reads("{a}F1{b c}{d}\n{e}R{f}", "F1 R");
    assert_reads("{}", "");
}

void test_a_comment_may_span_lines_and_hold_any_byte(void)
{
    const char program[] = "F1{\r\n\0\xFF q @99}R";
    exact_text_take(&text, program, sizeof program - 1);
    read_text();
    TEST_ASSERT_EQUAL_STRING("F1 R", finds);
}

void test_comments_do_not_nest(void)
{
    assert_reads("{a{b}R}", "R ?6");
}

void test_an_unclosed_comment_is_unknown_at_its_brace(void)
{
    assert_reads("F1 R {go on", "F1 R ?5");
    assert_reads("{", "?0");
    assert_reads("{a} {", "?4");
}

void test_a_comment_ends_a_number(void)
{
    assert_reads("F1{}2", "F1 ?4");
}

/* ---- letters ---- */

static const char letters_alone[] = "\\DEHKRUY.[]";
static const char letters_with_value[] = "@ABCFGIJLMNOSTVWXZ)(='\"`\xB4";

void test_every_byte_alone_is_what_the_language_says(void)
{
    for (unsigned byte = 0; byte <= UINT8_MAX; byte++) {
        struct program_instruction instruction;
        struct program_parser parser;
        uint8_t character = (uint8_t)byte;
        enum program_status expected = PROGRAM_UNKNOWN_COMMAND;
        if (byte != 0 && strchr(letters_alone, (char)byte) != NULL) {
            expected = PROGRAM_OK;
        } else if (byte != 0 && strchr(letters_with_value, (char)byte) != NULL) {
            expected = PROGRAM_BAD_VALUE;
        } else if (byte == ' ' || byte == '\t' || byte == '\r' || byte == '\n') {
            expected = PROGRAM_END;
        }
        exact_text_take(&text, &character, 1);
        program_parser_init(&parser, text.bytes, text.length);
        TEST_ASSERT_EQUAL_MESSAGE(expected, program_parser_next(&parser, &instruction), "status");
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(expected == PROGRAM_END ? 1 : 0, parser.place, "place");
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, parser.next, "next");
    }
}

void test_lower_case_letters_are_unknown(void)
{
    assert_reads("f500 r", "?0 ?5");
}

void test_nul_and_8_bit_bytes_are_unknown_commands(void)
{
    const char program[] = "R\0R\x80R\xFFR";
    exact_text_take(&text, program, sizeof program - 1);
    read_text();
    TEST_ASSERT_EQUAL_STRING("R ?1 R ?3 R ?5 R", finds);
}

void test_a_nul_does_not_end_a_number_that_is_missing(void)
{
    const char program[] = "F\0"
                           "5";
    exact_text_take(&text, program, sizeof program - 1);
    read_text();
    TEST_ASSERT_EQUAL_STRING("!0 ?1", finds);
}

void test_all_call_characters_call(void)
{
    assert_reads("'3\"4`5\xB4"
                 "6",
                 "'3 '4 '5 '6");
}

void test_reset_halt_and_resume_are_ordinary_commands(void)
{
    assert_reads("\\K C75\\", "\\ K C75 \\");
}

/* ---- numbers ---- */

void test_a_missing_number_is_a_bad_value_at_the_letter(void)
{
    assert_reads("R F R", "R !2 R");
    assert_reads("F", "!0");
    assert_reads("=", "!0");
    assert_reads("G", "!0");
}

void test_leading_zeros_are_allowed(void)
{
    assert_reads("M05 M5 M0000000000000000000000000000005", "M05 M05 M05");
    assert_reads("F00016000000 =-007 G01", "F16000000 =-7 G1");
}

void test_zeros_alone_are_zero(void)
{
    assert_reads("=000 =0 =-0 F000", "=0 =0 =0 !12");
}

void test_a_number_of_30_digits_is_a_bad_value(void)
{
    assert_reads("F999999999999999999999999999999 R", "!0 R");
    assert_reads("=-100000000000000000000000000000 R", "!0 R");
    assert_reads("I05H100000000000000000000000000000 R", "!0 R");
    assert_reads("I100000000000000000000000000000H5 R", "!0 R");
}

void test_numbers_do_not_wrap_into_their_range(void)
{
    assert_reads("F4294967296 F4294967297 F8589934597", "!0 !12 !24");
    assert_reads("F18446744073709551617 F340282366920938463463374607431768211457", "!0 !22");
    assert_reads("G4294967295 G4294967290 G4294967289 G5000000001", "!0 !12 !24 !36");
    assert_reads("=2147483648 =-2147483649 =4294967295 =-4294967295", "!0 !12 !25 !37");
    assert_reads("I257H1 I5H257 I4294967301H1 I5H4294967297", "!0 !7 !14 !28");
}

void test_a_number_of_any_length_is_one_mistake(void)
{
    char program[TEXT_BYTES_MAX];
    memset(program, '9', sizeof program);
    program[0] = 'W';
    program[TEXT_BYTES_MAX - 1] = 'R';
    exact_text_take(&text, program, sizeof program);
    read_text();
    TEST_ASSERT_EQUAL_STRING("!0 R", finds);
}

void test_no_blank_is_allowed_between_letter_and_number(void)
{
    assert_reads("F 500 R", "!0 R");
    assert_reads("= -5 R", "!0 R");
    assert_reads("G + R", "!0 R");
    assert_reads("M\n05 R", "!0 R");
}

void test_a_decimal_point_is_not_part_of_a_number(void)
{
    assert_reads("W1.5", "W1 . ?3");
}

/* ---- signs ---- */

void test_the_position_may_be_negative(void)
{
    assert_reads("=-5 =-2000000000", "=-5 =-2000000000");
}

void test_a_plus_before_a_number_is_a_bad_value(void)
{
    assert_reads("=+5 R F+5 R M+5 R", "!0 R !6 R !12 R");
}

void test_signs_without_a_number_are_bad_values(void)
{
    assert_reads("=- R =+ R F- R F+ R T- R", "!0 R !5 R !10 R !15 R !20 R");
}

void test_two_signs_are_one_mistake(void)
{
    assert_reads("=--5 R G+- R G-+5 R =-5-5 R", "!0 R G+ ?9 R G- ?15 R =-5 ?23 R");
}

void test_go_takes_a_number_or_a_sign(void)
{
    assert_reads("G5 G+ G- G+R", "G5 G+ G- G+ R");
}

void test_go_does_not_take_a_sign_and_a_number(void)
{
    assert_reads("G+5 R G-5 R", "!0 R !6 R");
}

/* ---- conditional jumps ---- */

static bool is_level_number(unsigned io)
{
    return (io >= 1 && io <= 8) || (io >= 80 && io <= 95);
}

static void assert_jump_is_judged(unsigned io, char level, unsigned label)
{
    char program[32];
    char expected[32] = "!0";
    (void)snprintf(program, sizeof program, "I%u%c%u", io, level, label);
    if (is_level_number(io) && label >= 1 && label <= 80) {
        (void)snprintf(expected, sizeof expected, "I%02u%c%u", io, level, label);
    }
    assert_reads(program, expected);
}

void test_conditional_jumps_take_inputs_variables_and_labels_in_their_ranges(void)
{
    const unsigned labels[] = {0, 1, 2, 79, 80, 81, 255, 256, 257};
    for (unsigned io = 0; io <= 300; io++) {
        for (unsigned i = 0; i < LENGTH(labels); i++) {
            assert_jump_is_judged(io, 'H', labels[i]);
            assert_jump_is_judged(io, 'L', labels[i]);
        }
    }
}

void test_a_conditional_jump_keeps_its_parts(void)
{
    struct program_parser parser;
    struct program_instruction jump = {.value = 0};
    exact_text_take(&text, "I05L10", 6);
    program_parser_init(&parser, text.bytes, text.length);
    TEST_ASSERT_EQUAL(PROGRAM_OK, program_parser_next(&parser, &jump));
    TEST_ASSERT_EQUAL_UINT8(PROGRAM_JUMP_IF_LOW, jump.opcode);
    TEST_ASSERT_EQUAL_UINT8(5, jump.io);
    TEST_ASSERT_EQUAL_INT32(10, jump.value);
}

void test_leading_zeros_are_allowed_in_conditional_jumps(void)
{
    assert_reads("I0005H0010 I5L1", "I05H10 I05L1");
}

void test_an_unfinished_conditional_jump_is_one_bad_value(void)
{
    assert_reads("I", "!0");
    assert_reads("I R", "!0 R");
    assert_reads("I05", "!0");
    assert_reads("I05 R", "!0 R");
    assert_reads("I05H", "!0");
    assert_reads("I05L R", "!0 R");
    assert_reads("IH10 R", "!0 R");
    assert_reads("IL R", "!0 R");
}

void test_a_conditional_jump_with_signs_or_blanks_is_one_bad_value(void)
{
    assert_reads("I-5H10 R", "!0 R");
    assert_reads("I5H-10 R", "!0 R");
    assert_reads("I 05H10 R", "!0 R");
    assert_reads("I05 H10 R", "!0 R");
    assert_reads("I05H 10 R", "!0 R");
    assert_reads("I05 L 10 R", "!0 !4 R");
}

void test_a_conditional_jump_knows_no_other_level(void)
{
    assert_reads("I05h10 R", "!0 ?3 R");
    assert_reads("I05R", "!0 R");
}

void test_home_after_an_unfinished_conditional_jump_is_a_command(void)
{
    assert_reads("I05 H R", "!0 H R");
}

/* ---- going on after an error ---- */

void test_one_mistake_gives_one_error(void)
{
    assert_reads("F0 R", "!0 R");
    assert_reads("Q123 R", "?0 R");
    assert_reads("R500 R", "R ?1 R");
    assert_reads("R 500 R", "R ?2 R");
    assert_reads("-5 R", "?0 R");
    assert_reads("f -5 R", "?0 R");
}

void test_all_mistakes_of_a_text_are_found(void)
{
    assert_reads("F0 q S2001 {c} V16000 Z9\n'81 {", "!0 ?3 !5 V16000 !22 !25 ?29");
}

void test_the_end_is_found_again_and_again(void)
{
    struct program_parser parser;
    struct program_instruction instruction;
    exact_text_take(&text, "R ", 2);
    program_parser_init(&parser, text.bytes, text.length);
    TEST_ASSERT_EQUAL(PROGRAM_OK, program_parser_next(&parser, &instruction));
    TEST_ASSERT_EQUAL(PROGRAM_END, program_parser_next(&parser, &instruction));
    TEST_ASSERT_EQUAL(PROGRAM_END, program_parser_next(&parser, &instruction));
}

/* ---- cut and random texts ---- */

static const char long_program[] =
    "\\C100 S100 V1000 A2000 {first: home} @1 I05H10 I81L6 F5000 R L3 B16000000 E T51 M03 N08 X04 "
    "O02 Z95 )05 (06 =-2000000000 G+ G- G2000000000 '80 \"3 `4 . [ K C75 ] W600 D H U Y J1 {the end}";

/* Every cut is read as the whole is, up to the command or comment that the cut goes through. */
void test_a_cut_text_is_read_as_far_as_it_goes(void)
{
    char whole[LOG_BYTES_MAX];
    exact_text_take(&text, long_program, strlen(long_program));
    read_text();
    memcpy(whole, finds, sizeof whole);
    for (size_t length = 0; length < strlen(long_program); length++) {
        exact_text_take(&text, long_program, length);
        read_text();
        char *last = strrchr(finds, ' ');
        size_t sure = last != NULL ? (size_t)(last - finds) : 0;
        TEST_ASSERT_EQUAL_INT(0, strncmp(whole, finds, sure));
    }
}

void test_a_cut_text_has_no_unknown_command_but_a_comment(void)
{
    for (size_t length = 0; length < strlen(long_program); length++) {
        exact_text_take(&text, long_program, length);
        struct program_summary summary = program_check(text.bytes, text.length);
        if (summary.status == PROGRAM_UNKNOWN_COMMAND) {
            TEST_ASSERT_EQUAL_HEX8('{', summary.character);
        }
    }
}

static uint32_t random_next(uint32_t *state)
{
    *state ^= *state << 13U;
    *state ^= *state >> 17U;
    *state ^= *state << 5U;
    return *state;
}

static uint8_t random_byte(uint32_t *state)
{
    static const char likely[] = "0123456789+-HLIGFC={} \n";
    uint32_t random = random_next(state) >> 8U;
    return random % 4U != 0 ? (uint8_t)likely[(random >> 2U) % (sizeof likely - 1U)] : (uint8_t)(random >> 8U);
}

void test_random_bytes_are_read_to_their_end(void)
{
    uint32_t state = 20090306;
    for (unsigned round = 0; round < 20000; round++) {
        uint8_t bytes[64];
        size_t length = random_next(&state) % sizeof bytes;
        for (size_t i = 0; i < length; i++) {
            bytes[i] = random_byte(&state);
        }
        exact_text_take(&text, bytes, length);
        read_text();
    }
}
