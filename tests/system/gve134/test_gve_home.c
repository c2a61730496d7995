/* Reference runs, with a switch that follows the axis, at every place and in every phase. */
#include "gve_rig.h"

/* A switch of an axis: active while the axis is in its range. */
static struct {
    unsigned motor;
    int64_t from;
    int64_t to;
    uint64_t late_ticks; /* from the pulse to the edge */
} cam;

static struct host_input cam_edge;

static void step_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    rig_step(context, tick, motor, backward);
    if (motor == cam.motor) {
        bool active = rig_position[motor] >= cam.from && rig_position[motor] <= cam.to;
        cam_edge = (struct host_input){.tick = tick + cam.late_ticks, .input = (uint8_t)(motor + 1U), .level = active};
        host_machine_set_script(&machine, &cam_edge, 1);
    }
}

void setUp(void)
{
    rig_set_up();
    cam.motor = UNIT_MOTORS;
    cam.late_ticks = 1;
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_INT64(rig_position[motor], step_channel_position(&unit.queue.channel[motor]));
    }
}

static void put_cam(unsigned motor, int64_t from, int64_t to)
{
    rig_set_up();
    machine.listener.step = step_seen;
    cam.motor = motor;
    cam.from = from;
    cam.to = to;
    rig_input(motor + 1U, !(from <= 0 && to >= 0));
}

/* Begins a run and leaves it at once. */
static void begin(const char *command)
{
    char line[100];
    (void)snprintf(line, sizeof line, "!%s\r", command);
    rig_send(line);
    rig_heard_count = 0;
}

void test_a_run_ends_at_the_pulse_after_which_the_switch_let_go(void)
{
    static const struct {
        unsigned motor;
        int64_t from;
        int64_t to;
        const char *command;
        int64_t expected; /* the switch lets go after a pulse and before this one */
    } runs[] = {
        {0, -100000, -700, "0WX-20000,1000,5000,500", -698},  {0, 700, 100000, "0WX20000,1000,5000,500", 698},
        {1, -100000, -1, "0WY-20000,1000,5000,500", 1},       {2, -100000, -5000, "0WZ-5000,1000,9000,5000", -4998},
        {3, 30, 100000, "0WA20000,20000,1000,10", 28},        {3, 3000, 100000, "0WA,20000,20000,10000,20000", 2998},
        {0, -100000, -700, "0WX-20000,10,5000,200000", -698},
    };
    for (size_t i = 0; i < sizeof runs / sizeof runs[0]; i++) {
        put_cam(runs[i].motor, runs[i].from, runs[i].to);
        begin(runs[i].command);
        TEST_ASSERT_EQUAL_STRING_MESSAGE("0", rig_answer_within(200000), runs[i].command);
        TEST_ASSERT_EQUAL_INT64_MESSAGE(runs[i].expected, rig_position[runs[i].motor], runs[i].command);
        rig_expect("0SR6", "0,00");
    }
}

void test_a_run_ends_at_the_same_pulse_wherever_it_begins(void)
{
    for (int begin_at = 0; begin_at < 120; begin_at += 3) {
        char command[40];
        put_cam(0, -100000, -60);
        (void)snprintf(command, sizeof command, "0L%d", begin_at - 60);
        rig_expect(command, "0");
        rig_run_ms(1000);
        rig_expect("0WX-400,1500,400,700", "0");
        TEST_ASSERT_EQUAL_INT64(-58, rig_position[0]);
    }
}

void test_a_run_from_within_the_switch_leaves_it_only(void)
{
    put_cam(1, -50, 20);
    rig_expect("0WY-20000,1000,5000,500", "0");
    TEST_ASSERT_EQUAL_INT64(22, rig_position[1]);
    put_cam(1, -50, 20);
    rig_expect("0WY20000,1000,5000,500", "0");
    TEST_ASSERT_EQUAL_INT64(-52, rig_position[1]);
}

void test_a_narrow_switch_that_was_passed_lets_go_before_the_first_pulse_back(void)
{
    put_cam(0, 500, 503);
    rig_expect("0WX2000,8000,500,500", "0");
    int64_t passed = rig_position[0];
    TEST_ASSERT_GREATER_THAN_INT64(504, passed);
}

void test_a_switch_that_opens_when_it_is_hit_works_alike(void)
{
    put_cam(0, -699, 100000);
    rig_expect("0SW2,01", "0");
    rig_expect("0WX-20000,1000,5000,500", "0");
    TEST_ASSERT_EQUAL_INT64(-698, rig_position[0]);
}

void test_a_switch_that_is_not_found_is_an_error(void)
{
    rig_expect("0WX300,1000,5000,500", "D");
    TEST_ASSERT_EQUAL_INT64(300, rig_position[0]);
    rig_expect("0SR6", "8,80");
    rig_expect("0G", "6");
    rig_expect("0WX-301,1000,5000,500", "D");
    TEST_ASSERT_EQUAL_INT64(-1, rig_position[0]);
}

void test_a_switch_that_does_not_let_go_is_an_error(void)
{
    rig_input(1, false);
    rig_expect("0WX300,1000,50,500", "D");
    TEST_ASSERT_EQUAL_INT64(-50, rig_position[0]);
    rig_expect("0SR6", "8,80");
}

void test_a_switch_that_lets_go_after_the_last_pulse_has_not_let_go(void)
{
    put_cam(0, -49, 0);
    rig_expect("0WX300,1000,50,500", "D");
    TEST_ASSERT_EQUAL_INT64(-50, rig_position[0]);
    put_cam(0, -48, 0);
    rig_expect("0WX300,1000,50,500", "0");
    TEST_ASSERT_EQUAL_INT64(-50, rig_position[0]);
}

void test_a_switch_at_each_place_of_the_way_is_found(void)
{
    for (int place = 1; place < 60; place++) {
        put_cam(2, place, 100000);
        char where[20];
        (void)snprintf(where, sizeof where, "at %d", place);
        TEST_ASSERT_EQUAL_STRING_MESSAGE("0", rig_ask("0WZ60,2000,300,900"), where);
        TEST_ASSERT_EQUAL_INT64(place - 2, rig_position[2]);
    }
    put_cam(2, 61, 100000);
    rig_expect("0WZ60,2000,300,900", "D");
}

void test_the_own_switch_does_not_interrupt_though_it_is_enabled(void)
{
    put_cam(0, -100000, -700);
    rig_expect("0SW0,01", "0");
    rig_expect("0WX-20000,1000,5000,500", "0");
    TEST_ASSERT_EQUAL_INT64(-698, rig_position[0]);
    rig_expect("0SR4", "0,00");
    rig_expect("0PL", "0,0,0,0,0");
    rig_expect("0L-100", "0");
    rig_run_ms(1000);
    rig_expect("0SR4", "8,01");
}

void test_another_interrupt_ends_the_run_in_each_phase(void)
{
    /* To the switch, braking for it, away from it, braking, back. */
    for (unsigned ms = 10; ms < 3000; ms += 50) {
        put_cam(0, -100000, -700);
        rig_expect("0SW1,40", "0");
        rig_expect("0SW0,01", "0");
        rig_expect("0A5", "0");
        begin("0WX-20000,1000,5000,500");
        rig_run_ms(ms);
        if (rig_has_answer()) {
            TEST_ASSERT_GREATER_THAN(1000, ms);
            break;
        }
        int64_t edge = rig_position[0];
        rig_input(7, false);
        rig_run_ms(1);
        rig_input(7, true);
        TEST_ASSERT_EQUAL_STRING("8", rig_answer_within(1000));
        TEST_ASSERT_INT64_WITHIN(110, edge, rig_position[0]);
        rig_expect("0SR6", "8,80");
        rig_expect("0SR4", "8,00");
        rig_expect("0SR5", "8,40");
        char latched[60];
        (void)snprintf(latched, sizeof latched, "8,%d,0,0,0", (int)edge);
        rig_expect("0PL", latched);
        rig_expect("0G", "6");
    }
}

void test_of_two_interrupts_while_the_run_brakes_for_its_switch_the_first_is_latched(void)
{
    put_cam(0, -100000, -700);
    rig_expect("0SW1,C0", "0");
    rig_expect("0A5", "0");
    begin("0WX-20000,1000,5000,500");
    while (rig_position[0] > -710) {
        rig_run_ms(1);
    }
    int64_t edge = rig_position[0];
    rig_input(7, false);
    rig_run_ms(20);
    rig_input(8, false);
    TEST_ASSERT_EQUAL_STRING("8", rig_answer_within(1000));
    TEST_ASSERT_LESS_THAN_INT64(edge - 10, rig_position[0]);
    rig_expect("0SR5", "8,C0");
    char latched[60];
    (void)snprintf(latched, sizeof latched, "8,%d,0,0,0", (int)edge);
    rig_expect("0PL", latched);
}

void test_another_interrupt_that_stays_lets_no_pulse_come(void)
{
    rig_input(2, false);
    rig_expect("0SW0,02", "0");
    rig_expect("0WX-20000,1000,5000,500", "8");
    TEST_ASSERT_EQUAL_UINT(0, rig_pulses[0]);
    rig_expect("0SR4", "8,02");
    rig_expect("0SR6", "8,80");
}

void test_a_halt_ends_the_run_in_each_phase_and_is_answered_after_it(void)
{
    for (unsigned ms = 10; ms < 3000; ms += 50) {
        put_cam(0, -100000, -700);
        rig_expect("0A5", "0");
        begin("0WX-20000,1000,5000,500");
        rig_run_ms(ms);
        if (rig_has_answer()) {
            TEST_ASSERT_GREATER_THAN(1000, ms);
            break;
        }
        int64_t asked = rig_position[0];
        rig_send("!0H\r");
        rig_run_ms(1000);
        rig_heard[rig_heard_count] = '\0';
        TEST_ASSERT_EQUAL_STRING("8\r8\r", rig_heard);
        TEST_ASSERT_INT64_WITHIN(110, asked, rig_position[0]);
        rig_expect("0SR6", "8,90");
        rig_expect("0G", "6");
    }
}

void test_a_halt_that_waits_already_ends_a_run_before_its_first_pulse(void)
{
    rig_heard_count = 0;
    rig_send("!0?\r!0?\r!0WX-1000,1000,100,100\r!0H\r");
    rig_run_ms(4);
    rig_heard[rig_heard_count] = '\0';
    TEST_ASSERT_EQUAL_STRING("8\r8\r", &rig_heard[rig_heard_count - 4U]);
    TEST_ASSERT_EQUAL_UINT(0, rig_pulses[0]);
}

/* A host that does not wait has asked until nothing more is kept, and goes on, with pauses in which damage ends. */
static void begin_among_questions(void)
{
    put_cam(0, -2000000, -1000000);
    rig_expect("0A20", "0");
    begin("0WX-1000000,1000,10,500");
    for (unsigned i = 0; i < 100; i++) {
        rig_send("!0P\r");
        rig_run_ms(130);
    }
}

void test_a_halt_and_a_reset_act_at_once_whatever_could_not_be_kept(void)
{
    begin_among_questions();
    int64_t asked = rig_position[0];
    rig_send("!0H\r");
    rig_run_ms(1000);
    TEST_ASSERT_INT64_WITHIN(110, asked, rig_position[0]);
    rig_expect("0J", "0");
    begin_among_questions();
    rig_heard_count = 0;
    rig_send("!0J\r");
    TEST_ASSERT_EQUAL_STRING("0", rig_answer_within(2));
    unsigned made = rig_pulses[0];
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_UINT32(made, rig_pulses[0]);
    memset(rig_position, 0, sizeof rig_position);
}

void test_a_reset_ends_the_run_at_once_and_is_answered_alone(void)
{
    for (unsigned ms = 10; ms < 2500; ms += 100) {
        put_cam(0, -100000, -700);
        rig_expect("0A5", "0");
        begin("0WX-20000,1000,5000,500");
        rig_run_ms(ms);
        rig_heard_count = 0;
        rig_send("!0J\r");
        unsigned made = rig_pulses[0];
        TEST_ASSERT_EQUAL_STRING("0", rig_answer_within(2));
        rig_run_ms(1000);
        TEST_ASSERT_EQUAL_UINT32(0, rig_heard_count);
        TEST_ASSERT_EQUAL_UINT(made, rig_pulses[0]);
        rig_expect("0SR6", "0,00");
    }
    memset(rig_position, 0, sizeof rig_position);
}

void test_what_comes_during_a_run_is_executed_after_it(void)
{
    rig_send("!0WX-300,1000,50,500\r!0P\r!0H\r!0J\r");
    rig_run_ms(2);
    rig_heard[rig_heard_count] = '\0';
    TEST_ASSERT_EQUAL_STRING("0\r", rig_heard);
    rig_heard_count = 0;
    rig_send("!0WX-300,1000,50,500\r!0P\r!0SR6\r");
    rig_run_ms(2000);
    rig_heard[rig_heard_count] = '\0';
    TEST_ASSERT_EQUAL_STRING("D\r8,-300,0\r8,80\r", rig_heard);
}

void test_speeds_are_those_of_the_run_within_vl(void)
{
    rig_expect("0V50", "0");
    rig_expect("0XM1", "0");
    rig_expect("0VK", "0");
    rig_expect("0B10", "0");
    rig_expect("0T24", "0");
    rig_expect("0VL500,200000,200000,200000", "0");
    begin("0WX-1000,2000,50,500");
    uint64_t began = machine.now;
    TEST_ASSERT_EQUAL_STRING("D", rig_answer_within(3000));
    uint64_t took = (machine.now - began) / TICKS_PER_MS;
    TEST_ASSERT_UINT64_WITHIN(30, 2025, took); /* at 500, with ramps of 25 ms */
}

void test_a_coupled_axis_has_no_run_of_its_own_and_follows(void)
{
    rig_expect("0EW0C,01", "0");
    rig_expect("0WA-200,1000,50,500", "5");
    rig_expect("0WX-200,1000,50,500", "D");
    TEST_ASSERT_EQUAL_INT64(-200, rig_position[0]);
    TEST_ASSERT_EQUAL_INT64(-200, rig_position[3]);
}
