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

void test_the_rest_of_a_damaged_line_is_no_line(void)
{
    take("!0*S\r!0C2");
    take_byte('2', true);
    take("x0F\r0F\r!0*E1\r");
    assert_next(GVE_PACKET_BEGIN);
    assert_next_kind(GVE_REQUEST_BAD_LINE);
    assert_next(GVE_PACKET_END);
    assert_nothing();
}
