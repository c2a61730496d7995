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

static void take_halts(void)
{
    for (unsigned i = 0; i < GVE_LINE_SPARED; i++) {
        take("!0H\r");
    }
}

/* More than all places are full: a command, and then silence, each time. */
static void poll_on_and_on(void)
{
    for (unsigned i = 0; i < 3 * GVE_LINE_SPARED; i++) {
        take("!0F\r");
        wait(SILENCE_TICKS);
    }
}

void test_damage_that_finds_no_room_is_told_once_when_there_is_some_before_what_comes_later(void)
{
    unsigned news = GVE_LINE_SPARED - GVE_LINE_SPARED_STOPS;
    unsigned taken = news + 2;
    fill();
    poll_on_and_on();
    for (unsigned i = 0; i < taken; i++) {
        assert_next(GVE_FLAGS);
    }
    take("!0V10\r");
    for (unsigned i = taken; i < GVE_LINE_KEPT - GVE_LINE_SPARED; i++) {
        assert_next(GVE_FLAGS);
    }
    for (unsigned i = 0; i < news + 1; i++) {
        assert_next_kind(GVE_REQUEST_DAMAGE);
    }
    assert_next(GVE_SPEED);
    assert_nothing();
}

void test_halt_is_heard_however_much_could_not_be_kept(void)
{
    fill();
    poll_on_and_on();
    take("!0H\r");
    TEST_ASSERT_TRUE(gve_line_keeps(&line, GVE_HALT));
}

void test_reset_is_heard_however_much_could_not_be_kept(void)
{
    fill();
    poll_on_and_on();
    take_halts();
    wait(SILENCE_TICKS);
    take("!0J\r");
    TEST_ASSERT_TRUE(gve_line_ends_with(&line, GVE_RESET));
    assert_next(GVE_RESET);
}

void test_halts_that_find_no_room_are_damage(void)
{
    fill();
    take_halts();
    take("!0H\r");
    wait(SILENCE_TICKS);
    empty();
    for (unsigned i = 0; i < GVE_LINE_SPARED; i++) {
        assert_next(GVE_HALT);
    }
    assert_next_kind(GVE_REQUEST_DAMAGE);
    assert_nothing();
}

void test_a_reset_finds_room_where_there_is_none(void)
{
    fill();
    take_halts();
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

void test_the_end_of_a_packet_fits_where_the_packet_fits_no_more(void)
{
    fill();
    (void)gve_line_next(&line, &request);
    take("!0*S\r!0C1\r!0C!0*S\r!0C1\r!0*E3\r!0*S\r!0C1\r!0*E1\r");
    wait(SILENCE_TICKS);
    for (unsigned i = 0; i < GVE_LINE_KEPT - GVE_LINE_SPARED - 1; i++) {
        assert_next(GVE_FLAGS);
    }
    assert_next(GVE_PACKET_BEGIN);
    assert_next_kind(GVE_REQUEST_BAD_LINE);
    assert_next(GVE_PACKET_END);
    assert_next_kind(GVE_REQUEST_DAMAGE);
    assert_nothing();
}

void test_only_a_command_without_a_fault_is_kept_as_that_command(void)
{
    take("!0H1\r!0L!");
    wait(SILENCE_TICKS);
    TEST_ASSERT_FALSE(gve_line_keeps(&line, GVE_HALT));
    TEST_ASSERT_FALSE(gve_line_keeps(&line, GVE_VERSION));
}

void test_a_command_that_has_been_taken_is_kept_no_more_wherever_it_stood(void)
{
    take("!0F\r!0H\r!0F\r");
    assert_next(GVE_FLAGS);
    TEST_ASSERT_TRUE(gve_line_keeps(&line, GVE_HALT));
    assert_next(GVE_HALT);
    assert_next(GVE_FLAGS);
    take("!0F\r!0V10\r!0H\r");
    TEST_ASSERT_TRUE(gve_line_keeps(&line, GVE_HALT));
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(gve_line_next(&line, &request));
    }
    for (unsigned i = 6; i < GVE_LINE_KEPT; i++) {
        take("!0F\r");
        assert_next(GVE_FLAGS);
    }
    take("!0F\r");
    TEST_ASSERT_FALSE(gve_line_keeps(&line, GVE_HALT));
}
