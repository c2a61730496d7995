/* What is answered when the axes stand, and the halt that always gets through. */
#include "gve_master_rig.h"

void setUp(void)
{
    rig_set_up();
}

void tearDown(void)
{
}

#define REFERENCE "WX-100,50,10,50"

static enum gve_master_end refer(void)
{
    return request(GVE_MASTER_LONG, REFERENCE);
}

void test_a_reference_run_is_answered_at_its_end(void)
{
    connect();
    home_ms = 20000;
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, refer());
    TEST_ASSERT_GREATER_THAN_UINT64(20000 * MS, now_ns);
    TEST_ASSERT_EQUAL(1, executed);
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("P"));
    TEST_ASSERT_EQUAL(0, master.repairs);
}

void test_a_reference_run_whose_answer_comes_to_harm_is_made_once(void)
{
    static const enum fault all[] = {LOST, DAMAGED, CUT};
    connect();
    for (unsigned i = 0; i < sizeof all / sizeof all[0]; i++) {
        answers[0] = all[i];
        TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, refer());
        TEST_ASSERT_EQUAL(i + 1, executed);
    }
}

void test_a_reference_run_that_comes_to_harm_is_sent_again(void)
{
    static const enum fault all[] = {LOST, DAMAGED, CUT};
    connect();
    for (unsigned i = 0; i < sizeof all / sizeof all[0]; i++) {
        requests[0] = all[i];
        TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, refer());
        TEST_ASSERT_EQUAL(i + 1, executed);
    }
}

void test_a_restart_during_a_reference_run_is_told(void)
{
    connect();
    begin(GVE_MASTER_LONG, REFERENCE);
    (void)pass();
    gve_line_init(&unit, 0, 7);
    home_ns = 0;
    TEST_ASSERT_EQUAL(GVE_MASTER_RESTARTED_PERHAPS, finish());
}

void test_a_reference_run_without_an_end_is_not_confirmed(void)
{
    connect();
    home_ms = 1000000;
    TEST_ASSERT_EQUAL(GVE_MASTER_NOT_CONFIRMED, refer());
}

void test_a_halt_gets_through_with_checksums_and_without(void)
{
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_HALT, ""));
    TEST_ASSERT_EQUAL(2, halts);
    TEST_ASSERT_EQUAL_STRING(UNIT, master.version);
    halts = 0;
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_HALT, ""));
    TEST_ASSERT_EQUAL(1, halts);
}

/* So a line that is mended in between has an H that its unit takes within a second. */
void test_a_halt_is_repeated_every_half_second(void)
{
    static const uint64_t waits_ms[] = {300, 300, 500, 500, 500, 500, 500, 500};
    off = true;
    begin(GVE_MASTER_HALT, "");
    (void)pass();
    uint64_t before_ns = now_ns;
    for (unsigned i = 0; i < sizeof waits_ms / sizeof waits_ms[0]; i++) {
        while (frames == i + 1) {
            TEST_ASSERT_EQUAL(GVE_MASTER_WAITS, pass());
        }
        TEST_ASSERT_UINT64_WITHIN(5 * MS, waits_ms[i] * MS, now_ns - before_ns);
        TEST_ASSERT_EQUAL(i % 2 == 0 ? 4 : 7, master.wire.sent.length);
        TEST_ASSERT_EQUAL(before_ns + waits_ms[i] * MS > 3000 * MS, master.long_halt);
        before_ns = now_ns;
    }
}

void test_a_halt_without_an_answer_is_not_confirmed(void)
{
    mute = true;
    TEST_ASSERT_EQUAL(GVE_MASTER_NOT_CONFIRMED, request(GVE_MASTER_HALT, ""));
    TEST_ASSERT_GREATER_THAN_UINT64(30000 * MS, now_ns);
}

void test_a_halt_ends_a_reference_run(void)
{
    connect();
    home_ms = 1000000;
    begin(GVE_MASTER_LONG, REFERENCE);
    for (unsigned ms = 0; ms < 2000; ms++) {
        (void)pass();
    }
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_HALT, ""));
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("P"));
}

void test_answers_to_something_else_do_not_confirm_a_halt(void)
{
    off = true;
    begin(GVE_MASTER_HALT, "");
    (void)pass();
    say("0,5C\r8,65\r8,D0,04\r0\r");
    for (unsigned ms = 0; ms < 200; ms++) {
        TEST_ASSERT_EQUAL(GVE_MASTER_WAITS, pass());
    }
    TEST_ASSERT_EQUAL(1, frames);
    say("8,64\r");
    (void)pass();
    (void)pass();
    TEST_ASSERT_EQUAL(2, frames);
    TEST_ASSERT_EQUAL_MEMORY("!0%+", master.wire.out, 4);
}

void test_a_restart_is_told_after_a_halt(void)
{
    connect();
    while (unit.index != 100) {
        TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("P"));
    }
    gve_line_init(&unit, 0, 7);
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_HALT, ""));
    TEST_ASSERT_TRUE(master.restarted);
}
