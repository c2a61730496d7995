#include "unity.h"

#include "base_tick.h"
#include "hal_run.h"
#include "hal_step.h"
#include "host_machine.h"

#include "given_pulses.h"

/* Pulses that are laid ahead and taken back. */

enum {
    AHEAD = 1000, /* ticks */
    INTERVAL = 300,
    LATE = 20
};

static struct host_machine machine;
static uint64_t edge_tick[GIVEN_MAX];
static unsigned edges;
static struct hal_step_room asked; /* as the last question began */
static unsigned questions;
static unsigned work_from; /* the question with which main has work, and the last such one */
static unsigned work_until;
static unsigned passes;
static uint64_t pass_tick;

static void step_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    (void)motor;
    (void)backward;
    edge_tick[edges++] = tick;
}

static unsigned lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    asked = *room;
    questions++;
    room->main_has_work = questions >= work_from && questions <= work_until;
    return given_lay_isr(context, motor, room);
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
    passes++;
    pass_tick = machine.now;
    return TICK_NEVER;
}

static void run_until(uint64_t until)
{
    host_machine_run(&machine, until, main_pass, NULL, NULL);
}

void setUp(void)
{
    static const struct hal_client client = {.lay_isr = lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    given_clear();
    edges = 0;
    questions = 0;
    passes = 0;
    work_from = 1;
    work_until = 0;
    host_machine_init(&machine, 0);
    machine.listener.step = step_seen;
    machine.ahead_ticks = AHEAD;
    host_machine_select(&machine);
    hal_run_start(&client);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

/* Pulses 1 to `count`, INTERVAL ticks apart. */
static void give_train(unsigned motor, uint32_t count)
{
    for (uint32_t pulse = 1; pulse <= count; pulse++) {
        give(motor, pulse * INTERVAL);
    }
}

static void assert_edges(unsigned count)
{
    TEST_ASSERT_EQUAL_UINT(count, edges);
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_UINT64((i + 1U) * INTERVAL, edge_tick[i]);
    }
}

/* 300, 600, 900, and 1200 as the first beyond 1000. */
void test_pulses_are_laid_up_to_the_first_one_beyond_the_way_ahead(void)
{
    give_train(0, 20);

    run_given(0);

    TEST_ASSERT_EQUAL_UINT(4, waiting_given(0));
}

void test_a_pulse_at_the_end_of_the_way_ahead_is_the_last_one_laid(void)
{
    machine.ahead_ticks = 3 * INTERVAL;
    give_train(0, 20);

    run_given(0);

    TEST_ASSERT_EQUAL_UINT(3, waiting_given(0));
}

void test_pulses_laid_ahead_come_at_their_ticks(void)
{
    give_train(0, 20);
    run_given(0);

    run_until(TICK_NEVER);

    assert_edges(20);
}

void test_each_pulse_that_is_made_lets_one_more_be_laid(void)
{
    give_train(0, 20);
    run_given(0);

    run_until(5 * INTERVAL + 1);

    TEST_ASSERT_EQUAL_UINT(5, edges);
    TEST_ASSERT_EQUAL_UINT(4, waiting_given(0));
}

void test_a_question_tells_the_pulses_that_wait_and_the_end_of_the_way_ahead(void)
{
    give_train(0, 20);
    run_given(0);
    TEST_ASSERT_EQUAL_UINT(3, asked.waiting);
    TEST_ASSERT_EQUAL_UINT32(AHEAD, asked.until_tick);

    run_until(INTERVAL + 1);

    TEST_ASSERT_EQUAL_UINT(3, asked.waiting);
    TEST_ASSERT_EQUAL_UINT32(INTERVAL + AHEAD, asked.until_tick);
    TEST_ASSERT_EQUAL_UINT32(HOST_PULSE_TICKS, asked.high_ticks);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(1, asked.count);
}

void test_a_pulse_far_away_is_laid_if_it_is_the_only_one(void)
{
    give(0, 50 * AHEAD);
    give(0, 51 * AHEAD);

    run_given(0);

    TEST_ASSERT_EQUAL_UINT(1, waiting_given(0));
    run_until(TICK_NEVER);
    TEST_ASSERT_EQUAL_UINT(2, edges);
    TEST_ASSERT_EQUAL_UINT64(51 * AHEAD, edge_tick[1]);
}

void test_no_more_pulses_wait_than_there_are_places(void)
{
    machine.ahead_ticks = TICK_HZ;
    give_train(0, 3 * HOST_LAID_MAX);

    run_given(0);

    TEST_ASSERT_EQUAL_UINT(HOST_LAID_MAX, waiting_given(0));
    run_until(TICK_NEVER);
    assert_edges(3 * HOST_LAID_MAX);
}

void test_the_client_is_asked_once_more_when_the_last_pulse_has_been_made_and_then_rests(void)
{
    give_train(0, 2);
    run_given(0);

    run_until(TICK_NEVER);
    TEST_ASSERT_EQUAL_UINT(0, asked.waiting);
    unsigned before = questions;
    run_until(10 * TICK_HZ);

    TEST_ASSERT_EQUAL_UINT(before, questions);
}

void test_pulses_given_while_the_last_ones_wait_are_laid_with_the_next_edge(void)
{
    give_train(0, 2);
    run_given(0);
    run_until(INTERVAL);
    give(0, 3 * INTERVAL);

    run_until(TICK_NEVER);

    assert_edges(3);
}

void test_the_last_pulses_laid_are_taken_back_first(void)
{
    give_train(0, 4);
    run_given(0);

    TEST_ASSERT_EQUAL_UINT(3, take_back_given(0, 3));

    TEST_ASSERT_EQUAL_UINT(1, waiting_given(0));
    run_until(INTERVAL);
    TEST_ASSERT_EQUAL_UINT(0, edges);
}

void test_no_more_pulses_are_taken_back_than_wait(void)
{
    give_train(0, 4);
    run_given(0);
    run_until(2 * INTERVAL + 1);

    TEST_ASSERT_EQUAL_UINT(2, take_back_given(0, 100));

    TEST_ASSERT_EQUAL_UINT(0, waiting_given(0));
    run_until(TICK_NEVER);
    assert_edges(2);
}

void test_what_was_taken_back_is_laid_again_by_a_run(void)
{
    for (unsigned back = 1; back <= 4; back++) {
        setUp();
        give_train(0, 20);
        run_given(0);
        run_until(INTERVAL + 1);
        TEST_ASSERT_EQUAL_UINT(back, take_back_given(0, back));

        run_given(0);

        TEST_ASSERT_EQUAL_UINT(4, waiting_given(0));
        run_until(TICK_NEVER);
        assert_edges(20);
    }
}

/* Others take their place, one of them for the present tick. */
void test_other_pulses_are_laid_for_those_taken_back(void)
{
    give_train(0, 4);
    run_given(0);
    run_until(INTERVAL + 1);
    TEST_ASSERT_EQUAL_UINT(3, take_back_given(0, 3));
    given[0].tick[1] = INTERVAL + 1;
    given[0].tick[2] = INTERVAL + 7;
    given[0].count = 3;

    run_given(0);

    run_until(TICK_NEVER);
    TEST_ASSERT_EQUAL_UINT(3, edges);
    TEST_ASSERT_EQUAL_UINT64(INTERVAL + 1, edge_tick[1]);
    TEST_ASSERT_EQUAL_UINT64(INTERVAL + 7, edge_tick[2]);
}

void test_motors_have_their_pulses_apart(void)
{
    give_train(0, 20);
    give(3, 450);
    give(3, 460);
    run_given(0);
    run_given(3);

    TEST_ASSERT_EQUAL_UINT(1, take_back_given(3, 1));

    TEST_ASSERT_EQUAL_UINT(4, waiting_given(0));
    TEST_ASSERT_EQUAL_UINT(1, waiting_given(3));
    TEST_ASSERT_EQUAL_UINT(0, waiting_given(1));
}

void test_pulses_laid_ahead_come_beyond_the_wrap_of_the_counter(void)
{
    host_machine_init(&machine, UINT32_MAX - 2U * INTERVAL);
    machine.listener.step = step_seen;
    machine.ahead_ticks = AHEAD;
    static const struct hal_client client = {.lay_isr = lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    hal_run_start(&client);
    for (uint32_t pulse = 1; pulse <= 10; pulse++) {
        give(0, UINT32_MAX - 2U * INTERVAL + pulse * INTERVAL);
    }
    run_given(0);
    TEST_ASSERT_EQUAL_UINT(4, waiting_given(0));

    run_until(TICK_NEVER);

    assert_edges(10);
}

/* The hardware makes what has been laid without any code. */
void test_a_late_interrupt_delays_no_pulse_that_is_laid(void)
{
    machine.faults.late_step_ticks = 2 * INTERVAL;
    give_train(0, 20);
    run_given(0);

    run_until(TICK_NEVER);

    assert_edges(20);
}

void test_a_pulse_between_an_edge_and_its_late_interrupt_does_not_wait_any_more(void)
{
    machine.faults.late_step_ticks = LATE;
    give_train(0, 20);
    run_given(0);

    run_until(INTERVAL + 1);

    TEST_ASSERT_EQUAL_UINT(3, waiting_given(0));
    run_until(INTERVAL + LATE + 1);
    TEST_ASSERT_EQUAL_UINT(4, waiting_given(0));
}

void test_main_is_woken_if_a_question_of_an_interrupt_gives_it_work(void)
{
    give_train(0, 1);
    run_given(0);
    work_from = questions + 1U;
    work_until = work_from;

    run_until(TICK_HZ);

    TEST_ASSERT_EQUAL_UINT(2, passes);
    TEST_ASSERT_EQUAL_UINT64(INTERVAL + HOST_PULSE_TICKS, pass_tick);
}

/* After the first edge there is time for three more pulses. */
void test_main_is_woken_if_the_first_of_several_questions_gives_it_work(void)
{
    give_train(0, 4);
    run_given(0);
    for (uint32_t i = 0; i < 3; i++) {
        give(0, INTERVAL + AHEAD - 2U + i);
    }
    work_from = questions + 1U;
    work_until = work_from;

    run_until(2 * INTERVAL);

    TEST_ASSERT_EQUAL_UINT(work_from + 2U, questions);
    TEST_ASSERT_EQUAL_UINT64(INTERVAL + HOST_PULSE_TICKS, pass_tick);
}

void test_main_sleeps_on_if_no_question_gives_it_work(void)
{
    give_train(0, 20);
    run_given(0);

    run_until(TICK_HZ);

    TEST_ASSERT_EQUAL_UINT(1, passes);
}

void test_a_motor_turns_only_after_its_last_pulse_that_waits(void)
{
    give_train(0, 4);
    run_given(0);
    TEST_ASSERT_EQUAL_UINT(4, take_back_given(0, 4));

    hal_step_set_direction(0, true);

    TEST_ASSERT_TRUE(machine.backward[0]);
}
