/* Inputs that interrupt the motion, the causes that are told, and the positions that are latched. */
#include "gve_rig.h"

enum {
    MOST_TICKS = RIG_MS / 2, /* from the edge to the pulse from which on the path brakes */
};

/* Each interrupt with an input: what enables it, what makes high its active level, its bit as SR tells it. */
static const struct {
    unsigned input;
    const char *enable;
    const char *active_high;
    const char *status; /* that tells the cause */
    const char *cause;
} wires[] = {
    {1, "0SW0,01", "0SW2,01", "0SR4", "8,01"}, {2, "0SW0,02", "0SW2,02", "0SR4", "8,02"},
    {3, "0SW0,04", "0SW2,04", "0SR4", "8,04"}, {4, "0SW0,08", "0SW2,08", "0SR4", "8,08"},
    {7, "0SW1,40", "0SW3,40", "0SR5", "8,40"}, {8, "0SW1,80", "0SW3,80", "0SR5", "8,80"},
};

#define WIRES (sizeof wires / sizeof wires[0])

void setUp(void)
{
    rig_set_up();
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_INT64(rig_position[motor], step_channel_position(&unit.queue.channel[motor]));
    }
}

static void expect_latched(int64_t x, int64_t y, const char *digit)
{
    char text[100];
    (void)snprintf(text, sizeof text, "%s,%d,%d,0,0", digit, (int)x, (int)y);
    rig_expect("0PL", text);
}

void test_each_interrupt_stops_at_active_level_0_and_is_the_one_cause(void)
{
    for (unsigned i = 0; i < WIRES; i++) {
        rig_set_up();
        rig_expect(wires[i].enable, "0");
        rig_expect("0L10000", "0");
        rig_run_ms(200);
        rig_expect("0SR6", "0,40");
        rig_input(wires[i].input, false);
        rig_run_ms(200);
        rig_expect("0SR6", "8,C0");
        rig_expect(wires[i].status, wires[i].cause);
        rig_expect(i < 4 ? "0SR5" : "0SR4", "8,00");
    }
}

void test_each_interrupt_stops_at_active_level_1(void)
{
    for (unsigned i = 0; i < WIRES; i++) {
        rig_set_up();
        rig_input(wires[i].input, false);
        rig_expect(wires[i].enable, "0");
        rig_expect(wires[i].active_high, "0");
        rig_expect("0L10000", "0");
        rig_run_ms(200);
        rig_expect("0SR6", "0,40");
        rig_input(wires[i].input, true);
        rig_run_ms(200);
        rig_expect("0SR6", "8,C0");
        rig_expect(wires[i].status, wires[i].cause);
    }
}

void test_what_is_not_enabled_is_an_input_like_any_other(void)
{
    rig_expect("0L300", "0");
    for (unsigned i = 0; i < WIRES; i++) {
        rig_input(wires[i].input, false);
        rig_run_ms(20);
    }
    rig_expect("0I1", "0,F0");
    rig_expect("0I2", "0,3F");
    rig_expect("0SR6", "0,40");
    rig_run_ms(1000);
    rig_expect("0P", "0,300,0");
    rig_expect("0SR4", "0,00");
}

void test_ports_read_1_where_inputs_are_open(void)
{
    rig_expect("0I1", "0,FF");
    rig_expect("0I2", "0,FF");
    rig_input(2, false);
    rig_input(7, false);
    rig_expect("0I1", "0,FD");
    rig_expect("0I2", "0,BF");
}

void test_all_bits_of_the_status_bytes_are_kept(void)
{
    for (unsigned status = 0; status < 6; status++) {
        char text[20];
        (void)snprintf(text, sizeof text, "0SW%u,%X", status, 0xA5U ^ status);
        rig_expect(text, "0");
    }
    for (unsigned status = 0; status < 6; status++) {
        char command[20];
        char answer[20];
        (void)snprintf(command, sizeof command, "0SR%u", status);
        (void)snprintf(answer, sizeof answer, "0,%02X", 0xA5U ^ status);
        rig_expect(command, answer);
    }
}

void test_a_level_that_is_active_at_the_start_lets_no_pulse_come(void)
{
    rig_expect("0SW0,02", "0");
    rig_input(2, false);
    rig_expect("0SR6", "0,00");
    rig_expect("0L1000,-70", "0");
    rig_run_ms(5);
    rig_expect("0SR6", "8,C0");
    rig_expect("0SR4", "8,02");
    for (unsigned i = 0; i < 3; i++) {
        rig_expect("0G", "0");
        rig_run_ms(5);
        rig_expect("0SR6", "8,C0");
        rig_expect("0SR4", "8,02");
    }
    TEST_ASSERT_EQUAL_UINT(0, rig_pulses[0] + rig_pulses[1]);
    expect_latched(0, 0, "8");
    rig_input(2, true);
    rig_expect("0G", "0");
    rig_run_ms(2000);
    rig_expect("0P", "0,1000,-70");
}

void test_at_rest_and_while_a_path_waits_nothing_happens(void)
{
    rig_expect("0SW0,01", "0");
    rig_input(1, false);
    rig_run_ms(10);
    rig_expect("0SR6", "0,00");
    rig_input(1, true);
    rig_expect("0L1000", "0");
    rig_run_ms(100);
    rig_expect("0H", "8");
    rig_input(1, false);
    rig_run_ms(10);
    rig_expect("0SR4", "8,00");
    rig_expect("0SR6", "8,D0");
}

void test_a_level_of_100_us_is_seen_at_any_time(void)
{
    rig_expect("0SW1,40", "0");
    rig_expect("0V5000", "0");
    rig_expect("0L20000,7000", "0");
    for (unsigned i = 0; i < 25; i++) {
        rig_run_ticks((uint64_t)(37 + 11 * i) * RIG_MS / 3U);
        rig_input(7, false);
        rig_run_ticks(RIG_MS / 10);
        rig_input(7, true);
        rig_run_ms(300);
        rig_expect("0SR5", "8,40");
        rig_expect("0SR6", "8,C0");
        rig_expect("0G", "0");
    }
    rig_run_ms(10000);
    rig_expect("0P", "0,20000,7000");
}

void test_the_ramp_begins_half_a_millisecond_after_the_edge_at_the_latest(void)
{
    rig_expect("0SW0,01", "0");
    rig_expect("0V40000", "0");
    rig_expect("0A1000", "0");
    for (unsigned i = 0; i < 20; i++) {
        rig_expect("0L100000", "0");
        rig_run_ticks((uint64_t)200 * RIG_MS + i * 997U);
        int64_t edge = rig_position[0];
        rig_input(1, false);
        rig_run_ms(300);
        rig_input(1, true);
        int64_t ramp = INT64_C(40000) * 40000 / (2 * 1000000);
        int64_t most = INT64_C(40000) * MOST_TICKS / (int64_t)TICK_HZ + 1;
        TEST_ASSERT_TRUE(rig_position[0] >= edge + ramp - 1 && rig_position[0] <= edge + most + ramp);
        rig_expect("0D", "0");
    }
}

void test_the_positions_at_the_edge_are_latched_of_all_axes(void)
{
    rig_expect("0SW1,80", "0");
    rig_expect("0V20000", "0");
    rig_expect("0L30000,-20000", "0");
    rig_run_ms(1300);
    int64_t x = rig_position[0];
    int64_t y = rig_position[1];
    rig_input(8, false);
    rig_run_ms(2000);
    expect_latched(x, y, "8");
    rig_input(8, true);
    rig_expect("0H", "8");
    rig_expect("0G", "0");
    rig_run_ms(100);
    rig_expect("0H", "8");
    expect_latched(x, y, "8");
    rig_expect("0D", "0");
    rig_expect("0NX100", "0");
    rig_expect("0N", "0");
    expect_latched(x, y, "0");
    memset(rig_position, 0, sizeof rig_position);
}

void test_the_interrupt_that_begins_the_stop_is_latched_and_a_second_is_a_cause(void)
{
    rig_expect("0SW0,0F", "0");
    rig_expect("0SW1,C0", "0");
    rig_expect("0V20000", "0");
    rig_expect("0L60000", "0");
    rig_run_ms(1300);
    int64_t x = rig_position[0];
    rig_input(3, false);
    rig_run_ms(100);
    rig_input(3, true);
    rig_input(7, false);
    rig_run_ms(100);
    rig_input(7, true);
    rig_expect("0SR6", "0,41");
    rig_run_ms(2000);
    rig_input(1, false);
    rig_run_ms(10);
    expect_latched(x, 0, "8");
    rig_expect("0SR4", "8,04");
    rig_expect("0SR5", "8,40");
}

void test_two_interrupts_at_once_are_both_causes(void)
{
    rig_expect("0SW0,0F", "0");
    rig_expect("0L60000", "0");
    rig_run_ms(300);
    static const struct host_input both[] = {{0, 1, true}, {0, 4, true}};
    host_machine_set_script(&machine, both, 2);
    rig_run_ms(300);
    rig_expect("0SR4", "8,09");
}

void test_an_interrupt_while_the_axes_brake_for_a_halt_is_a_cause(void)
{
    rig_expect("0SW0,01", "0");
    rig_expect("0V20000", "0");
    rig_expect("0L60000", "0");
    rig_run_ms(1300);
    rig_expect("0SW6,01", "0");
    rig_run_ms(100);
    rig_input(1, false);
    rig_run_ms(2000);
    rig_expect("0SR4", "8,01");
    rig_expect("0SR6", "8,C0");
    expect_latched(0, 0, "8");
}

void test_enabling_what_is_active_stops_at_once(void)
{
    rig_input(2, false);
    rig_expect("0L60000", "0");
    rig_run_ms(300);
    rig_expect("0SW0,02", "0");
    rig_run_ms(300);
    rig_expect("0SR6", "8,C0");
    rig_expect("0SR4", "8,02");
    rig_expect("0SW0,00", "8");
    rig_expect("0SW2,04", "8");
    rig_expect("0G", "0");
    rig_run_ms(300);
    rig_expect("0SW0,04", "0");
    rig_run_ms(300);
    rig_expect("0SR4", "8,04");
}

void test_an_interrupt_on_the_last_ramp_leaves_nothing(void)
{
    rig_expect("0SW0,01", "0");
    rig_expect("0V20000", "0");
    rig_expect("0L40000", "0");
    rig_run_ms(2500);
    rig_input(1, false);
    rig_run_ms(1000);
    rig_expect("0P", "8,40000,0");
    rig_expect("0SR6", "8,80");
    rig_expect("0SR4", "8,01");
    rig_expect("0G", "6");
    rig_expect("0SR4", "0,00");
}

void test_an_interrupt_in_a_pause_lets_no_pulse_come(void)
{
    rig_expect("0SW0,01", "0");
    rig_expect("0T24", "0");
    rig_expect("0L50", "0");
    while (strcmp(rig_ask("0L50"), "1") == 0) {
    }
    rig_input(1, false);
    rig_run_ms(100);
    rig_input(1, true);
    rig_expect("0SR6", "8,C0");
    rig_expect("0P", "8,50,0");
    rig_expect("0G", "0");
    rig_run_ms(1000);
    rig_expect("0P", "0,100,0");
}

void test_causes_are_cleared_by_what_clears_them(void)
{
    static const char *const clearing[] = {"0G", "0D", "0K"};
    for (unsigned i = 0; i < 3; i++) {
        rig_set_up();
        rig_expect("0SW0,01", "0");
        rig_expect("0SW1,80", "0");
        rig_input(1, false);
        rig_input(8, false);
        rig_expect("0L100", "0");
        rig_run_ms(10);
        rig_expect("0SR4", "8,01");
        rig_input(1, true);
        rig_input(8, true);
        rig_expect("0SW4,00", "8");
        rig_expect("0SR4", "8,00");
        rig_expect("0SR5", "8,80");
        rig_expect(clearing[i], "0");
        rig_expect("0SR5", "0,00");
    }
}

void test_an_interrupt_at_any_time_leaves_a_path_that_can_be_gone_on_with(void)
{
    rig_expect("0SW1,40", "0");
    rig_expect("0V20000", "0");
    rig_expect("0A200", "0");
    for (unsigned i = 0; i < 100; i++) {
        rig_expect("0N", "0");
        memset(rig_position, 0, sizeof rig_position);
        rig_expect("0L700,-300", "0");
        rig_expect("0C-100,-300,9", "0");
        rig_expect("0C50,50,0,-1", "0");
        rig_run_ticks(i * 61979U);
        rig_input(7, false);
        rig_run_ms(200);
        rig_input(7, true);
        const char *answer = rig_ask("0G");
        TEST_ASSERT_TRUE(strcmp(answer, "0") == 0 || strcmp(answer, "6") == 0);
        rig_run_ms(200);
        rig_expect("0P4", "0,650,-550,9,-1");
        rig_expect("0SR6", "0,00");
    }
}
