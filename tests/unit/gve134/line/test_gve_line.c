#include "unity.h"

#include <stdio.h>
#include <string.h>

#include "base_tick.h"
#include "gve_line.h"
#include "host_machine.h"

enum {
    INTERPOLATOR = 0,
    SPINDLE = 7,
    OUT_ROOM = 200,
};

#define BYTE_TICKS ((uint64_t)7292) /* at 115 200 Bd */
#define SILENCE_TICKS ((uint64_t)100 * TICKS_PER_MS)
#define GAP_TICKS ((uint64_t)1000 * TICKS_PER_MS)

static struct gve_line line;
static struct gve_request request;
static uint64_t tick;

void setUp(void)
{
    tick = UINT64_C(0xFFFFFF00);
    gve_line_init(&line, INTERPOLATOR, SPINDLE);
}

void tearDown(void)
{
    TEST_ASSERT_FALSE(gve_line_is_sending(&line));
}

static void take_byte(uint8_t value, bool broken)
{
    tick += BYTE_TICKS;
    gve_line_take(&line, &(struct hal_line_byte){.tick = tick, .value = value, .broken = broken});
}

static void take(const char *bytes)
{
    for (; *bytes != '\0'; bytes++) {
        take_byte((uint8_t)*bytes, false);
    }
}

static void wait(uint64_t ticks)
{
    tick += ticks;
    (void)gve_line_poll(&line, tick);
}

/* What goes out. */
static const char *sent(void)
{
    static char out[OUT_ROOM];
    unsigned length = 0;
    while (gve_line_is_sending(&line)) {
        out[length++] = (char)gve_line_byte(&line);
        gve_line_advance(&line);
    }
    out[length] = '\0';
    return out;
}

static void assert_nothing(void)
{
    TEST_ASSERT_FALSE(gve_line_next(&line, &request));
}

static void assert_next(enum gve_opcode opcode)
{
    TEST_ASSERT_TRUE(gve_line_next(&line, &request));
    TEST_ASSERT_EQUAL_UINT8(GVE_REQUEST_COMMAND, request.kind);
    TEST_ASSERT_EQUAL_STRING(gve_fault_text(GVE_FAULT_NONE), gve_fault_text((enum gve_fault)request.fault));
    TEST_ASSERT_EQUAL_STRING(gve_row(opcode)->name, gve_row(request.command.opcode)->name);
}

static void assert_next_fault(enum gve_fault fault)
{
    TEST_ASSERT_TRUE(gve_line_next(&line, &request));
    TEST_ASSERT_EQUAL_UINT8(GVE_REQUEST_COMMAND, request.kind);
    TEST_ASSERT_EQUAL_STRING(gve_fault_text(fault), gve_fault_text((enum gve_fault)request.fault));
}

static void assert_next_kind(enum gve_request_kind kind)
{
    TEST_ASSERT_TRUE(gve_line_next(&line, &request));
    TEST_ASSERT_EQUAL_UINT8(kind, request.kind);
}

static void answer(unsigned digit, const char *values)
{
    gve_line_answer(&line, (enum gve_code)(digit % GVE_INTA), digit >= GVE_INTA, (const uint8_t *)values,
                    (uint32_t)strlen(values));
}

static void assert_answer(const char *expected, unsigned digit, const char *values)
{
    answer(digit, values);
    TEST_ASSERT_EQUAL_STRING(expected, sent());
}

static void switch_sums_on(void)
{
    take("!0%+\r");
    assert_next(GVE_SUMS_ON);
    assert_answer("0,5C\r", 0, "");
}

/* ---- lines ----------------------------------------------------------------------------------------------------- */

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

/* ---- damage ---------------------------------------------------------------------------------------------------- */

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
    assert_damage_is_answered();
    take("!!0F\r");
    assert_damage_is_not_answered();
}

void test_a_missing_or_wrong_checksum_is_damage(void)
{
    static const char *const lines[] = {"!0F\r",    "!0\r",     "!0F,C\r", "!0F,C5\r",
                                        "!0F,CG\r", "!0F,G3\r", "!0FC3\r", "!0F.C3\r"};
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

/* ---- packets --------------------------------------------------------------------------------------------------- */

void test_the_packet_of_the_sheet_is_read_and_answered(void)
{
    static const char *const lines[] = {
        "!0*S,FA\r",         "!0C697,30,0,51\r",  "!0C692,92,0,54\r",  "!0C682,151,0,7F\r",
        "!0C665,209,0,84\r", "!0C645,268,0,87\r", "!0C619,322,0,7F\r", "!0C589,375,0,8D\r",
        "!0C553,425,0,80\r", "!0C515,471,0,7F\r", "!0C471,515,0,7F\r", "!0*E10,4D\r",
    };
    switch_sums_on();
    for (unsigned i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        take(lines[i]);
    }
    assert_next(GVE_PACKET_BEGIN);
    TEST_ASSERT_FALSE(request.packet);
    for (unsigned i = 0; i < 10; i++) {
        assert_next(GVE_CONTINUE);
        TEST_ASSERT_TRUE(request.packet);
        TEST_ASSERT_EQUAL_UINT8(3, request.command.count);
    }
    assert_next(GVE_PACKET_END);
    TEST_ASSERT_TRUE(request.packet);
    TEST_ASSERT_EQUAL_INT32(10, request.command.numbers[0]);
    assert_answer("0,10,E9\r", 0, "10");
    assert_answer("1,0,B9\r", 1, "0");
    assert_answer("2,0,BA\r", 2, "0");
    assert_answer("8,10,F1\r", 8, "10");
    take("!0F,C3\r");
    assert_next(GVE_FLAGS);
    TEST_ASSERT_FALSE(request.packet);
}

void test_a_damaged_line_of_a_packet_is_told_once_and_the_packet_is_read_to_its_end(void)
{
    take("!0*S\r!0C1\r!0C2");
    take_byte('2', true);
    take("2\r!0C3!0C4\r!0*E4\r!0F\r");
    assert_next(GVE_PACKET_BEGIN);
    assert_next(GVE_CONTINUE);
    assert_next_kind(GVE_REQUEST_BAD_LINE);
    TEST_ASSERT_TRUE(request.packet);
    assert_next(GVE_CONTINUE);
    TEST_ASSERT_EQUAL_INT32(4, request.command.numbers[0]);
    assert_next(GVE_PACKET_END);
    assert_next(GVE_FLAGS);
    assert_nothing();
}

void test_in_a_packet_with_checksums_wrong_sums_and_stray_bytes_are_damage_up_to_the_next_line(void)
{
    switch_sums_on();
    take("!0*S,FA\r!0C697,30,0,52\r!0C692,92,0,54\r!0*E2,1E\r");
    assert_next(GVE_PACKET_BEGIN);
    assert_next_kind(GVE_REQUEST_BAD_LINE);
    assert_next(GVE_CONTINUE);
    assert_next(GVE_PACKET_END);
    take("!0*S,FA\rnoise!0C692,92,0,54\rmore\r!0*E1,1D\r");
    assert_next(GVE_PACKET_BEGIN);
    assert_next_kind(GVE_REQUEST_BAD_LINE);
    assert_next(GVE_CONTINUE);
    assert_next(GVE_PACKET_END);
    assert_nothing();
}

void test_a_second_of_silence_ends_a_packet_in_a_line_and_between_lines(void)
{
    static const char *const begins[] = {"!0*S\r", "!0*S\r!0C1", "!0*S\r!0C!0C1\r"};
    for (unsigned i = 0; i < sizeof begins / sizeof begins[0]; i++) {
        setUp();
        take(begins[i]);
        TEST_ASSERT_EQUAL_UINT64(tick + GAP_TICKS, gve_line_poll(&line, tick));
        wait(GAP_TICKS);
        do {
            TEST_ASSERT_TRUE(gve_line_next(&line, &request));
        } while (request.kind != GVE_REQUEST_DAMAGE);
        assert_nothing();
        take("!0F\r");
        assert_next(GVE_FLAGS);
        TEST_ASSERT_FALSE(request.packet);
    }
}

void test_a_packet_that_begins_anew_may_tell_damage_anew(void)
{
    take("!0*S\r!0C!0*s\r!0C!0*e0\r");
    assert_next(GVE_PACKET_BEGIN);
    assert_next_kind(GVE_REQUEST_BAD_LINE);
    assert_next(GVE_PACKET_BEGIN);
    TEST_ASSERT_TRUE(request.packet);
    assert_next_kind(GVE_REQUEST_BAD_LINE);
    assert_next(GVE_PACKET_END);
    assert_nothing();
}

void test_halt_and_reset_end_a_packet_and_other_commands_do_not(void)
{
    take("!0*S\r!0H1\r!7F\r!0F\r!0H\r!0F\r");
    assert_next(GVE_PACKET_BEGIN);
    assert_next_fault(GVE_FAULT_SURPLUS);
    assert_next_fault(GVE_FAULT_UNKNOWN);
    assert_next(GVE_FLAGS);
    TEST_ASSERT_TRUE(request.packet);
    assert_next(GVE_HALT);
    assert_next(GVE_FLAGS);
    TEST_ASSERT_FALSE(request.packet);
    take("!0*S\r!7J\r!0F\r");
    assert_next(GVE_PACKET_BEGIN);
    assert_next(GVE_RESET);
    assert_next(GVE_FLAGS);
    TEST_ASSERT_FALSE(request.packet);
}

void test_the_end_of_a_packet_with_a_wrong_number_is_its_end(void)
{
    static const char *const ends[] = {"!0*E\r", "!0*Ex\r", "!0*E129\r"};
    for (unsigned i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        take("!0*S\r");
        take(ends[i]);
        take("!0F\r");
        assert_next(GVE_PACKET_BEGIN);
        TEST_ASSERT_TRUE(gve_line_next(&line, &request));
        TEST_ASSERT_EQUAL_UINT8(GVE_PACKET_END, request.command.opcode);
        TEST_ASSERT_TRUE(request.packet);
        assert_next(GVE_FLAGS);
        TEST_ASSERT_FALSE(request.packet);
    }
}

void test_in_a_packet_the_switch_of_checksums_has_no_effect(void)
{
    take("!0*S\r!0%+\r!0*E0\r");
    assert_next(GVE_PACKET_BEGIN);
    assert_next(GVE_SUMS_ON);
    assert_next(GVE_PACKET_END);
    assert_answer("4,0\r", 4, "0");
    switch_sums_on();
    take("!0*S,FA\r!0%-,CF\r!0*E0,1C\r");
    assert_next(GVE_PACKET_BEGIN);
    assert_next(GVE_SUMS_OFF);
    assert_next(GVE_PACKET_END);
    assert_answer("4,0,BC\r", 4, "0");
}

/* ---- repair ---------------------------------------------------------------------------------------------------- */

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
    for (unsigned i = 7; i < 259; i++) {
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

/* ---- what is kept ---------------------------------------------------------------------------------------------- */

void test_256_bytes_are_kept_and_come_in_order(void)
{
    char text[OUT_ROOM];
    unsigned bytes = 0;
    unsigned count = 0;
    for (; bytes < 256; bytes += 3U) {
        take("!0\r");
        count++;
    }
    for (unsigned i = 0; i < count; i++) {
        assert_next_fault(GVE_FAULT_UNKNOWN);
    }
    assert_nothing();
    for (int i = 0; i < 50; i++) {
        (void)snprintf(text, sizeof text, "!0L%d\r", i);
        take(text);
    }
    for (int i = 0; i < 50; i++) {
        assert_next(GVE_LINE);
        TEST_ASSERT_EQUAL_INT32(i, request.command.numbers[0]);
    }
    assert_nothing();
}

static void fill(void)
{
    for (unsigned i = 0; i < GVE_LINE_KEPT - GVE_LINE_SPARED; i++) {
        take("!0F\r");
    }
}

static void empty(void)
{
    for (unsigned i = 0; i < GVE_LINE_KEPT - GVE_LINE_SPARED; i++) {
        assert_next(GVE_FLAGS);
    }
}

void test_what_does_not_fit_is_damage_and_halt_still_does(void)
{
    fill();
    take("!0H\r");
    TEST_ASSERT_TRUE(gve_line_keeps(&line, GVE_HALT));
    take("!0L1\r");
    take("!0L2\r");
    wait(SILENCE_TICKS);
    empty();
    assert_next(GVE_HALT);
    TEST_ASSERT_FALSE(gve_line_keeps(&line, GVE_HALT));
    assert_next_kind(GVE_REQUEST_DAMAGE);
    assert_nothing();
}

void test_damage_that_finds_no_room_is_told_when_there_is_some_and_nothing_is_taken_before(void)
{
    fill();
    for (unsigned i = 0; i < GVE_LINE_SPARED; i++) {
        take("!0H\r");
    }
    take("!0H\r");
    wait(SILENCE_TICKS);
    wait(SILENCE_TICKS);
    empty();
    for (unsigned i = 0; i < GVE_LINE_SPARED; i++) {
        assert_next(GVE_HALT);
    }
    assert_nothing();
    wait(SILENCE_TICKS);
    assert_next_kind(GVE_REQUEST_DAMAGE);
    assert_nothing();
    take("!0F\r");
    assert_next(GVE_FLAGS);
}

void test_a_reset_finds_room_where_there_is_none(void)
{
    fill();
    for (unsigned i = 0; i < GVE_LINE_SPARED; i++) {
        take("!0H\r");
    }
    take("!0J\r");
    TEST_ASSERT_TRUE(gve_line_keeps(&line, GVE_RESET));
    assert_next(GVE_RESET);
    assert_nothing();
}

void test_a_packet_that_does_not_fit_is_bad_and_none_of_it_comes_as_single_vectors(void)
{
    take("!0*S\r");
    for (unsigned i = 0; i < GVE_LINE_KEPT; i++) {
        take("!0C1\r");
    }
    wait(SILENCE_TICKS);
    take("!0C1\r!0*E91\r");
    assert_next(GVE_PACKET_BEGIN);
    for (unsigned i = 0; i < GVE_LINE_KEPT - GVE_LINE_SPARED - 1; i++) {
        assert_next(GVE_CONTINUE);
        TEST_ASSERT_TRUE(request.packet);
    }
    assert_next_kind(GVE_REQUEST_BAD_LINE);
    assert_next(GVE_PACKET_END);
    assert_nothing();
}

void test_a_packet_whose_end_does_not_fit_is_over_with_the_damage(void)
{
    fill();
    for (unsigned i = 0; i < GVE_LINE_SPARED - 2; i++) {
        take("!0H\r");
    }
    take("!0F\r");
    wait(SILENCE_TICKS);
    (void)gve_line_next(&line, &request);
    (void)gve_line_next(&line, &request);
    (void)gve_line_next(&line, &request);
    (void)gve_line_next(&line, &request);
    take("!0*S\r!0C1\r!0H\r!0*S\r!0C1\r!0C1\r");
    for (unsigned i = 0; i < GVE_LINE_KEPT + 1; i++) {
        take("!0*S\r!0C1\r!0*E1\r");
    }
    take("!0C1\r");
    wait(SILENCE_TICKS);
    unsigned damage = 0;
    bool packet = false;
    while (gve_line_next(&line, &request)) {
        bool vector = request.kind == GVE_REQUEST_COMMAND && request.command.opcode == GVE_CONTINUE;
        TEST_ASSERT_TRUE(!vector || packet);
        packet = request.kind == GVE_REQUEST_COMMAND && request.command.opcode == GVE_PACKET_BEGIN ? true : packet;
        damage += request.kind == GVE_REQUEST_DAMAGE ? 1U : 0U;
        wait(SILENCE_TICKS);
    }
    TEST_ASSERT_GREATER_THAN_UINT(0, damage);
    take("!0F\r");
    assert_next(GVE_FLAGS);
    TEST_ASSERT_FALSE(request.packet);
}

void test_only_a_command_without_a_fault_is_kept_as_that_command(void)
{
    take("!0H1\r!0L!");
    wait(SILENCE_TICKS);
    TEST_ASSERT_FALSE(gve_line_keeps(&line, GVE_HALT));
    TEST_ASSERT_FALSE(gve_line_keeps(&line, GVE_VERSION));
}
