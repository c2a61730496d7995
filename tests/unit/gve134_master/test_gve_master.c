/* Connecting, commands and packets, and what gets lost of them. */
#include "gve_master_rig.h"

void setUp(void)
{
    rig_set_up();
}

void tearDown(void)
{
}

/* What has to be sent and is wrong in every way, then right. */
static const enum fault all_faults[] = {LOST, DAMAGED, CUT};

void test_connecting_switches_checksums_on_and_asks_who_is_there(void)
{
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_CONNECT, ""));
    TEST_ASSERT_TRUE(unit.sums);
    TEST_ASSERT_EQUAL_STRING(UNIT, master.version);
    TEST_ASSERT_EQUAL(unit.index, master.index);
    TEST_ASSERT_FALSE(master.restarted);
}

void test_checksums_that_are_on_stay_on(void)
{
    unit.sums = unit.receiver.sums = true;
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("P"));
    TEST_ASSERT_TRUE(unit.sums);
    TEST_ASSERT_EQUAL_STRING("0,-5", master.reply.values);
}

void test_checksums_are_switched_off_if_they_are_not_wanted(void)
{
    gve_master_init(&master, BAUD, GVE_MASTER_SUMS_NONE);
    unit.sums = unit.receiver.sums = true;
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("P"));
    TEST_ASSERT_FALSE(unit.sums);
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("C1"));
    TEST_ASSERT_EQUAL(1, executed);
}

void test_checksums_stay_as_they_are_for_who_wants_that(void)
{
    gve_master_init(&master, BAUD, GVE_MASTER_SUMS_KEPT);
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("P"));
    TEST_ASSERT_FALSE(unit.sums);
    gve_master_init(&master, BAUD, GVE_MASTER_SUMS_KEPT);
    unit.sums = unit.receiver.sums = true;
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("P"));
    TEST_ASSERT_TRUE(unit.sums);
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_HALT, ""));
    TEST_ASSERT_TRUE(unit.sums);
}

void test_the_second_command_goes_out_at_once(void)
{
    connect();
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("C1"));
    TEST_ASSERT_EQUAL(1, frames);
    TEST_ASSERT_EQUAL(1, executed);
    TEST_ASSERT_EQUAL(0, master.repairs);
}

void test_a_command_whose_answer_comes_to_harm_is_executed_once(void)
{
    connect();
    for (unsigned i = 0; i < sizeof all_faults / sizeof all_faults[0]; i++) {
        answers[0] = all_faults[i];
        TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("C1"));
        TEST_ASSERT_EQUAL(i + 1, executed);
        TEST_ASSERT_EQUAL(i + 1, master.repairs);
        TEST_ASSERT_EQUAL(unit.index, master.index);
    }
}

void test_a_command_that_comes_to_harm_is_sent_again(void)
{
    connect();
    for (unsigned i = 0; i < sizeof all_faults / sizeof all_faults[0]; i++) {
        requests[0] = all_faults[i];
        TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("C1"));
        TEST_ASSERT_EQUAL(i + 1, executed);
        TEST_ASSERT_EQUAL(unit.index, master.index);
    }
}

void test_a_refusal_that_got_lost_is_told_and_nothing_is_sent_again(void)
{
    connect();
    refusal = GVE_NO_ROOM;
    answers[0] = LOST;
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("C1"));
    TEST_ASSERT_EQUAL(GVE_NO_ROOM, master.reply.code);
    TEST_ASSERT_EQUAL(0, executed);
}

void test_a_packet_is_taken_as_a_whole(void)
{
    connect();
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_PACKET, "C1\nB500\nC2,3"));
    TEST_ASSERT_EQUAL_STRING("3", master.reply.values);
    TEST_ASSERT_EQUAL(3, executed);
    TEST_ASSERT_EQUAL(unit.index, master.index);
}

void test_a_packet_that_comes_to_harm_is_taken_once(void)
{
    connect();
    for (unsigned i = 0; i < sizeof all_faults / sizeof all_faults[0]; i++) {
        executed = 0;
        requests[0] = all_faults[i];
        TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_PACKET, "C1\nB500\nC2"));
        TEST_ASSERT_EQUAL(3, executed);
        answers[0] = all_faults[i];
        TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_PACKET, "C1\nB500\nC2"));
        TEST_ASSERT_EQUAL(6, executed);
    }
}

void test_a_packet_that_is_tried_once_is_not_sent_again(void)
{
    connect();
    requests[0] = DAMAGED;
    TEST_ASSERT_EQUAL(GVE_MASTER_NOT_TAKEN, request(GVE_MASTER_PACKET_ONCE, "C1\nC2"));
    TEST_ASSERT_EQUAL(0, executed);
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("C1"));
    TEST_ASSERT_EQUAL(1, executed);
}

void test_a_late_answer_that_looks_like_the_index_is_not_taken_for_it(void)
{
    connect();
    unit.index = 0;
    master.index = 0;
    answers[0] = answers[1] = LOST; /* of the command, of > */
    begin(GVE_MASTER_ASK, "C1");
    while (frames < 3) {
        (void)pass();
    }
    bytes_length = 0;
    say("0,0,BC\r"); /* as if nothing was executed, in front of the answer to @ */
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, finish());
    TEST_ASSERT_EQUAL(1, executed);
}

void test_where_the_last_answer_got_lost_too_three_have_to_agree(void)
{
    connect();
    answers[0] = LOST;
    (void)ask("C1");
    TEST_ASSERT_EQUAL(1 + 1 + 2, frames);
    frames = 0;
    answers[0] = answers[1] = LOST;
    (void)ask("C1");
    TEST_ASSERT_EQUAL(1 + 1 + 3 + 1, frames);
}

void test_an_answer_to_something_else_is_skipped(void)
{
    connect();
    off = true;
    begin(GVE_MASTER_ASK, "P");
    (void)pass();
    say("0,17,F0\r0,3C,FE\r0,3,4,5,7C\r");
    TEST_ASSERT_EQUAL(GVE_MASTER_WAITS, pass());
    TEST_ASSERT_EQUAL(GVE_MASTER_WAITS, pass());
    say("0,3,4,1B\r");
    TEST_ASSERT_EQUAL(GVE_MASTER_WAITS, pass());
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, pass());
    TEST_ASSERT_EQUAL_STRING("3,4", master.reply.values);
    TEST_ASSERT_EQUAL(1, frames);
}

void test_commands_of_somebody_else_are_noticed(void)
{
    connect();
    unit.index = 77;
    answers[0] = LOST;
    TEST_ASSERT_EQUAL(GVE_MASTER_OUT_OF_STEP, ask("C1"));
    TEST_ASSERT_EQUAL(1, executed);
}

void test_an_answer_that_is_overwritten_by_damage_is_told_as_not_known(void)
{
    connect();
    answers[0] = LOST;
    requests[1] = DAMAGED;
    TEST_ASSERT_EQUAL(GVE_MASTER_END_UNKNOWN, ask("C1"));
    TEST_ASSERT_EQUAL(1, executed);
}

/* ---- restarts ---- */

void test_a_command_is_not_for_a_unit_that_has_restarted(void)
{
    connect();
    gve_line_init(&unit, 0, 7);
    TEST_ASSERT_EQUAL(GVE_MASTER_RESTARTED, ask("C1"));
    TEST_ASSERT_EQUAL(0, executed);
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("C1"));
    TEST_ASSERT_FALSE(master.restarted);
}

void test_a_command_that_was_under_way_may_have_been_executed(void)
{
    connect();
    restarts = true;
    TEST_ASSERT_EQUAL(GVE_MASTER_RESTARTED_PERHAPS, ask("C1"));
    TEST_ASSERT_EQUAL(0, executed);
}

void test_what_looks_like_a_restart_is_proved(void)
{
    connect();
    answers[0] = BARE;
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("C1"));
    TEST_ASSERT_EQUAL(1, executed);
}

void test_what_looks_like_a_restart_when_connecting_again_is_proved_too(void)
{
    connect();
    answers[0] = BARE;
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_CONNECT, ""));
    TEST_ASSERT_FALSE(master.restarted);
}

void test_a_restart_is_told_when_connecting_again(void)
{
    connect();
    gve_line_init(&unit, 0, 7);
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_CONNECT, ""));
    TEST_ASSERT_TRUE(master.restarted);
}

void test_what_is_asked_for_after_a_silence_is_not_for_a_unit_that_has_restarted(void)
{
    connect();
    off = true;
    TEST_ASSERT_EQUAL(GVE_MASTER_SILENT, ask("C1"));
    off = false;
    gve_line_init(&unit, 0, 7);
    TEST_ASSERT_EQUAL(GVE_MASTER_RESTARTED, ask("C1"));
    TEST_ASSERT_EQUAL(0, executed);
    frames = 0;
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("C1"));
    TEST_ASSERT_EQUAL(1, frames);
}

void test_a_reset_that_was_asked_for_is_no_surprise(void)
{
    connect();
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_RESET, "J"));
    TEST_ASSERT_EQUAL(GVE_DONE, master.reply.code);
    TEST_ASSERT_FALSE(master.restarted);
    TEST_ASSERT_TRUE(unit.sums);
    answers[0] = LOST;
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_RESET, "!7J"));
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("P"));
}

/* ---- nobody, or somebody else ---- */

void test_nobody_is_silent(void)
{
    off = true;
    TEST_ASSERT_EQUAL(GVE_MASTER_SILENT, ask("C1"));
    TEST_ASSERT_EQUAL(4, frames);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64((200 + 1200 + 200 + 4 * 500) * MS, now_ns);
}

void test_a_unit_that_is_back_after_a_long_silence_gets_nothing_that_was_asked_for_before_it(void)
{
    static const uint8_t kinds[] = {GVE_MASTER_ASK, GVE_MASTER_PACKET, GVE_MASTER_PACKET_ONCE};
    connect();
    for (unsigned i = 0; i < sizeof kinds; i++) {
        off = true;
        begin(kinds[i], "C1");
        uint64_t begin_ns = now_ns;
        while (now_ns - begin_ns < 3500 * MS) {
            (void)pass();
        }
        off = false;
        TEST_ASSERT_EQUAL(GVE_MASTER_SILENT, finish());
        TEST_ASSERT_EQUAL(0, executed);
        connect();
    }
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("C1"));
    TEST_ASSERT_EQUAL(1, executed);
}

void test_a_line_that_only_sends_back_is_an_echo(void)
{
    off = echo = true;
    TEST_ASSERT_EQUAL(GVE_MASTER_ECHOED, ask("C1"));
}

void test_an_echo_beside_a_unit_is_no_answer(void)
{
    echo = true;
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("P"));
    TEST_ASSERT_EQUAL_STRING("0,-5", master.reply.values);
}

void test_garbage_is_told(void)
{
    off = true;
    begin(GVE_MASTER_ASK, "C1");
    enum gve_master_end end = GVE_MASTER_WAITS;
    while (end == GVE_MASTER_WAITS) {
        say("error: 20\r\n");
        end = pass();
    }
    TEST_ASSERT_EQUAL(GVE_MASTER_GARBLED, end);
}

void test_noise_without_an_end_ends_a_request_all_the_same(void)
{
    off = true;
    begin(GVE_MASTER_ASK, "C1");
    enum gve_master_end end = GVE_MASTER_WAITS;
    while (end == GVE_MASTER_WAITS) {
        say("\377U");
        end = pass();
        TEST_ASSERT_LESS_THAN_UINT64(6000 * MS, now_ns);
    }
    TEST_ASSERT_EQUAL(GVE_MASTER_GARBLED, end);
}

void test_another_device_of_this_line_is_named(void)
{
    name = "LATHE/7 v2";
    TEST_ASSERT_EQUAL(GVE_MASTER_OTHER_DEVICE, ask("C1"));
    TEST_ASSERT_EQUAL_STRING("LATHE/7 v2", master.heard.other);
    TEST_ASSERT_EQUAL(0, executed);
}

void test_an_answer_in_pieces_is_waited_for_beyond_the_patience(void)
{
    static const uint8_t pieces[] = "0,3,4,1B\r";
    connect();
    off = true;
    begin(GVE_MASTER_ASK, "P");
    (void)pass();
    now_ns += 460 * MS;
    for (uint32_t i = 0; i + 1 < sizeof pieces; i++) {
        TEST_ASSERT_EQUAL(GVE_MASTER_WAITS, gve_master_poll(&master, now_ns));
        gve_master_take(&master, pieces + i, 1, now_ns);
        now_ns += 10 * MS;
    }
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, gve_master_poll(&master, now_ns));
    TEST_ASSERT_EQUAL_STRING("3,4", master.reply.values);
    TEST_ASSERT_GREATER_THAN_UINT64(500 * MS, now_ns);
}

void test_the_rest_of_a_line_that_had_begun_to_come_is_no_answer(void)
{
    connect();
    gve_master_take(&master, (const uint8_t *)"8,6", 3, now_ns);
    begin(GVE_MASTER_CONNECT, "");
    (void)gve_master_poll(&master, now_ns);
    gve_master_take(&master, (const uint8_t *)"4\r", 2, now_ns + MS);
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, finish());
    TEST_ASSERT_FALSE(master.restarted);
    TEST_ASSERT_EQUAL(4, frames);
}

void test_what_is_forgotten_is_connected_to_anew(void)
{
    connect();
    begin(GVE_MASTER_ASK, "C1");
    (void)pass();
    gve_master_forget(&master);
    frames = 0;
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("P"));
    TEST_ASSERT_GREATER_THAN(1, frames);
    TEST_ASSERT_EQUAL(1, executed);
}

void test_the_writing_of_memory_is_waited_for_longer(void)
{
    connect();
    off = true;
    uint64_t begin_ns = now_ns;
    begin(GVE_MASTER_ASK, "EW05,FF");
    (void)pass();
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(begin_ns + 2500 * MS, master.wire.until_ns);
}
