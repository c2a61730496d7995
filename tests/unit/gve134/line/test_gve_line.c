#include "unity.h"

#include "gve_line_rig.h"

void setUp(void)
{
    rig_set_up();
}

void tearDown(void)
{
    TEST_ASSERT_FALSE(gve_line_is_sending(&line));
}

void test_the_examples_without_checksums_are_read_and_answered_byte_for_byte(void)
{
    take("!0L1000,0,0\r");
    assert_next(GVE_LINE);
    assert_answer("0\r", 0, "");
    take("\x21\x30\x50\x46\x0D");
    assert_next(GVE_POSITION_3);
    assert_answer("0,-1000,2000,50\r", 0, "-1000,2000,50");
    take("!0C100,20,0\r");
    assert_next(GVE_CONTINUE);
    assert_answer("1\r", 1, "");
    take("!0V1000\r");
    assert_next(GVE_SPEED);
    assert_answer("8\r", 8, "");
    take("!0SW8,F1\r");
    assert_next_fault(GVE_FAULT_BOUNDS);
    assert_answer("5\r", 5, "");
    take("!0SR2\r");
    assert_next(GVE_READ_STATUS);
    assert_answer("0,2B\r", 0, "2B");
    assert_nothing();
}

void test_the_examples_with_checksums_are_read_and_answered_byte_for_byte(void)
{
    switch_sums_on();
    take("!0?,BC\r");
    assert_next(GVE_VERSION);
    assert_answer("0,IP134/200 v1 22.11.2026,4D\r", 0, "IP134/200 v1 22.11.2026");
    take("!0PF,13\r");
    assert_next(GVE_POSITION_3);
    assert_answer("0,-1000,2000,50,F5\r", 0, "-1000,2000,50");
    take("!0H,C5\r");
    assert_next(GVE_HALT);
    assert_answer("8,64\r", 8, "");
    take("!0SR6,58\r");
    assert_next(GVE_READ_STATUS);
    assert_answer("8,D0,04\r", 8, "D0");
    take("!0A100,4F\r");
    assert_next(GVE_ACCELERATION);
    assert_answer("0,5C\r", 0, "");
    take("!0C100,20,0,3b\r");
    assert_next(GVE_CONTINUE);
    assert_answer("1,5D\r", 1, "");
    take("!7V300,6D\r");
    assert_next(GVE_SPINDLE);
    assert_answer("0,5C\r", 0, "");
    take("!0A100,4E\r");
    assert_nothing();
    wait(SILENCE_TICKS);
    assert_next_kind(GVE_REQUEST_DAMAGE);
    assert_answer("2,5E\r", 2, "");
    take("!0%-,CF\r");
    assert_next(GVE_SUMS_OFF);
    assert_answer("0\r", 0, "");
    take("!0%-\r");
    assert_next(GVE_SUMS_OFF);
    assert_answer("0\r", 0, "");
}

void test_bytes_that_come_together_are_read_as_one_by_one(void)
{
    take_together("x!0L1000,0,0\r!1V5\r!0SW8,F1\r!0%+\r\n!0C100,\n20,0,3B\r!1V200000,F6\r!7V300,6D\r");
    assert_next(GVE_LINE);
    answer(0, "");
    TEST_ASSERT_EQUAL_STRING("0\r", sent());
    assert_next_fault(GVE_FAULT_BOUNDS);
    answer(5, "");
    TEST_ASSERT_EQUAL_STRING("5\r", sent());
    assert_next(GVE_SUMS_ON);
    assert_answer("0,5C\r", 0, "");
    assert_next(GVE_CONTINUE);
    assert_answer("1,5D\r", 1, "");
    assert_next(GVE_SPINDLE);
    assert_answer("0,5C\r", 0, "");
    assert_nothing();
}

void test_a_long_line_and_damage_in_bytes_that_come_together_are_told(void)
{
    take_together("!0L1,2,3,4,0000000000000000000000000000000000000000000000000000000000000000000000000000\r!0PF\r");
    assert_next_fault(GVE_FAULT_TOO_LONG);
    answer(4, "");
    TEST_ASSERT_EQUAL_STRING("4\r", sent());
    assert_next(GVE_POSITION_3);
    assert_answer("0\r", 0, "");
    take_together("!0P!0PF\r!0P\r");
    assert_nothing();
    wait(SILENCE_TICKS);
    assert_next_kind(GVE_REQUEST_DAMAGE);
    assert_answer("2\r", 2, "");
    take_together("!0P");
    gve_line_take_run(&line, &(struct hal_line_run){.tick = ++tick, .count = 1, .bytes = {'F'}, .broken = true});
    wait(SILENCE_TICKS);
    assert_next_kind(GVE_REQUEST_DAMAGE);
    assert_answer("2\r", 2, "");
    assert_nothing();
}

void test_sums_are_counted_on_the_characters_as_they_came_and_line_feeds_are_ignored(void)
{
    switch_sums_on();
    take("\n!0\na100,\n6F\n\r\n");
    assert_next(GVE_ACCELERATION);
    assert_answer("0,5C\r", 0, "");
    take("\r\r\n!0,7D\r");
    assert_next_fault(GVE_FAULT_UNKNOWN);
    assert_answer("3,5F\r", 3, "");
}

void test_what_is_for_another_address_has_no_effect(void)
{
    take("!1H\r!9H\r!H\r!\r!8%+\r");
    assert_nothing();
    take("!3L5!0F\r");
    assert_next(GVE_FLAGS);
    take("!3L5");
    wait(GAP_TICKS);
    assert_nothing();
    take("!0\r");
    assert_next_fault(GVE_FAULT_UNKNOWN);
    assert_nothing();
}

void test_a_unit_may_have_other_addresses(void)
{
    gve_line_init(&line, 3, 5);
    take("!0F\r!7V1\r!3F\r!5V1\r");
    assert_next(GVE_FLAGS);
    assert_next(GVE_SPINDLE);
    assert_nothing();
}

void test_without_checksums_what_stands_outside_of_lines_is_ignored(void)
{
    take("0PF\r\x80noise\xFF\n");
    take_byte('!', true);
    take("0PF\r");
    assert_nothing();
    take("!0F\r");
    assert_next(GVE_FLAGS);
}

void test_a_line_of_80_characters_is_read_and_one_more_is_wrong_syntax(void)
{
    char text[OUT_ROOM];
    (void)snprintf(text, sizeof text, "!0L%0*d\r", GVE_LINE_CHARACTERS_MAX - 2, 5);
    take(text);
    assert_next(GVE_LINE);
    TEST_ASSERT_EQUAL_INT32(5, request.command.numbers[0]);
    (void)snprintf(text, sizeof text, "!0L%0*d\r", GVE_LINE_CHARACTERS_MAX - 1, 5);
    take(text);
    assert_next_fault(GVE_FAULT_TOO_LONG);
    (void)snprintf(text, sizeof text, "!0M%0*d\r!0F\r", OUT_ROOM / 2, 5);
    take(text);
    assert_next_fault(GVE_FAULT_UNKNOWN);
    assert_next(GVE_FLAGS);
}

static void assert_index(const char *expected)
{
    take("!0@\r");
    assert_next(GVE_INDEX);
    gve_line_answer_index(&line, false);
    TEST_ASSERT_EQUAL_STRING(expected, sent());
}

static void assert_again(const char *expected)
{
    take("!7>\r");
    assert_next(GVE_REPEAT);
    gve_line_answer_again(&line, false);
    TEST_ASSERT_EQUAL_STRING(expected, sent());
}

void test_the_index_counts_every_whole_command_but_index_and_repeat(void)
{
    assert_index("0,0\r");
    assert_index("0,0\r");
    take("!0F\r!7?\r!0M\r!0V1\r!3F\r!0*S\r!0C1\r!0C!0*E1\r!0@5\r");
    while (gve_line_next(&line, &request)) {
    }
    assert_index("0,7\r");
    assert_again("0\r");
    assert_index("0,7\r");
    take("!0L!");
    wait(SILENCE_TICKS);
    assert_next_kind(GVE_REQUEST_DAMAGE);
    assert_index("0,7\r");
    for (unsigned i = 7; i < 255; i++) {
        take("!0F\r");
        assert_next(GVE_FLAGS);
    }
    assert_index("0,255\r");
    for (unsigned i = 255; i < 259; i++) {
        take("!0F\r");
        assert_next(GVE_FLAGS);
    }
    assert_index("0,3\r");
}

void test_the_last_answer_is_repeated_byte_for_byte(void)
{
    take("!0>\r");
    assert_next(GVE_REPEAT);
    gve_line_answer_again(&line, true);
    TEST_ASSERT_EQUAL_STRING("8\r", sent());
    assert_again("0\r");
    take("!0PF\r");
    assert_next(GVE_POSITION_3);
    assert_answer("8,-1000,2000,50\r", 8, "-1000,2000,50");
    assert_again("8,-1000,2000,50\r");
    assert_index("0,1\r");
    take("!0>5\r");
    assert_next_fault(GVE_FAULT_SURPLUS);
    assert_answer("4\r", 4, "");
    assert_again("8,-1000,2000,50\r");
    take("!0%+\r");
    assert_next(GVE_SUMS_ON);
    assert_answer("0,5C\r", 0, "");
    take("!0>,BB\r");
    assert_next(GVE_REPEAT);
    gve_line_answer_again(&line, true);
    TEST_ASSERT_EQUAL_STRING("0,5C\r", sent());
    take("!0@,BD\r");
    assert_next(GVE_INDEX);
    gve_line_answer_index(&line, true);
    TEST_ASSERT_EQUAL_STRING("8,2,C2\r", sent());
}

void test_the_longest_answer_goes_out_whole(void)
{
    static const char values[] = "-2147483648,-2147483648,-2147483648,-2147483648";
    switch_sums_on();
    take("!0P4,01\r");
    assert_next(GVE_POSITION_4);
    answer(15, values);
    const char *out = sent();
    TEST_ASSERT_EQUAL_STRING_LEN("F,-2147483648,-2147483648,-2147483648,-2147483648,", out, 50);
    TEST_ASSERT_EQUAL_UINT(53, strlen(out));
}
