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

/* What follows is thrown away, 100 ms later it is answered with 2, once, and the next line is read. */
static void assert_damage_is_answered(void)
{
    take("!0L1\r!0H\r");
    wait(SILENCE_TICKS - 1);
    assert_nothing();
    wait(1);
    assert_next_kind(GVE_REQUEST_DAMAGE);
    assert_nothing();
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, gve_line_poll(&line, tick + GAP_TICKS));
    assert_nothing();
}

static void assert_damage_is_not_answered(void)
{
    take("!0L1\r!0H\r");
    wait(SILENCE_TICKS);
    assert_nothing();
}

void test_a_second_of_silence_in_a_command_is_damage_and_answered_at_once(void)
{
    take("!0L10");
    TEST_ASSERT_EQUAL_UINT64(tick + GAP_TICKS, gve_line_poll(&line, tick));
    wait(GAP_TICKS - 1);
    assert_nothing();
    wait(1);
    assert_next_kind(GVE_REQUEST_DAMAGE);
    take("00\r!0F\r");
    assert_next(GVE_FLAGS);
    take("!");
    wait(GAP_TICKS);
    assert_nothing();
}

void test_a_silence_that_nobody_has_looked_for_is_seen_at_the_next_byte(void)
{
    take("!0L10");
    tick += GAP_TICKS;
    take("00\r");
    assert_next_kind(GVE_REQUEST_DAMAGE);
    assert_nothing();
    take("!0L!");
    tick += SILENCE_TICKS;
    take("!0F\r");
    assert_next_kind(GVE_REQUEST_DAMAGE);
    assert_next(GVE_FLAGS);
}

void test_a_silence_that_nobody_has_looked_for_is_seen_at_bytes_that_come_together(void)
{
    take("!0L10");
    tick += GAP_TICKS;
    take_together("00\r!0F\r");
    assert_next_kind(GVE_REQUEST_DAMAGE);
    assert_next(GVE_FLAGS);
    assert_nothing();
    take("!0L!");
    tick += SILENCE_TICKS;
    take_together("!0F\r");
    assert_next_kind(GVE_REQUEST_DAMAGE);
    assert_next(GVE_FLAGS);
}

void test_a_byte_with_an_error_in_a_command_is_damage(void)
{
    take("!0L1");
    take_byte('0', true);
    assert_damage_is_answered();
    take("!");
    take_byte('0', true);
    assert_damage_is_not_answered();
    take("!3L1");
    take_byte('0', true);
    take("\r!0F\r");
    assert_next(GVE_FLAGS);
}

void test_a_new_line_before_the_end_of_a_command_is_damage(void)
{
    take("!0L10!0F\r");
    take_byte('x', true);
    assert_damage_is_answered();
    take("!!0F\r");
    assert_damage_is_not_answered();
}

void test_a_missing_or_wrong_checksum_is_damage(void)
{
    static const char *const lines[] = {"!0F\r",    "!0\r",    "!0F,C\r",  "!0F,C5\r",  "!0F,CG\r",
                                        "!0F,G3\r", "!0FC3\r", "!0F.C3\r", "!0PF,1J\r", "!0F,D3\r"};
    switch_sums_on();
    for (unsigned i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        take(lines[i]);
        assert_damage_is_answered();
    }
    take("!0F,C3\r");
    assert_next(GVE_FLAGS);
}

void test_with_checksums_a_line_that_is_too_long_is_damage(void)
{
    char text[OUT_ROOM];
    switch_sums_on();
    (void)snprintf(text, sizeof text, "!0L%0*d,%02X\r", GVE_LINE_CHARACTERS_MAX - 2, 0,
                   (unsigned)('!' + '0' + 'L' + '0' * (GVE_LINE_CHARACTERS_MAX - 2) + ',') & 0xFFU);
    take(text);
    assert_damage_is_answered();
    (void)snprintf(text, sizeof text, "!0L%0*d,%02X\r", GVE_LINE_CHARACTERS_MAX - 5, 0,
                   (unsigned)('!' + '0' + 'L' + '0' * (GVE_LINE_CHARACTERS_MAX - 5) + ',') & 0xFFU);
    take(text);
    assert_next(GVE_LINE);
}

void test_a_right_checksum_before_the_81st_character_does_not_count(void)
{
    char text[OUT_ROOM];
    switch_sums_on();
    (void)snprintf(text, sizeof text, "!0L%0*d,%02XX\r", GVE_LINE_CHARACTERS_MAX - 5, 0,
                   (unsigned)('!' + '0' + 'L' + '0' * (GVE_LINE_CHARACTERS_MAX - 5) + ',') & 0xFFU);
    take(text);
    assert_damage_is_answered();
}

void test_with_checksums_the_commands_for_others_are_checked_and_never_answered(void)
{
    switch_sums_on();
    take("!3F,C6\r");
    take("!0F,C3\r");
    assert_next(GVE_FLAGS);
    take("!3F,C5\r");
    assert_damage_is_not_answered();
    take("!3F!");
    assert_damage_is_not_answered();
    take("!3");
    take_byte('F', true);
    assert_damage_is_not_answered();
    take("!\r");
    assert_damage_is_not_answered();
    take("!,4D\r!0F,C3\r");
    assert_next(GVE_FLAGS);
}

void test_with_checksums_bytes_outside_of_lines_are_damage_without_an_answer(void)
{
    switch_sums_on();
    take("x");
    assert_damage_is_not_answered();
    take_byte('\r', true);
    assert_damage_is_not_answered();
    take("\r\n\r!0F,C3\r");
    assert_next(GVE_FLAGS);
}

void test_with_checksums_a_byte_between_lines_that_come_together_is_damage(void)
{
    switch_sums_on();
    take_together("!0F,C3\rx!0F,C3\r");
    assert_next(GVE_FLAGS);
    assert_damage_is_not_answered();
}
