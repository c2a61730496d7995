#include "base_tick.h"
#include "epoch.h"
#include "hal_run.h"
#include "hal_step.h"
#include "host_machine.h"
#include "step_channel.h"
#include "step_scale.h"
#include "unity.h"

/* Channels on the host machine: what arrives at the pins, however far ahead pulses are laid. */

enum {
    INTERVAL = 84000,
    AHEAD = 7 * INTERVAL + 5,
    EDGES_MAX = 64,
    MOTOR = 1
};

static struct host_machine machine;
static struct step_channel channels[UNIT_MOTORS];
static uint64_t edge_ticks[EDGES_MAX];
static bool edge_backward[EDGES_MAX];
static unsigned edges;

static void edge_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    (void)motor;
    TEST_ASSERT_LESS_THAN_UINT(EDGES_MAX, edges);
    edge_ticks[edges] = tick;
    edge_backward[edges] = backward;
    edges++;
}

static unsigned lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    (void)context;
    return step_channel_lay_isr(&channels[motor], room);
}

/* A limit switch: any input ends the move. */
static void tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
    step_channel_halt(&channels[MOTOR]);
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

static void start_machine(uint64_t epoch)
{
    static const struct hal_client client = {.lay_isr = lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    host_machine_init(&machine, epoch);
    machine.listener.step = edge_seen;
    host_machine_select(&machine);
    hal_run_start(&client);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        step_channel_init(&channels[motor], motor);
    }
}

static void begin_move(unsigned motor, uint32_t interval_ticks, uint32_t steps, bool backward)
{
    uint32_t start_tick = (uint32_t)(machine.epoch + machine.now);
    struct step_segment segment = {
        .slope = STEP_QUANTA / interval_ticks,
        .tick = start_tick,
        .pace_ticks = interval_ticks,
        .steps = steps,
    };
    step_generator_aim(&segment, interval_ticks);
    step_channel_begin(&channels[motor], start_tick, backward);
    step_channel_push(&channels[motor], &segment);
    step_channel_run(&channels[motor]);
}

static void run(void)
{
    host_machine_run(&machine, TICK_NEVER, main_pass, NULL, NULL);
}

void setUp(void)
{
    edges = 0;
    start_machine(epoch_random());
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, machine.late_steps, "late pulses");
}

static void lay_ahead(void)
{
    machine.ahead_ticks = AHEAD;
}

static unsigned waiting(unsigned motor)
{
    hal_step_hold();
    unsigned count = hal_step_waiting(motor);
    hal_step_release();
    return count;
}

static void assert_edges(unsigned count, uint64_t interval_ticks)
{
    TEST_ASSERT_EQUAL_UINT(count, edges);
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_UINT64((i + 1U) * interval_ticks, edge_ticks[i]);
    }
}

void test_pulses_come_at_their_ticks(void)
{
    begin_move(MOTOR, INTERVAL, 20, false);

    run();

    assert_edges(20, INTERVAL);
}

void test_pulses_come_at_their_ticks_where_the_counter_wraps(void)
{
    start_machine((UINT64_C(7) << 32) - 5U * INTERVAL - 1U);
    begin_move(MOTOR, INTERVAL, 20, false);

    run();

    assert_edges(20, INTERVAL);
}

void test_the_direction_is_at_the_pin_with_every_pulse(void)
{
    begin_move(MOTOR, INTERVAL, 3, true);

    run();

    TEST_ASSERT_TRUE(edge_backward[0] && edge_backward[1] && edge_backward[2]);
    TEST_ASSERT_EQUAL_INT64(-3, step_channel_position(&channels[MOTOR]));
}

void test_four_channels_run_side_by_side(void)
{
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        begin_move(motor, INTERVAL / (motor + 1U), 10 + motor, motor % 2U == 1U);
    }

    run();

    TEST_ASSERT_EQUAL_UINT(10 + 11 + 12 + 13, edges);
    TEST_ASSERT_EQUAL_INT64(10, step_channel_position(&channels[0]));
    TEST_ASSERT_EQUAL_INT64(-13, step_channel_position(&channels[3]));
}

void test_a_halt_ends_the_pulses_at_once(void)
{
    static const struct host_input script[] = {{.tick = 5 * INTERVAL + 1, .input = 1, .level = true}};
    host_machine_set_script(&machine, script, 1);
    begin_move(MOTOR, INTERVAL, 20, false);

    run();

    assert_edges(5, INTERVAL);
    TEST_ASSERT_EQUAL_INT64(5, step_channel_position(&channels[MOTOR]));
    TEST_ASSERT_EQUAL_UINT32((uint32_t)machine.epoch + 5 * INTERVAL, step_channel_end_tick(&channels[MOTOR]));
}

void test_a_halt_between_a_pulse_and_its_late_interrupt_counts_the_pulse(void)
{
    static const struct host_input script[] = {{.tick = 5 * INTERVAL + 10, .input = 1, .level = true}};
    machine.faults.late_step_ticks = 20;
    host_machine_set_script(&machine, script, 1);
    begin_move(MOTOR, INTERVAL, 20, false);

    run();

    assert_edges(5, INTERVAL);
    TEST_ASSERT_FALSE(step_channel_is_running(&channels[MOTOR]));
    TEST_ASSERT_EQUAL_INT64(5, step_channel_position(&channels[MOTOR]));
}

void test_pulses_laid_ahead_come_at_their_ticks(void)
{
    lay_ahead();
    begin_move(MOTOR, INTERVAL, 20, false);
    TEST_ASSERT_EQUAL_UINT(8, waiting(MOTOR));

    run();

    assert_edges(20, INTERVAL);
    TEST_ASSERT_EQUAL_INT64(20, step_channel_position(&channels[MOTOR]));
    TEST_ASSERT_FALSE(step_channel_is_running(&channels[MOTOR]));
}

void test_pulses_laid_ahead_come_at_their_ticks_where_the_counter_wraps(void)
{
    start_machine((UINT64_C(7) << 32) - 5U * INTERVAL - 1U);
    lay_ahead();
    begin_move(MOTOR, INTERVAL, 20, false);

    run();

    assert_edges(20, INTERVAL);
}

void test_a_halt_takes_back_what_is_laid_ahead(void)
{
    static const struct host_input script[] = {{.tick = 5 * INTERVAL + 1, .input = 1, .level = true}};
    host_machine_set_script(&machine, script, 1);
    lay_ahead();
    begin_move(MOTOR, INTERVAL, 20, false);

    run();

    assert_edges(5, INTERVAL);
    TEST_ASSERT_FALSE(step_channel_is_running(&channels[MOTOR]));
    TEST_ASSERT_EQUAL_INT64(5, step_channel_position(&channels[MOTOR]));
    TEST_ASSERT_EQUAL_UINT32((uint32_t)machine.epoch + 5 * INTERVAL, step_channel_end_tick(&channels[MOTOR]));
}

void test_a_halt_leaves_what_other_channels_have_laid(void)
{
    static const struct host_input script[] = {{.tick = 5 * INTERVAL + 1, .input = 1, .level = true}};
    host_machine_set_script(&machine, script, 1);
    lay_ahead();
    begin_move(MOTOR, INTERVAL, 20, false);
    begin_move(MOTOR + 1, INTERVAL, 20, true);

    run();

    TEST_ASSERT_EQUAL_UINT(5 + 20, edges);
    TEST_ASSERT_EQUAL_INT64(-20, step_channel_position(&channels[MOTOR + 1]));
}

/* DIR changes only where no pulse waits: the backend asserts it. */
void test_a_motor_turns_after_the_last_pulse_and_after_a_halt(void)
{
    lay_ahead();
    begin_move(MOTOR, INTERVAL, 4, false);
    run();
    begin_move(MOTOR, INTERVAL, 4, true);
    step_channel_halt(&channels[MOTOR]);

    begin_move(MOTOR, INTERVAL, 3, false);
    run();

    TEST_ASSERT_EQUAL_UINT(4 + 3, edges);
    TEST_ASSERT_EQUAL_INT64(7, step_channel_position(&channels[MOTOR]));
}

/* Eight pulses wait, over the border of two segments, and main feeds the next one when the queue is empty. */
void test_a_queue_that_is_fed_while_its_last_pulses_wait_goes_on_in_time(void)
{
    struct step_segment more = {
        .slope = STEP_QUANTA / INTERVAL,
        .tick = (uint32_t)machine.epoch + 6 * INTERVAL,
        .pace_ticks = INTERVAL,
        .steps = 10,
    };
    step_generator_aim(&more, INTERVAL);
    lay_ahead();
    begin_move(MOTOR, INTERVAL, 6, false);
    TEST_ASSERT_EQUAL_UINT(6, waiting(MOTOR));
    host_machine_run(&machine, 2 * INTERVAL + 1, main_pass, NULL, NULL);

    TEST_ASSERT_TRUE(step_channel_push(&channels[MOTOR], &more));
    run();

    assert_edges(16, INTERVAL);
}
