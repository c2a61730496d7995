#include "unity.h"

#include "base_tick.h"
#include "hal_run.h"
#include "hal_step.h"
#include "host_machine.h"

#include "given_pulses.h"

static struct host_machine machine;
static unsigned edges;
static unsigned simulated_edges;
static unsigned connections;
static uint64_t edge_tick;
static unsigned polarities;
static unsigned turns;
static uint64_t turn_tick;
static unsigned turn_motor;
static bool pin_backward;
static bool edge_backward;
static uint32_t lay_turned;

static void step_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    (void)motor;
    edges++;
    edge_tick = tick;
    edge_backward = backward;
}

static void simulated_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    (void)tick;
    (void)motor;
    (void)backward;
    simulated_edges++;
}

static void connection_seen(void *context, uint64_t tick, unsigned motor, bool connected)
{
    (void)context;
    TEST_ASSERT_EQUAL_UINT64(40, tick);
    TEST_ASSERT_EQUAL_UINT(2, motor);
    TEST_ASSERT_FALSE(connected);
    connections++;
}

static void polarity_seen(void *context, uint64_t tick, unsigned motor, bool falling, bool turned)
{
    (void)context;
    TEST_ASSERT_EQUAL_UINT64(machine.now, tick);
    TEST_ASSERT_EQUAL(machine.falling[motor], falling);
    TEST_ASSERT_EQUAL(machine.turned[motor], turned);
    polarities++;
}

static void direction_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    turns++;
    turn_tick = tick;
    turn_motor = motor;
    pin_backward = backward;
}

static void tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
}

static void plan_isr(void *context)
{
    (void)context;
}

static uint64_t main_pass(void *context)
{
    (void)context;
    return TICK_NEVER;
}

static void run_until(uint64_t until)
{
    host_machine_run(&machine, until, main_pass, NULL, NULL);
}

static void begin_at(uint64_t epoch)
{
    static const struct hal_client client = {.lay_isr = given_lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    given_clear();
    host_machine_init(&machine, epoch);
    machine.listener = (struct host_listener){
        .step = step_seen, .simulated = simulated_seen, .direction = direction_seen, .polarity = polarity_seen};
    host_machine_select(&machine);
    hal_run_start(&client);
}

void setUp(void)
{
    edges = 0;
    simulated_edges = 0;
    connections = 0;
    turns = 0;
    polarities = 0;
    begin_at(0);
}

void tearDown(void)
{
}

void test_a_pulse_comes_at_its_tick(void)
{
    lay_pulse(0, 840);

    run_until(10000);

    TEST_ASSERT_EQUAL_UINT64(840, edge_tick);
}

void test_a_pulse_beyond_the_wrap_of_the_counter_is_ahead(void)
{
    begin_at(UINT32_MAX);
    lay_pulse(0, 99);

    run_until(1000);

    TEST_ASSERT_EQUAL_UINT64(100, edge_tick);
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

void test_the_longest_way_ahead_is_half_of_the_counter(void)
{
    lay_pulse(0, INT32_MAX);

    run_until(UINT32_MAX);

    TEST_ASSERT_EQUAL_UINT64(INT32_MAX, edge_tick);
}

void test_a_pulse_for_the_present_tick_is_in_time(void)
{
    run_until(5000);
    lay_pulse(0, 5000);

    run_until(6000);

    TEST_ASSERT_EQUAL_UINT64(5000, edge_tick);
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

void test_a_pulse_for_a_tick_gone_by_comes_at_once_and_is_counted(void)
{
    run_until(5000);
    lay_pulse(0, 4999);

    run_until(6000);

    TEST_ASSERT_EQUAL_UINT64(5000, edge_tick);
    TEST_ASSERT_EQUAL_UINT64(1, machine.late_steps);
}

void test_a_pulse_that_waits_can_be_taken_back(void)
{
    lay_pulse(1, 100);

    TEST_ASSERT_EQUAL_UINT(1, take_back_given(1, 1));

    run_until(1000);
    TEST_ASSERT_EQUAL_UINT(0, edges);
}

void test_where_no_pulse_waits_none_is_taken_back(void)
{
    TEST_ASSERT_EQUAL_UINT(0, take_back_given(1, 1));
}

void test_a_pulse_cannot_be_taken_back_between_its_edge_and_its_interrupt(void)
{
    machine.faults.late_step_ticks = 50;
    lay_pulse(1, 100);
    run_until(120);

    TEST_ASSERT_EQUAL_UINT(0, take_back_given(1, 1));
    TEST_ASSERT_EQUAL_UINT(1, edges);
}

void test_a_direction_is_told_when_it_changes(void)
{
    run_until(40);

    hal_step_set_direction(2, true);
    hal_step_set_direction(2, true);

    TEST_ASSERT_EQUAL_UINT(1, turns);
    TEST_ASSERT_EQUAL_UINT64(40, turn_tick);
    TEST_ASSERT_EQUAL_UINT(2, turn_motor);
    TEST_ASSERT_TRUE(pin_backward);
}

void test_an_edge_tells_the_direction_of_its_motor(void)
{
    hal_step_set_direction(0, true);
    lay_pulse(0, 10);

    run_until(100);

    TEST_ASSERT_TRUE(edge_backward);
}

void test_a_disconnected_motor_runs_on_but_shows_no_edge(void)
{
    hal_step_connect(0, false);
    lay_pulse(0, 10);
    lay_pulse(1, 10);

    run_until(100);

    TEST_ASSERT_EQUAL_UINT(1, edges);
    TEST_ASSERT_EQUAL_UINT(1, simulated_edges);
    TEST_ASSERT_EQUAL_UINT64(2, machine.pulses);
}

void test_disconnecting_puts_the_direction_pin_to_0(void)
{
    hal_step_set_direction(1, true);
    hal_step_set_direction(2, true);

    hal_step_connect(1, false);

    TEST_ASSERT_EQUAL_UINT(3, turns);
    TEST_ASSERT_EQUAL_UINT(1, turn_motor);
    TEST_ASSERT_FALSE(pin_backward);
}

void test_a_connection_is_told_when_it_changes(void)
{
    machine.listener.connection = connection_seen;
    run_until(40);

    hal_step_connect(2, true);
    hal_step_connect(2, false);
    hal_step_connect(2, false);

    TEST_ASSERT_EQUAL_UINT(1, connections);
}

void test_a_direction_set_while_disconnected_shows_when_connected(void)
{
    hal_step_connect(3, false);
    hal_step_set_direction(3, true);
    TEST_ASSERT_EQUAL_UINT(0, turns);

    hal_step_connect(3, true);

    TEST_ASSERT_EQUAL_UINT(1, turns);
    TEST_ASSERT_TRUE(pin_backward);
}

void test_a_polarity_is_told_when_it_changes(void)
{
    run_until(40);

    hal_step_set_polarity(2, false, false);
    TEST_ASSERT_EQUAL_UINT(0, polarities);
    hal_step_set_polarity(2, true, false);
    hal_step_set_polarity(2, true, true);
    hal_step_set_polarity(2, true, true);

    TEST_ASSERT_EQUAL_UINT(2, polarities);
    TEST_ASSERT_TRUE(machine.falling[2]);
    TEST_ASSERT_TRUE(machine.turned[2]);
    TEST_ASSERT_FALSE(machine.falling[1]);
}

void test_steps_and_directions_are_told_as_if_polarity_were_not_there(void)
{
    hal_step_set_polarity(0, true, true);
    TEST_ASSERT_EQUAL_UINT(0, turns);

    hal_step_set_direction(0, true);
    lay_pulse(0, 10);
    run_until(100);

    TEST_ASSERT_EQUAL_UINT(1, turns);
    TEST_ASSERT_TRUE(pin_backward);
    TEST_ASSERT_EQUAL_UINT(1, edges);
    TEST_ASSERT_TRUE(edge_backward);
}

void test_a_restart_takes_polarities_back(void)
{
    hal_step_set_polarity(1, false, true);

    host_machine_restart(&machine);

    TEST_ASSERT_FALSE(machine.turned[1]);
    TEST_ASSERT_EQUAL_UINT(2, polarities);
}

void test_a_restart_connects_and_turns_the_pins_forward(void)
{
    hal_step_connect(3, false);
    hal_step_set_direction(3, true);
    hal_step_connect(3, true);
    hal_step_set_direction(0, true);
    hal_step_connect(0, false);

    host_machine_restart(&machine);

    TEST_ASSERT_TRUE(machine.connected[0]);
    TEST_ASSERT_TRUE(machine.connected[3]);
    TEST_ASSERT_FALSE(machine.backward[0]);
    TEST_ASSERT_FALSE(machine.backward[3]);
    TEST_ASSERT_FALSE(pin_backward);
}

void test_a_restart_takes_back_what_was_laid(void)
{
    lay_pulse(0, 100);
    host_machine_restart(&machine);

    run_until(200);

    TEST_ASSERT_EQUAL_UINT64(0, machine.pulses);
    TEST_ASSERT_EQUAL_UINT(0, waiting_given(0));
}

void test_planning_takes_no_time(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, hal_step_lead_ticks());
}

void test_a_machine_without_listener_runs_all_the_same(void)
{
    machine.listener = (struct host_listener){0};
    hal_step_set_direction(0, true);
    lay_pulse(0, 10);

    run_until(100);

    TEST_ASSERT_EQUAL_UINT64(1, machine.pulses);
}

/* Two pulses forward and two backward. */
static void lay_turn(uint32_t gap_ticks)
{
    give_way(1, 1000, false);
    give_way(1, 3000, false);
    give_way(1, 3000 + gap_ticks, true);
    lay_turned = 3000 + gap_ticks;
    give_way(1, 20000, true);
    run_given(1);
}

void test_a_direction_turns_between_pulses_once_the_one_before_has_been_held(void)
{
    machine.ahead_ticks = 20000;
    lay_turn(HOST_TURN_US * TICKS_PER_US);

    run_until(lay_turned + 1U);

    TEST_ASSERT_EQUAL_UINT(1, turns);
    TEST_ASSERT_EQUAL_UINT(1, turn_motor);
    TEST_ASSERT_TRUE(pin_backward);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(3000 + HOST_HOLD_TICKS, turn_tick);
    TEST_ASSERT_LESS_OR_EQUAL_UINT64(lay_turned - HOST_SETUP_TICKS, turn_tick);
    TEST_ASSERT_EQUAL_UINT64(lay_turned, edge_tick);
    TEST_ASSERT_TRUE(edge_backward);
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

void test_a_pulse_too_soon_after_a_turn_waits_for_the_direction_and_is_counted(void)
{
    lay_turn(500);

    run_until(19999);

    TEST_ASSERT_EQUAL_UINT64(turn_tick + HOST_SETUP_TICKS, edge_tick);
    TEST_ASSERT_EQUAL_UINT64(1, machine.late_steps);
}

void test_late_pulses_after_a_turn_keep_their_order(void)
{
    machine.ahead_ticks = 20000;
    run_until(5000);
    give_way(1, 1000, true);
    give_way(1, 2000, true);
    give_way(1, 3000, true);
    run_given(1);

    run_until(5000 + HOST_SETUP_TICKS);
    TEST_ASSERT_EQUAL_UINT(0, edges);
    run_until(5000 + HOST_SETUP_TICKS + 1U);

    TEST_ASSERT_EQUAL_UINT(3, edges);
    TEST_ASSERT_EQUAL_UINT64(5000 + HOST_SETUP_TICKS, edge_tick);
    TEST_ASSERT_EQUAL_UINT64(3, machine.late_steps);
}

void test_no_pulse_is_asked_for_while_a_direction_is_to_turn(void)
{
    machine.ahead_ticks = 20000;
    lay_turn(10000);
    TEST_ASSERT_EQUAL_UINT(3, waiting_given(1));

    run_until(3000 + HOST_HOLD_TICKS + 1U);

    TEST_ASSERT_EQUAL_UINT(2, waiting_given(1));
}

void test_a_turn_is_taken_back_with_the_pulses_after_it(void)
{
    machine.ahead_ticks = 20000;
    lay_turn(10000);
    TEST_ASSERT_EQUAL_UINT(1, take_back_given(1, 1));
    given[1].way[2] = GIVEN_FORWARD;

    run_until(lay_turned + 1U);

    TEST_ASSERT_EQUAL_UINT64(lay_turned, edge_tick);
    TEST_ASSERT_FALSE(edge_backward);
    TEST_ASSERT_EQUAL_UINT(0, turns);
}

void test_a_turn_that_is_taken_back_and_asked_for_again_is_held_from_the_pulse_that_stays(void)
{
    machine.ahead_ticks = 20000;
    lay_turn(10000);
    TEST_ASSERT_EQUAL_UINT(1, take_back_given(1, 1));
    run_given(1);

    run_until(lay_turned + 1U);

    TEST_ASSERT_EQUAL_UINT64(lay_turned, edge_tick);
    TEST_ASSERT_EQUAL_UINT64(3000 + HOST_HOLD_TICKS, turn_tick);
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

void test_where_all_is_taken_back_a_turn_is_held_from_the_last_pulse_that_was_made(void)
{
    machine.ahead_ticks = 20000;
    lay_turn(10000);
    run_until(3001);
    TEST_ASSERT_EQUAL_UINT(1, take_back_given(1, 1));
    run_given(1);

    run_until(lay_turned + 1U);

    TEST_ASSERT_EQUAL_UINT64(lay_turned, edge_tick);
    TEST_ASSERT_EQUAL_UINT64(3000 + HOST_HOLD_TICKS, turn_tick);
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

void test_a_turn_stays_while_a_pulse_after_it_does(void)
{
    machine.ahead_ticks = 20000;
    give_way(1, 1000, false);
    give_way(1, 10000, true);
    run_given(1);
    TEST_ASSERT_EQUAL_UINT(0, take_back_given(1, 0));

    run_until(5000);

    TEST_ASSERT_EQUAL_UINT(1, turns);
}

void test_host_and_header_agree_on_the_time_of_a_turn(void)
{
    TEST_ASSERT_EQUAL_UINT32(HOST_TURN_US, hal_step_turn_us());
}
