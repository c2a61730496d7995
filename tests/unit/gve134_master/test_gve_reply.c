/* Commands and answers as they stand on the line. */
#include "unity.h"

#include <string.h>

#include "gve_reply.h"

static struct gve_reply reply;
static char line[128];

void setUp(void)
{
    memset(&reply, 0xA5, sizeof reply);
}

void tearDown(void)
{
}

static const char *put(const char *command, bool sums)
{
    struct text text;
    text_init(&text, (uint8_t *)line, sizeof line - 1);
    gve_reply_put_command(&text, (const uint8_t *)command, (uint32_t)strlen(command), sums);
    line[text.length] = '\0';
    return line;
}

static bool reads(const char *text, bool sums)
{
    return gve_reply_read(&reply, (const uint8_t *)text, (uint32_t)strlen(text), sums);
}

static bool answers(const char *command, const char *text)
{
    unsigned opcode = gve_reply_opcode((const uint8_t *)command, (uint32_t)strlen(command));
    const struct gve_reply_form form = {.values = (uint8_t)gve_reply_values(opcode)};
    TEST_ASSERT_TRUE(reads(text, false));
    return gve_reply_fits(&reply, form);
}

void test_commands_have_the_sums_of_the_data_sheet(void)
{
    TEST_ASSERT_EQUAL_STRING("!0?,BC\r", put("?", true));
    TEST_ASSERT_EQUAL_STRING("!0PF,13\r", put("PF", true));
    TEST_ASSERT_EQUAL_STRING("!0H,C5\r", put("h", true));
    TEST_ASSERT_EQUAL_STRING("!7V300,6D\r", put("!7V300", true));
    TEST_ASSERT_EQUAL_STRING("!0*E10,4D\r", put("*E10", true));
    TEST_ASSERT_EQUAL_STRING("!0PF\r", put("PF", false));
}

void test_vectors_have_all_four_numbers(void)
{
    TEST_ASSERT_EQUAL_STRING("!0C1,0,0,0\r", put("c1", false));
    TEST_ASSERT_EQUAL_STRING("!0L-5,6,0,0\r", put("L-5,6", false));
    TEST_ASSERT_EQUAL_STRING("!0C1,2,3,4\r", put("C1,2,3,4", false));
    TEST_ASSERT_EQUAL_STRING("!0L\r", put("L", false));
    TEST_ASSERT_EQUAL_STRING("!0C1,\r", put("C1,", false));
    TEST_ASSERT_EQUAL_STRING("!7L5\r", put("!7L5", false));
}

void test_an_answer_is_one_if_its_sum_is_right(void)
{
    TEST_ASSERT_TRUE(reads("0,-1000,2000,50,F5", true));
    TEST_ASSERT_EQUAL_STRING("-1000,2000,50", reply.values);
    TEST_ASSERT_TRUE(reads("8,D0,04", true));
    TEST_ASSERT_TRUE(reply.inta);
    TEST_ASSERT_EQUAL(GVE_DONE, reply.code);
    TEST_ASSERT_TRUE(reads("2,5E", true));
    TEST_ASSERT_EQUAL(GVE_DAMAGED, reply.code);
    TEST_ASSERT_EQUAL(0, reply.length);
    static const char *const none[] = {"0,5D", "0", "", "8,d0,04", "G,73", "0,,88", ",5C", "05C"};
    for (unsigned i = 0; i < sizeof none / sizeof none[0]; i++) {
        TEST_ASSERT_FALSE_MESSAGE(reads(none[i], true), none[i]);
    }
}

void test_without_a_sum_a_digit_is_an_answer(void)
{
    TEST_ASSERT_TRUE(reads("F", false));
    TEST_ASSERT_TRUE(reply.inta);
    TEST_ASSERT_EQUAL(GVE_NOT_NOW, reply.code);
    TEST_ASSERT_TRUE(reads("0,17", false));
    TEST_ASSERT_EQUAL_STRING("17", reply.values);
    TEST_ASSERT_FALSE(reads("0,", false));
    TEST_ASSERT_FALSE(reads("017", false));
}

void test_a_line_that_is_too_long_is_no_answer(void)
{
    char text[GVE_REPLY_LINE_BYTES_MAX + 2];
    memset(text, '1', sizeof text);
    text[1] = ',';
    text[sizeof text - 2] = '\0';
    TEST_ASSERT_TRUE(reads(text, false));
    text[sizeof text - 2] = '1';
    text[sizeof text - 1] = '\0';
    TEST_ASSERT_FALSE(reads(text, false));
}

void test_what_looks_otherwise_is_the_answer_to_something_else(void)
{
    static const char *const rows[][3] = {
        {"?", "0,IP134/200 v1 22.11.2026", "0"},
        {"Q", "0,25022504", "0,2502250"},
        {"P", "0,-1000,2000", "0,1,2,3"},
        {"PF", "0,-1000,2000,50", "0,1,2"},
        {"P4", "0,-1000,2000,50,0", "0,1,,2,3"},
        {"PL", "0,-1000,2000,50,0", "0,1,-,2,3"},
        {"SR6", "0,D0", "0,D"},
        {"I1", "0,F0", "0,G0"},
        {"ER05", "0,FF", "0"},
        {"EUR10", "0,3FC00000", "0,3FC0000,"},
        {"EFR10", "0,1.5", "0,1.5,2"},
        {"EFR10", "0,-1.17549435E-38", "0,-"},
        {"EFR10", "0,-INF", "0,INFINITE"},
        {"EFR10", "0,NAN", "0,-NAN"},
        {"@", "0,255", "0,1000"},
        {"*E10", "0,10", "0,A"},
        {"V100", "0", "0,5"},
        {"!7V100", "0", "0,5"},
        {"C1", "0", "0,5"},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(answers(rows[i][0], rows[i][1]), rows[i][1]);
        TEST_ASSERT_FALSE_MESSAGE(answers(rows[i][0], rows[i][2]), rows[i][2]);
    }
}

void test_anything_can_be_refused_and_repeated(void)
{
    TEST_ASSERT_TRUE(answers("P4", "7"));
    TEST_ASSERT_TRUE(answers("nonsense", "3"));
    TEST_ASSERT_FALSE(answers("P4", "7,1"));
    TEST_ASSERT_TRUE(answers(">", "0,1,2,3"));
    TEST_ASSERT_TRUE(answers(">", "0"));
}

void test_the_answer_to_a_packet_is_none_or_all_of_it(void)
{
    const struct gve_reply_form form = {.values = GVE_VALUES_COUNT, .count = 12};
    TEST_ASSERT_TRUE(reads("0,12", false) && gve_reply_fits(&reply, form));
    TEST_ASSERT_TRUE(reads("1,0", false) && gve_reply_fits(&reply, form));
    TEST_ASSERT_TRUE(reads("0,11", false) && !gve_reply_fits(&reply, form));
    TEST_ASSERT_TRUE(reads("0", false) && !gve_reply_fits(&reply, form));
}
