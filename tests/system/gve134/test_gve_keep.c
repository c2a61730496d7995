/* K and R, round everything that they keep. */
#include "gve_rig.h"

void setUp(void)
{
    rig_set_up();
    rig_expect("0V10000", "0");
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_INT64(rig_position[motor], step_channel_position(&unit.queue.channel[motor]));
    }
}

/* A path of 60 000 and 20 000 pulses, held on its way. */
static void hold_path(void)
{
    rig_expect("0L30000,20000", "0");
    rig_expect("0C30000,0", "0");
    rig_run_ms(1000);
    rig_expect("0H", "8");
}

static void bring_back(int64_t x, int64_t y)
{
    char line[100];
    (void)snprintf(line, sizeof line, "0L%d,%d", (int)(x - rig_position[0]), (int)(y - rig_position[1]));
    rig_expect(line, "0");
    rig_run_ms(10000);
    TEST_ASSERT_EQUAL_INT64(x, rig_position[0]);
    TEST_ASSERT_EQUAL_INT64(y, rig_position[1]);
}

void test_what_is_kept_goes_on_where_it_was(void)
{
    hold_path();
    int64_t x = rig_position[0];
    int64_t y = rig_position[1];
    rig_expect("0K", "0");
    rig_expect("0L-100,500,7", "0");
    rig_run_ms(1000);
    bring_back(x, y);
    rig_expect("0R", "8");
    rig_expect("0SR6", "8,D0");
    rig_expect("0G", "0");
    rig_run_ms(10000);
    rig_expect("0PF", "0,60000,20000,7");
}

void test_causes_are_kept_and_come_back(void)
{
    rig_expect("0SW1,80", "0");
    rig_expect("0SW3,00", "0");
    rig_expect("0L30000", "0");
    rig_run_ms(500);
    rig_input(8, false);
    rig_run_ms(1000);
    rig_expect("0SW4,05", "8");
    rig_expect("0SR5", "8,80");
    rig_expect("0K", "0");
    rig_expect("0SR4", "0,00");
    rig_expect("0SR5", "0,00");
    rig_expect("0SR6", "0,00");
    rig_expect("0R", "8");
    rig_expect("0SR4", "8,05");
    rig_expect("0SR5", "8,80");
    rig_expect("0SR6", "8,C0");
}

void test_an_empty_queue_is_kept_too(void)
{
    rig_expect("0K", "0");
    rig_expect("0SR6", "0,00");
    rig_expect("0L50", "0");
    rig_run_ms(1000);
    rig_expect("0R", "0");
    rig_expect("0SR6", "0,00");
    rig_expect("0C50", "0");
    rig_run_ms(1000);
    rig_expect("0P", "0,100,0");
}

void test_the_state_of_a_halt_at_rest_is_kept(void)
{
    rig_expect("0H", "8");
    rig_expect("0K", "0");
    rig_expect("0R", "8");
    rig_expect("0SR6", "8,90");
}

void test_after_k_there_is_room_for_one_l_and_for_no_c(void)
{
    hold_path();
    rig_expect("0K", "0");
    rig_expect("0C100", "1");
    rig_expect("0C0,0,0", "1");
    rig_expect("0F", "0,00");
    rig_expect("0L100", "0");
    rig_expect("0F", "0,60");
    rig_expect("0L100", "1");
    rig_expect("0C100", "1");
    rig_expect("0L0,0,0", "1");
    rig_run_ms(1000);
    rig_expect("0L0,0,0", "0");
    rig_expect("0F", "0,00");
}

void test_any_number_of_single_vectors_run_beside_what_is_kept(void)
{
    hold_path();
    int64_t x = rig_position[0];
    rig_expect("0K", "0");
    for (unsigned i = 0; i < 10; i++) {
        rig_expect(i % 2U == 0 ? "0L100,0,1" : "0L-100", "0");
        rig_run_ms(500);
        TEST_ASSERT_EQUAL_INT64(x + (i % 2U == 0 ? 100 : 0), rig_position[0]);
    }
    rig_expect("0R", "8");
    rig_expect("0G", "0");
    rig_run_ms(10000);
    rig_expect("0PF", "0,60000,20000,5");
}

void test_a_second_k_needs_r_first(void)
{
    hold_path();
    rig_expect("0K", "0");
    rig_expect("0K", "1");
    rig_expect("0L100", "0");
    rig_expect("0K", "7");
    rig_expect("0H", "8");
    rig_expect("0K", "9");
    rig_expect("0D", "0");
    rig_expect("0R", "8");
    rig_expect("0K", "0");
    rig_expect("0R", "8");
    rig_expect("0R", "E");
}

void test_r_while_axes_move_is_refused_and_nothing_is_lost(void)
{
    hold_path();
    rig_expect("0K", "0");
    rig_expect("0L3000", "0");
    rig_expect("0R", "7");
    rig_run_ms(2000);
    bring_back(rig_position[0] - 3000, rig_position[1]);
    rig_expect("0R", "8");
    rig_expect("0G", "0");
    rig_run_ms(10000);
    rig_expect("0P", "0,60000,20000");
}

void test_what_waits_beside_is_gone_after_r(void)
{
    hold_path();
    int64_t x = rig_position[0];
    rig_expect("0K", "0");
    rig_expect("0L5000", "0");
    rig_run_ms(200);
    rig_expect("0H", "8");
    rig_expect("0SR6", "8,D0");
    int64_t off = rig_position[0] - x;
    rig_expect("0R", "8");
    rig_expect("0G", "0");
    rig_run_ms(10000);
    TEST_ASSERT_GREATER_THAN_INT64(0, off);
    TEST_ASSERT_EQUAL_INT64(60000 + off, rig_position[0]);
}

void test_a_stop_beside_can_be_gone_on_with(void)
{
    hold_path();
    int64_t x = rig_position[0];
    rig_expect("0K", "0");
    rig_expect("0L5000", "0");
    rig_run_ms(200);
    rig_expect("0H", "8");
    rig_expect("0G", "0");
    rig_run_ms(2000);
    TEST_ASSERT_EQUAL_INT64(x + 5000, rig_position[0]);
}

void test_d_leaves_alone_what_is_kept(void)
{
    hold_path();
    rig_expect("0K", "0");
    rig_expect("0H", "8");
    rig_expect("0D", "0");
    rig_expect("0R", "8");
    rig_expect("0SR6", "8,D0");
    rig_expect("0G", "0");
    rig_run_ms(10000);
    rig_expect("0P", "0,60000,20000");
}

void test_d_after_r_deletes_it(void)
{
    hold_path();
    int64_t x = rig_position[0];
    rig_expect("0K", "0");
    rig_expect("0R", "8");
    rig_expect("0D", "0");
    rig_expect("0G", "6");
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_INT64(x, rig_position[0]);
}

void test_j_forgets_what_is_kept(void)
{
    hold_path();
    rig_expect("0K", "0");
    rig_expect("0J", "0");
    memset(rig_position, 0, sizeof rig_position);
    rig_expect("0R", "6");
    rig_expect("0C10", "0");
    rig_run_ms(1000);
    rig_expect("0P", "0,10,0");
}

void test_a_full_queue_is_kept_whole(void)
{
    rig_expect("0L10000", "0");
    for (unsigned i = 1; i < GVE_QUEUE_VECTORS; i++) {
        rig_expect(i % 2U == 0 ? "0C100,50" : "0C100,-50", "0");
    }
    rig_expect("0H", "8");
    int64_t x = rig_position[0];
    rig_expect("0K", "0");
    rig_expect("0L0,0,5", "0");
    rig_run_ms(1000);
    rig_expect("0R", "8");
    TEST_ASSERT_EQUAL_INT64(x, rig_position[0]);
    rig_expect("0C1", "9");
    rig_expect("0F", "8,F0");
    rig_expect("0G", "0");
    rig_run_ms(20000);
    rig_expect("0PF", "0,22700,-50,5");
}

void test_after_r_speeds_of_the_queue_can_be_changed(void)
{
    hold_path();
    int64_t left = 60000 - rig_position[0];
    rig_expect("0K", "0");
    rig_expect("0R", "8");
    rig_expect("0V1000", "8");
    rig_expect("0XA", "8");
    rig_expect("0G", "0");
    rig_run_ms((uint64_t)left - 1000U);
    TEST_ASSERT_LESS_THAN_INT64(60000, rig_position[0]);
    rig_run_ms(2000);
    rig_expect("0P", "0,60000,20000");
}

void test_a_packet_has_no_room_after_k_but_b_has(void)
{
    rig_expect("0K", "0");
    rig_send("!0*S\r!0C10\r");
    rig_expect("0*E1", "1,0");
    rig_send("!0*S\r!0C0,0,0\r");
    rig_expect("0*E1", "1,0");
    rig_send("!0*S\r!0B700\r");
    rig_expect("0*E1", "0,1");
    TEST_ASSERT_EQUAL_UINT32(700, unit.queue.modal.brake);
    rig_expect("0R", "0");
    rig_send("!0*S\r!0C10\r");
    rig_expect("0*E1", "0,1");
    rig_run_ms(1000);
}

void test_a_reference_run_is_made_beside_what_is_kept(void)
{
    hold_path();
    int64_t x = rig_position[0];
    rig_expect("0K", "0");
    rig_expect("0WZ-300,1000,50,1000", "D");
    rig_expect("0G", "6");
    rig_expect("0R", "8");
    rig_expect("0G", "0");
    rig_run_ms(10000);
    TEST_ASSERT_GREATER_THAN_INT64(0, x);
    rig_expect("0PF", "0,60000,20000,-300");
}
