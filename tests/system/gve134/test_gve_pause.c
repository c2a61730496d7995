/* When chains begin: T, vectors that come too late to join, what begins a chain. */
#include "gve_rig.h"

enum {
    /* With A20 the first pulse comes the root of 2/20 000 s after the start, which is 10 ms. */
    FIRST_TICKS = 10 * RIG_MS,
    START_TICKS_MAX = RIG_MS,
};

static uint64_t first_tick; /* of the first pulse since it was set to 0 */

static void step_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    first_tick = first_tick == 0 ? tick : first_tick;
    rig_step(context, tick, motor, backward);
}

void setUp(void)
{
    rig_set_up();
    machine.listener.step = step_seen;
    first_tick = 0;
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_INT64(rig_position[motor], step_channel_position(&unit.queue.channel[motor]));
    }
}

static uint64_t last_pulse(void)
{
    uint64_t last = 0;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        last = rig_pulse_tick[motor] > last ? rig_pulse_tick[motor] : last;
    }
    return last;
}

/* Sends a command when what is in progress lets it be taken; returns the tick of its CR. */
static uint64_t enter(const char *command)
{
    char line[100];
    (void)snprintf(line, sizeof line, "!%s\r", command);
    for (unsigned i = 0; i < 10000; i++) {
        rig_heard_count = 0;
        uint64_t end = machine.now + strlen(line) * (uint64_t)RIG_BYTE_TICKS;
        rig_send(line);
        if (strcmp(rig_answer_within(10), "1") != 0) {
            return end;
        }
    }
    TEST_FAIL_MESSAGE(command);
    return 0;
}

/* The start of the chain that begins next, within some time. */
static uint64_t next_start(uint64_t ms)
{
    first_tick = 0;
    rig_run_ms(ms);
    TEST_ASSERT_NOT_EQUAL(0, first_tick);
    return first_tick - (uint64_t)FIRST_TICKS;
}

void test_a_vector_begins_within_a_millisecond_of_its_cr(void)
{
    uint64_t cr = enter("0L100");
    uint64_t start = next_start(1000);
    TEST_ASSERT_TRUE(start > cr && start <= cr + (uint64_t)START_TICKS_MAX);
}

void test_the_first_vector_of_all_has_no_pause(void)
{
    rig_expect("0T24", "0");
    uint64_t cr = enter("0L100");
    TEST_ASSERT_LESS_OR_EQUAL_UINT64(cr + (uint64_t)START_TICKS_MAX, next_start(1000));
}

void test_each_pause_is_from_the_last_pulse_to_the_start(void)
{
    rig_expect("0L30,70,-5", "0");
    for (unsigned ms = 3; ms <= 24; ms += 3) {
        char pause[20];
        (void)snprintf(pause, sizeof pause, "0T%u", ms);
        rig_expect(pause, "0");
        (void)enter("0L30,70,-5");
        uint64_t last = last_pulse();
        TEST_ASSERT_UINT64_WITHIN(1, last + ms * (uint64_t)TICKS_PER_MS, next_start(50));
    }
    rig_run_ms(1000);
}

void test_the_pause_is_also_made_before_a_c_that_begins_a_chain(void)
{
    rig_expect("0T20", "0");
    rig_expect("0L50", "0");
    (void)enter("0L0,0,0");
    (void)enter("0C50");
    uint64_t last = last_pulse();
    TEST_ASSERT_UINT64_WITHIN(1, last + (uint64_t)20 * TICKS_PER_MS, next_start(50));
    rig_run_ms(1000);
}

void test_a_vector_has_the_pause_that_it_was_entered_with(void)
{
    rig_expect("0T24", "0");
    rig_expect("0L50", "0");
    (void)enter("0L60");
    uint64_t last = last_pulse();
    rig_expect("0T1", "0");
    TEST_ASSERT_UINT64_WITHIN(1, last + (uint64_t)24 * TICKS_PER_MS, next_start(50));
    rig_run_ms(1000);
}

void test_the_pause_after_a_stop_begins_with_the_last_pulse(void)
{
    rig_expect("0T24", "0");
    rig_expect("0L5000,1234", "0");
    rig_run_ms(777);
    rig_expect("0H", "8");
    rig_expect("0D", "0");
    (void)enter("0L60");
    uint64_t last = last_pulse();
    TEST_ASSERT_UINT64_WITHIN(1, last + (uint64_t)24 * TICKS_PER_MS, next_start(50));
    rig_run_ms(1000);
}

void test_a_pause_that_is_over_does_not_count(void)
{
    rig_expect("0T10", "0");
    rig_expect("0L50", "0");
    rig_run_ms(1000);
    uint64_t cr = enter("0L50");
    TEST_ASSERT_LESS_OR_EQUAL_UINT64(cr + (uint64_t)START_TICKS_MAX, next_start(1000));
}

void test_a_vector_that_has_waited_begins_with_g_and_not_before_its_pause(void)
{
    rig_expect("0T24", "0");
    rig_expect("0L50", "0");
    (void)enter("0L0,0,0");
    rig_expect("0H", "8");
    rig_expect("0L50", "8");
    rig_expect("0T1", "8");
    uint64_t last = last_pulse();
    rig_expect("0G", "0");
    TEST_ASSERT_UINT64_WITHIN(1, last + (uint64_t)24 * TICKS_PER_MS, next_start(50));
    rig_run_ms(1000);
    rig_expect("0H", "8");
    rig_expect("0L50", "8");
    rig_run_ms(1000);
    uint64_t cr = enter("0G");
    TEST_ASSERT_LESS_OR_EQUAL_UINT64(cr + (uint64_t)START_TICKS_MAX, next_start(1000));
}

void test_going_on_has_no_pause(void)
{
    rig_expect("0T24", "0");
    rig_expect("0L5000", "0");
    rig_run_ms(500);
    rig_expect("0H", "8");
    uint64_t cr = enter("0G");
    first_tick = 0;
    rig_run_ms(12);
    TEST_ASSERT_TRUE(first_tick != 0 && first_tick <= cr + (uint64_t)(START_TICKS_MAX + FIRST_TICKS));
    rig_run_ms(10000);
    rig_expect("0P", "0,5000,0");
}

void test_a_pause_is_part_of_run_and_can_be_stopped(void)
{
    rig_expect("0T24", "0");
    rig_expect("0L50", "0");
    (void)enter("0L60");
    rig_expect("0SR6", "0,40");
    rig_expect("0H", "8");
    rig_expect("0SR6", "8,D0");
    rig_expect("0P", "8,50,0");
    rig_expect("0G", "0");
    rig_run_ms(1000);
    rig_expect("0P", "0,110,0");
}

void test_a_vector_that_comes_at_any_time_round_the_end_is_made_whole(void)
{
    for (unsigned i = 0; i < 60; i++) {
        rig_expect("0L100,-50", "0");
        while (rig_position[0] % 200 != 100) {
            rig_run_ticks(RIG_BYTE_TICKS / 4);
            if (rig_position[0] % 200 == 98) {
                break;
            }
        }
        rig_run_ticks(i * (uint64_t)TICKS_PER_MS / 5U);
        (void)enter("0C100,50");
        rig_run_ms(500);
        TEST_ASSERT_EQUAL_INT64(200 * (int64_t)(i + 1U), rig_position[0]);
        TEST_ASSERT_EQUAL_INT64(0, rig_position[1]);
    }
}

void test_a_queue_that_runs_dry_is_no_error(void)
{
    for (unsigned i = 0; i < 5; i++) {
        rig_expect("0C100", "0");
        rig_expect("0C-90", "0");
        rig_run_ms(1000);
        rig_expect("0SR6", "0,00");
    }
    rig_expect("0P", "0,50,0");
}

void test_the_empty_vector_tells_the_end_of_the_queue(void)
{
    rig_expect("0L1000", "0");
    rig_expect("0C0,0,0", "0");
    rig_expect("0C0,0,0,0", "0");
    rig_expect("0L0,0,0", "1");
    uint64_t cr = enter("0L0,0,0");
    TEST_ASSERT_GREATER_THAN_UINT64(last_pulse(), cr);
    TEST_ASSERT_EQUAL_INT64(1000, rig_position[0]);
}

void test_vectors_without_pulses_take_no_place(void)
{
    rig_expect("0L100000", "0");
    for (unsigned i = 0; i < 2U * GVE_QUEUE_VECTORS; i++) {
        rig_expect("0C0,0,0", "0");
    }
    rig_expect("0F", "0,40");
}

void test_missing_parameters_of_a_vector_are_0(void)
{
    rig_expect("0L10", "0");
    rig_expect("0C0,20", "0");
    rig_expect("0C1,2,3", "0");
    rig_expect("0C1,2,3,4", "0");
    rig_run_ms(2000);
    rig_expect("0P4", "0,12,24,6,4");
}

void test_a_vector_that_comes_on_the_last_step_goes_on_from_the_stand(void)
{
    const uint64_t way_ticks = 1187939; /* one pulse from stand to stand with A20: twice the root of 1/20 000 s */
    (void)enter("0L1");
    rig_run_ms(4);
    (void)enter("0C1");
    rig_run_ms(15);
    uint64_t end = rig_pulse_tick[0];
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_UINT(2, rig_pulses[0]);
    TEST_ASSERT_UINT64_WITHIN(1, end + way_ticks, rig_pulse_tick[0]);
}

void test_a_halt_in_a_pause_is_answered_at_once(void)
{
    rig_expect("0T24", "0");
    (void)enter("0L4");
    rig_run_ms(30);
    (void)enter("0L4");
    rig_run_ms(2);
    rig_heard_count = 0;
    rig_send("!0H\r");
    TEST_ASSERT_EQUAL_STRING("8", rig_answer_within(1));
    TEST_ASSERT_EQUAL_UINT(4, rig_pulses[0]);
    rig_expect("0G", "0");
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_UINT(8, rig_pulses[0]);
}

/* The pulse of L1 comes 14.14 ms after a start that is 0.6 ms after the CR. */
void test_a_vector_that_comes_too_late_to_join_begins_a_chain_after_the_pause(void)
{
    const uint64_t to_pulse_ticks = 600U * TICKS_PER_US + 1187939U;
    rig_expect("0T5", "0");
    uint64_t end = enter("0L1") + to_pulse_ticks;
    rig_run_ticks(end - 100U * TICKS_PER_US - 7U * (uint64_t)RIG_BYTE_TICKS - machine.now);
    (void)enter("0C100");
    rig_run_ticks(RIG_MS);
    TEST_ASSERT_UINT64_WITHIN(RIG_MS / 10U, end, rig_pulse_tick[0]);
    uint64_t last = rig_pulse_tick[0];
    uint64_t start = next_start(100);
    TEST_ASSERT_UINT64_WITHIN(2, last + 5U * (uint64_t)RIG_MS, start);
}
