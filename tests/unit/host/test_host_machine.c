#include "unity.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "base_tick.h"
#include "hal_io.h"
#include "hal_run.h"
#include "hal_step.h"
#include "hal_time.h"
#include "host_machine.h"

#include "given_pulses.h"

#define LOG_BYTES 1000U
#define ANSWERS_MAX 10U
#define EPOCH UINT64_C(1000000)

static struct host_machine machine;
static char event_log[LOG_BYTES];
static size_t log_length;

/* What main answers, pass by pass, in ticks from the start; then never. */
static uint64_t answers[ANSWERS_MAX];
static unsigned passes;

/* What the interrupts do; a test lays in a hold. */
static bool lay_isr_wakes;
static uint32_t lay_isr_goes_on_after; /* ticks; 0: not at all */
static unsigned done_after;            /* passes */

/* The kind of what happens, its time from the start, and what it is about. */
static void note(char kind, uint64_t tick, unsigned value)
{
    int written = snprintf(&event_log[log_length], LOG_BYTES - log_length, "%c%u@%" PRIu64 " ", kind, value, tick);
    log_length += (size_t)written;
    TEST_ASSERT_LESS_THAN(LOG_BYTES, log_length);
}

static void step_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    note(backward ? 'b' : 'f', tick, motor);
}

static void input_seen(void *context, uint64_t tick, uint8_t levels)
{
    (void)context;
    note('i', tick, levels);
}

static unsigned lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    if (!machine.step_held) {
        note('S', hal_time_now() - machine.epoch, motor);
        if (lay_isr_goes_on_after != 0) {
            give(motor, (uint32_t)hal_time_now() + lay_isr_goes_on_after);
        }
    }
    room->main_has_work = lay_isr_wakes;
    return given_lay_isr(context, motor, room);
}

static void tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    note('T', since_tick - machine.epoch, hal_io_read_inputs());
}

static void plan_isr(void *context)
{
    (void)context;
}

static uint64_t main_pass(void *context)
{
    (void)context;
    note('M', hal_time_now() - machine.epoch, passes);
    uint64_t answer = passes < ANSWERS_MAX ? answers[passes] : TICK_NEVER;
    passes++;
    return answer == TICK_NEVER ? TICK_NEVER : machine.epoch + answer;
}

static bool is_done(void *context)
{
    (void)context;
    return passes >= done_after;
}

static void begin_at(uint64_t epoch)
{
    static const struct hal_client client = {.lay_isr = lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    host_machine_init(&machine, epoch);
    machine.listener = (struct host_listener){.step = step_seen, .input = input_seen};
    host_machine_select(&machine);
    hal_run_start(&client);
}

static void lay(unsigned motor, uint64_t tick)
{
    lay_pulse(motor, (uint32_t)(machine.epoch + tick));
}

static void run_until(uint64_t until)
{
    host_machine_run(&machine, until, main_pass, NULL, NULL);
}

void setUp(void)
{
    memset(event_log, 0, sizeof event_log);
    log_length = 0;
    passes = 0;
    for (unsigned i = 0; i < ANSWERS_MAX; i++) {
        answers[i] = TICK_NEVER;
    }
    lay_isr_wakes = false;
    lay_isr_goes_on_after = 0;
    done_after = 1;
    given_clear();
    begin_at(EPOCH);
}

void tearDown(void)
{
}

void test_time_begins_at_the_epoch(void)
{
    TEST_ASSERT_EQUAL_UINT64(EPOCH, hal_time_now());
}

void test_main_makes_its_first_pass_at_once(void)
{
    run_until(1);

    TEST_ASSERT_EQUAL_STRING("M0@0 ", event_log);
}

void test_nothing_runs_in_no_time(void)
{
    run_until(0);

    TEST_ASSERT_EQUAL_STRING("", event_log);
}

void test_main_is_called_again_when_it_asked_for_it(void)
{
    answers[0] = 70;
    answers[1] = 5000;

    run_until(10000);

    TEST_ASSERT_EQUAL_STRING("M0@0 M1@70 M2@5000 ", event_log);
}

void test_a_wake_up_for_now_or_before_comes_after_one_pass_of_main(void)
{
    answers[0] = 0;
    answers[1] = HOST_PASS_TICKS - 1;

    run_until(3 * HOST_PASS_TICKS);

    TEST_ASSERT_EQUAL_STRING("M0@0 M1@1680 M2@3360 ", event_log);
}

void test_a_wake_up_one_tick_ahead_comes_at_that_tick(void)
{
    answers[0] = 1;

    run_until(10);

    TEST_ASSERT_EQUAL_STRING("M0@0 M1@1 ", event_log);
}

void test_time_stands_at_the_end_of_the_run_when_nothing_is_left(void)
{
    run_until(UINT64_C(1) << 40);

    TEST_ASSERT_EQUAL_UINT64(UINT64_C(1) << 40, machine.now);
}

void test_what_is_due_at_the_end_of_the_run_is_left_for_the_next_run(void)
{
    lay(0, 100);
    run_until(100);
    TEST_ASSERT_EQUAL_STRING("M0@0 ", event_log);

    run_until(101);

    TEST_ASSERT_EQUAL_STRING("M0@0 f0@100 S0@100 M1@100 ", event_log);
}

void test_a_run_into_the_past_leaves_time_alone(void)
{
    run_until(500);

    run_until(400);

    TEST_ASSERT_EQUAL_UINT64(500, machine.now);
}

void test_a_run_without_end_stops_at_the_last_event(void)
{
    lay(2, 12345);

    run_until(TICK_NEVER);

    TEST_ASSERT_EQUAL_UINT64(12345, machine.now);
}

void test_a_run_ends_after_the_pass_that_is_done(void)
{
    answers[0] = 10;
    answers[1] = 20;
    done_after = 2;

    host_machine_run(&machine, 1000, main_pass, is_done, NULL);

    TEST_ASSERT_EQUAL_STRING("M0@0 M1@10 ", event_log);
    TEST_ASSERT_EQUAL_UINT64(10, machine.now);
}

void test_a_pulse_makes_its_edge_and_its_interrupt(void)
{
    lay(3, 84);

    run_until(1000);

    TEST_ASSERT_EQUAL_STRING("M0@0 f3@84 S3@84 ", event_log);
}

void test_pulses_come_in_order_of_time(void)
{
    lay(0, 300);
    lay(1, 100);
    lay(2, 400);
    lay(3, 200);

    run_until(1000);

    TEST_ASSERT_EQUAL_STRING("M0@0 f1@100 S1@100 f3@200 S3@200 f0@300 S0@300 f2@400 S2@400 ", event_log);
}

void test_pulses_of_one_tick_come_in_order_of_motors(void)
{
    lay(3, 100);
    lay(1, 100);
    lay(2, 100);
    lay(0, 100);

    run_until(1000);

    TEST_ASSERT_EQUAL_STRING("M0@0 f0@100 S0@100 f1@100 S1@100 f2@100 S2@100 f3@100 S3@100 ", event_log);
}

void test_on_one_tick_pulses_come_first_then_inputs_then_main(void)
{
    static const struct host_input script[] = {{.tick = 100, .input = 1, .level = true}};
    host_machine_set_script(&machine, script, 1);
    lay(0, 100);
    answers[0] = 100;

    run_until(1000);

    TEST_ASSERT_EQUAL_STRING("M0@0 f0@100 S0@100 i1@100 T1@100 M1@100 ", event_log);
}

void test_a_pulse_that_needs_main_wakes_it_after_the_time_of_the_interrupt(void)
{
    lay(0, 100);
    lay_isr_wakes = true;

    run_until(1000);

    TEST_ASSERT_EQUAL_STRING("M0@0 f0@100 S0@100 M1@310 ", event_log);
}

void test_other_pulses_come_between_an_interrupt_and_the_main_pass_it_asked_for(void)
{
    lay(0, 100);
    lay(1, 200);
    lay(2, 310);
    lay(3, 311);
    lay_isr_wakes = true;

    run_until(400);

    TEST_ASSERT_EQUAL_STRING("M0@0 f0@100 S0@100 f1@200 S1@200 f2@310 S2@310 M1@310 f3@311 S3@311 ", event_log);
}

void test_an_interrupt_does_not_put_off_a_wake_up_that_comes_earlier(void)
{
    lay(0, 100);
    lay_isr_wakes = true;
    answers[0] = 150;

    run_until(1000);

    TEST_ASSERT_EQUAL_STRING("M0@0 f0@100 S0@100 M1@150 ", event_log);
}

void test_a_pulse_that_main_lays_for_now_is_made_after_main(void)
{
    lay(0, 0);
    run_until(1);
    TEST_ASSERT_EQUAL_STRING("f0@0 S0@0 M0@0 ", event_log);

    lay(1, 1);
    run_until(2);

    TEST_ASSERT_EQUAL_STRING("f0@0 S0@0 M0@0 f1@1 S1@1 M1@1 ", event_log);
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

void test_a_pulse_laid_in_the_interrupt_follows(void)
{
    lay(0, 100);
    lay_isr_goes_on_after = 50;

    run_until(250);

    TEST_ASSERT_EQUAL_STRING("M0@0 f0@100 S0@100 f0@150 S0@150 f0@200 S0@200 ", event_log);
    TEST_ASSERT_EQUAL_UINT64(3, machine.pulses);
}

void test_a_late_interrupt_comes_after_the_edge(void)
{
    machine.faults.late_step_ticks = 30;
    lay(0, 100);

    run_until(1000);

    TEST_ASSERT_EQUAL_STRING("M0@0 f0@100 S0@130 ", event_log);
    TEST_ASSERT_EQUAL_UINT64(1, machine.pulses);
}

void test_other_edges_come_between_an_edge_and_its_late_interrupt(void)
{
    machine.faults.late_step_ticks = 30;
    lay(0, 100);
    lay(1, 110);

    run_until(1000);

    TEST_ASSERT_EQUAL_STRING("M0@0 f0@100 f1@110 S0@130 S1@140 ", event_log);
}

void test_an_input_changes_and_main_runs_at_that_tick(void)
{
    static const struct host_input script[] = {
        {.tick = 10, .input = 1, .level = true},
        {.tick = 20, .input = 8, .level = true},
        {.tick = 30, .input = 1, .level = false},
    };
    host_machine_set_script(&machine, script, 3);

    run_until(100);

    TEST_ASSERT_EQUAL_STRING("M0@0 i1@10 T1@10 M1@10 i129@20 T129@20 M2@20 i128@30 T128@30 M3@30 ", event_log);
}

void test_inputs_that_change_on_the_same_tick_change_together(void)
{
    static const struct host_input script[] = {
        {.tick = 0, .input = 1, .level = true},
        {.tick = 0, .input = 2, .level = true},
    };
    host_machine_set_script(&machine, script, 2);

    run_until(100);

    TEST_ASSERT_EQUAL_STRING("i3@0 T3@0 M0@0 ", event_log);
}

void test_an_input_that_keeps_its_level_is_no_event(void)
{
    static const struct host_input script[] = {{.tick = 10, .input = 4, .level = false}};
    host_machine_set_script(&machine, script, 1);

    run_until(100);

    TEST_ASSERT_EQUAL_STRING("M0@0 ", event_log);
}

void test_inputs_whose_time_is_past_come_at_once(void)
{
    static const struct host_input script[] = {{.tick = 10, .input = 1, .level = true}};
    run_until(50);
    host_machine_set_script(&machine, script, 1);

    run_until(60);

    TEST_ASSERT_EQUAL_STRING("M0@0 i1@50 T1@50 M1@50 ", event_log);
}

void test_inputs_change_before_the_interrupts_are_started(void)
{
    static const struct host_input script[] = {{.tick = 10, .input = 1, .level = true}};
    host_machine_init(&machine, EPOCH);
    host_machine_set_script(&machine, script, 1);

    run_until(60);

    TEST_ASSERT_EQUAL_STRING("M0@0 M1@10 ", event_log);
    TEST_ASSERT_EQUAL_HEX8(1, machine.inputs);
}

/* A run with everything in it, at an epoch. */
static void run_everything(uint64_t epoch)
{
    static const struct host_input script[] = {
        {.tick = 75, .input = 2, .level = true},
        {.tick = 3000, .input = 2, .level = false},
    };
    setUp();
    begin_at(epoch);
    host_machine_set_script(&machine, script, 2);
    answers[0] = 60;
    answers[1] = 75;
    answers[2] = 0;
    lay_isr_wakes = true;
    lay(0, 70);
    lay(2, 75);
    lay(1, TICK_HZ);
    run_until(2 * TICK_HZ);
}

TEST_CASE(0)
TEST_CASE(0xFFFFFFFF)
TEST_CASE(0x100000000)
TEST_CASE(0xFFFFFFC0)
TEST_CASE(0x7FFFFFFFFFFFFFC0)
TEST_CASE(0x8000000000000000)
TEST_CASE(0xFFFFFFFF00000000)
void test_an_epoch_changes_nothing_but_the_time_of_the_unit(uint64_t epoch)
{
    char expected[LOG_BYTES];
    run_everything(EPOCH);
    memcpy(expected, event_log, LOG_BYTES);

    run_everything(epoch);

    TEST_ASSERT_EQUAL_STRING(expected, event_log);
    TEST_ASSERT_EQUAL_UINT64(epoch + 2 * TICK_HZ, hal_time_now());
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

void test_the_same_run_twice_leaves_the_same_machine(void)
{
    static struct host_machine first;
    run_everything(EPOCH);
    first = machine;

    run_everything(EPOCH);

    TEST_ASSERT_EQUAL_MEMORY(&first, &machine, sizeof machine);
}

void test_a_restart_keeps_time_inputs_and_flash(void)
{
    static const struct host_input script[] = {{.tick = 10, .input = 7, .level = true}};
    host_machine_set_script(&machine, script, 1);
    run_until(50);
    machine.flash[1][77] = 5;

    host_machine_restart(&machine);

    TEST_ASSERT_EQUAL_UINT64(EPOCH + 50, hal_time_now());
    TEST_ASSERT_EQUAL_HEX8(0x40, hal_io_read_inputs());
    TEST_ASSERT_EQUAL_HEX8(5, machine.flash[1][77]);
}

void test_a_restart_clears_the_faults(void)
{
    machine.faults = (struct host_faults){.late_step_ticks = 5, .flash_cut_after = 1, .flash_fail_at = 2};

    host_machine_restart(&machine);

    TEST_ASSERT_EQUAL_UINT32(0, machine.faults.late_step_ticks);
    TEST_ASSERT_EQUAL_UINT32(0, machine.faults.flash_cut_after);
    TEST_ASSERT_EQUAL_UINT32(0, machine.faults.flash_fail_at);
}

void test_a_restart_lets_held_interrupts_go(void)
{
    hal_step_hold();
    hal_run_hold_plan();

    host_machine_restart(&machine);

    TEST_ASSERT_FALSE(machine.step_held);
    TEST_ASSERT_FALSE(machine.plan_held);
}
