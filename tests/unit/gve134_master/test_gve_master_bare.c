/* A unit that has no checksums any more, and commands of another program. */
#include "gve_master_rig.h"

void setUp(void)
{
    rig_set_up();
}

void tearDown(void)
{
}

/* Another program counts so many commands, and has switched checksums off. */
static void switch_sums_off(uint8_t count)
{
    unit.index = (uint8_t)(unit.index + count);
    unit.sums = unit.receiver.sums = false;
}

/* Until the index of the unit is that. */
static void ask_until(uint8_t index)
{
    while (unit.index != index) {
        TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("P"));
    }
}

void test_checksums_that_another_program_has_switched_off_are_no_restart(void)
{
    connect();
    ask_until(100);
    switch_sums_off(1);
    TEST_ASSERT_EQUAL(GVE_MASTER_SUMS_OFF, ask("C1"));
    TEST_ASSERT_EQUAL(0, executed);
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("C1"));
    TEST_ASSERT_EQUAL(1, executed);
    switch_sums_off(20);
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_CONNECT, ""));
    TEST_ASSERT_FALSE(master.restarted);
    TEST_ASSERT_EQUAL(GVE_MASTER_SUMS_OFF, master.others);
}

void test_a_packet_that_finds_no_checksums_is_no_restart(void)
{
    connect();
    ask_until(100);
    switch_sums_off(1);
    TEST_ASSERT_EQUAL(GVE_MASTER_SUMS_OFF, request(GVE_MASTER_PACKET, "C1\nC2\nC3"));
    TEST_ASSERT_EQUAL(0, executed);
}

void test_a_unit_that_moves_has_not_restarted(void)
{
    connect();
    ask_until(250);
    unit.index = 0;
    flags = "40";
    switch_sums_off(1);
    TEST_ASSERT_EQUAL(GVE_MASTER_SUMS_OFF, ask("C1"));
}

void test_a_unit_without_checksums_whose_positions_stay_is_not_told_to_have_restarted(void)
{
    connect();
    ask_until(100);
    unit.index = 0;
    positions = "1,0,0,0";
    switch_sums_off(1);
    TEST_ASSERT_EQUAL(GVE_MASTER_OUT_OF_STEP, ask("C1"));
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_CONNECT, ""));
}

void test_a_halt_finds_checksums_switched_off_and_tells_no_restart(void)
{
    connect();
    ask_until(100);
    switch_sums_off(1);
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_HALT, ""));
    TEST_ASSERT_FALSE(master.restarted);
    TEST_ASSERT_EQUAL(GVE_MASTER_SUMS_OFF, master.others);
    TEST_ASSERT_TRUE(unit.sums);
}

void test_whether_it_was_a_restart_is_not_known_where_the_index_could_be_both(void)
{
    connect();
    ask_until(0);
    gve_line_init(&unit, 0, 7);
    TEST_ASSERT_EQUAL(GVE_MASTER_OUT_OF_STEP, ask("C1"));
}

void test_positions_that_have_become_0_tell_a_restart_where_the_index_could_be_both(void)
{
    connect();
    ask_until(255);
    positions = "0,0,0,-5";
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("P4"));
    positions = "0,0,0,0";
    gve_line_init(&unit, 0, 7);
    TEST_ASSERT_EQUAL(GVE_MASTER_RESTARTED, ask("C1"));
}

void test_a_reset_whose_answer_got_lost_is_none_of_these(void)
{
    connect();
    ask_until(0);
    answers[0] = LOST;
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_RESET, "J"));
    TEST_ASSERT_TRUE(unit.sums);
}

void test_what_another_program_has_sent_is_noticed_when_that_is_asked_for(void)
{
    connect();
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, ask("C1"));
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_OWN, ""));
    unit.index++;
    TEST_ASSERT_EQUAL(GVE_MASTER_OUT_OF_STEP, request(GVE_MASTER_OWN, ""));
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_OWN, ""));
    TEST_ASSERT_EQUAL(1, executed);
}
