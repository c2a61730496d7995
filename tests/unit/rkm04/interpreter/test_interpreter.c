/* One interpreter with the stages below it on the host machine, poll by poll: how much it runs, when it wants to be
 * called again, whether it is idle. What programs do is tested on the whole unit (tests/system). The programs are of
 * five commands at most, so that they fit a tiny memory. */
#include "interpreter.h"
#include "unity.h"

#include <string.h>

#include "base_tick.h"
#include "epoch.h"
#include "hal_time.h"
#include "host_machine.h"

static struct host_machine machine;
static struct io io;
static struct interpreter_shared shared;
static struct axis axis;
static struct interpreter interpreter;
static unsigned traced[16];
static int64_t last_value;

static unsigned lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    (void)context;
    (void)motor;
    return axis_lay_isr(&axis, room);
}

static void tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)io_sample(&io);
    (void)axis_sense_isr(&axis, io_inputs(&io), since_tick);
    axis_plan_isr(&axis);
}

static void plan_isr(void *context)
{
    (void)context;
}

static void on_trace(void *context, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    (void)context;
    (void)tick;
    TEST_ASSERT_EQUAL_UINT(3, motor);
    traced[event]++;
    last_value = value;
}

void setUp(void)
{
    static const struct hal_client client = {.lay_isr = lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    memset(traced, 0, sizeof traced);
    host_machine_init(&machine, epoch_random());
    host_machine_select(&machine);
    machine.listener.trace = on_trace;
    io_init(&io);
    interpreter_shared_init(&shared, &io);
    axis_init(&axis, 2);
    interpreter_init(&interpreter, 2, &axis, &shared);
    hal_run_start(&client);
}

void tearDown(void)
{
}

static uint64_t now(void)
{
    return machine.epoch + machine.now;
}

static bool take(const char *text)
{
    const uint8_t *bytes = (const uint8_t *)text;
    uint32_t length = (uint32_t)strlen(text);
    struct program_summary summary = program_check(bytes, length);
    return interpreter_take(&interpreter, bytes, length, &summary, now());
}

static bool load(const char *text)
{
    return interpreter_load(&interpreter, (const uint8_t *)text, (uint32_t)strlen(text), now());
}

static uint64_t poll(void)
{
    return interpreter_poll(&interpreter, now());
}

static uint64_t main_pass(void *context)
{
    (void)context;
    return poll();
}

static void run_ms(uint32_t milliseconds)
{
    host_machine_run(&machine, machine.now + (uint64_t)milliseconds * TICKS_PER_MS, main_pass, NULL, NULL);
}

static void set_inputs(uint8_t levels)
{
    machine.inputs = levels;
    (void)io_sample(&io);
}

void test_a_new_interpreter_is_idle_and_wants_nothing(void)
{
    TEST_ASSERT_TRUE(interpreter_is_idle(&interpreter));
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, poll());
    TEST_ASSERT_EQUAL_UINT32(0, interpreter.place);
}

/* Each round is a label, two writes and a jump: of 16 commands 8 are writes. */
void test_a_poll_runs_a_bounded_number_of_commands(void)
{
    take("@1T80C80J1");
    poll(); /* one step of it leaves the idle state */
    unsigned writes = traced[HAL_TRACE_VAR];
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_UINT64(now(), poll());
    }
    TEST_ASSERT_EQUAL_UINT(4 * INTERPRETER_SLICE_COMMANDS / 2, traced[HAL_TRACE_VAR] - writes);
}

void test_a_wait_wants_to_be_called_at_its_end(void)
{
    take("W7");
    TEST_ASSERT_EQUAL_UINT64(now() + 7 * TICKS_PER_MS, poll());
    TEST_ASSERT_EQUAL_UINT64(now() + 7 * TICKS_PER_MS, poll());
}

TEST_CASE("T01")
TEST_CASE("O03")
TEST_CASE("Z84 O84")
TEST_CASE("[T01")
TEST_CASE("F100R")
TEST_CASE("E")
void test_what_only_an_event_can_change_wants_no_call(const char *text)
{
    take(text);
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, poll());
}

/* What came in at a tick is not run before it, even if main looks at an older time. */
void test_a_command_is_not_run_before_it_came(void)
{
    uint64_t before = now();
    machine.now += 500;
    take("T01");
    TEST_ASSERT_EQUAL_UINT64(now(), interpreter_poll(&interpreter, before));
    TEST_ASSERT_EQUAL_HEX8(0, io.outputs);
    poll();
    TEST_ASSERT_EQUAL_HEX8(1, io.outputs);
}

/* A start lies up to 200 us back at the program clock, and one tick later it is now. */
TEST_CASE(0, 0)
TEST_CASE(16800, 0)
TEST_CASE(16801, 16801)
void test_a_move_begins_at_the_clock_unless_that_has_fallen_after(unsigned after, unsigned start)
{
    uint64_t came = now();
    take("S1000F1R");
    machine.now += after;
    poll();
    TEST_ASSERT_EQUAL_UINT64(came + start, interpreter.clock);
    TEST_ASSERT_EQUAL_UINT64(start + TICKS_PER_MS, machine.armed[2]);
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

void test_a_memory_that_is_just_full_has_not_overflowed(void)
{
    bool overflow = false;
    for (uint32_t i = 0; i < PROGRAM_COMMANDS_MAX; i++) {
        overflow = take("V5") || overflow;
    }
    TEST_ASSERT_FALSE(overflow);
    TEST_ASSERT_TRUE(take("V5"));
}

void test_what_is_overwritten_before_it_was_run_is_passed_over(void)
{
    take("W5T01T02");
    poll();
    for (uint32_t i = 0; i < PROGRAM_COMMANDS_MAX - 2U; i++) {
        take("V5");
    }
    take("W7"); /* where T01 was */
    run_ms(5 + 7 + 1);
    TEST_ASSERT_EQUAL_HEX8(2, io.outputs);
    TEST_ASSERT_TRUE(interpreter_is_idle(&interpreter));
}

void test_with_the_memory_locked_the_commands_stay(void)
{
    take("T40");
    poll();
    for (uint32_t i = 1; i < PROGRAM_COMMANDS_MAX; i++) {
        take("V5");
    }
    TEST_ASSERT_TRUE(take("T01"));
    TEST_ASSERT_EQUAL_UINT8(PROGRAM_FUNCTION_ON, program_memory_at(&interpreter.memory, 0).opcode);
}

TEST_CASE("T01", true)
TEST_CASE("W5", false)
TEST_CASE("O03", false)
TEST_CASE("[", true)
TEST_CASE("F100R", false)
TEST_CASE("@1J1", false)
TEST_CASE("E", true)
void test_what_goes_on_by_itself_is_not_idle(const char *text, bool idle)
{
    take(text);
    TEST_ASSERT_FALSE(interpreter_is_idle(&interpreter));
    poll();
    poll();
    TEST_ASSERT_EQUAL(idle, interpreter_is_idle(&interpreter));
}

void test_a_hold_that_has_been_released_is_not_idle(void)
{
    take("[");
    poll();
    take("]");
    TEST_ASSERT_FALSE(interpreter_is_idle(&interpreter));
}

TEST_CASE("K")
TEST_CASE("\\")
void test_a_motor_that_is_being_stopped_is_not_idle_before_it_stands(const char *text)
{
    take("F900R");
    run_ms(300);
    take(text);
    TEST_ASSERT_FALSE(interpreter_is_idle(&interpreter));
    run_ms(2000);
    TEST_ASSERT_TRUE(interpreter_is_idle(&interpreter));
}

void test_a_program_ended_by_x_is_idle(void)
{
    take("X03W900");
    poll();
    set_inputs(4);
    poll();
    TEST_ASSERT_TRUE(interpreter_is_idle(&interpreter));
}

/* X was 1 only between two polls: the axis has seen it, and its stop is not taken for that of the K that follows. */
TEST_CASE("K")
TEST_CASE("V5")
void test_an_x_that_only_the_axis_has_seen_ends_the_program(const char *text)
{
    take("X03F900R");
    run_ms(300);
    (void)axis_sense_isr(&axis, 4, hal_time_now());
    axis_plan_isr(&axis);
    take(text);
    run_ms(2000);
    TEST_ASSERT_EQUAL_INT(INTERPRETER_ENDED, interpreter.state);
    TEST_ASSERT_EQUAL_UINT(1, traced[HAL_TRACE_END]);
}

void test_an_x_that_only_the_axis_has_seen_does_not_end_what_follows_a_reset(void)
{
    take("X03F900R");
    run_ms(300);
    (void)axis_sense_isr(&axis, 4, hal_time_now());
    axis_plan_isr(&axis);
    take("\\T01");
    run_ms(2000);
    TEST_ASSERT_EQUAL_HEX8(1, io.outputs);
}

/* The wait is over when K comes, but has not been looked at: no time is left of it. */
void test_k_at_the_end_of_a_wait_leaves_no_time(void)
{
    take("W7T01");
    poll();
    machine.now += 8 * TICKS_PER_MS;
    take("K");
    poll();
    TEST_ASSERT_EQUAL_HEX8(0, io.outputs);
    take("C75");
    poll();
    TEST_ASSERT_EQUAL_HEX8(1, io.outputs);
}

/* A way that only a position counter run for two years could have left. */
void test_a_way_to_a_position_is_never_longer_than_a_section(void)
{
    axis_set_position(&axis, INT64_C(-5000000000000));
    take("H");
    poll();
    TEST_ASSERT_EQUAL_INT64((int64_t)MOTION_SECTION_STEPS_MAX, last_value);
}

void test_an_error_from_outside_is_told(void)
{
    interpreter_fail(&interpreter, INTERPRETER_ERROR_STORED_PROGRAM, now());
    TEST_ASSERT_EQUAL_INT(INTERPRETER_FAILED, interpreter.state);
    TEST_ASSERT_EQUAL_INT64(INTERPRETER_ERROR_STORED_PROGRAM, last_value);
    TEST_ASSERT_TRUE(interpreter_is_idle(&interpreter));
}

void test_every_error_has_a_text(void)
{
    TEST_ASSERT_EQUAL_STRING("", interpreter_error_text(INTERPRETER_ERROR_NONE));
    TEST_ASSERT_EQUAL_STRING("label not found", interpreter_error_text(INTERPRETER_ERROR_NO_LABEL));
    TEST_ASSERT_EQUAL_STRING("the stored program is damaged", interpreter_error_text(INTERPRETER_ERROR_STORED_PROGRAM));
}

void test_a_program_that_is_loaded_runs(void)
{
    TEST_ASSERT_TRUE(load("T01 T02"));
    poll();
    TEST_ASSERT_EQUAL_HEX8(3, machine.outputs);
}

TEST_CASE("T01 T02 ?")
TEST_CASE("T01 V0 T02")
TEST_CASE("T01 {")
void test_of_a_text_with_an_error_nothing_is_loaded(const char *text)
{
    TEST_ASSERT_FALSE(load(text));
    TEST_ASSERT_TRUE(interpreter_is_idle(&interpreter));
    poll();
    TEST_ASSERT_EQUAL_HEX8(0, machine.outputs);
    TEST_ASSERT_EQUAL_UINT32(0, interpreter.memory.written);
}

TEST_CASE("K")
TEST_CASE("C75")
TEST_CASE("")
void test_a_text_without_a_command_to_keep_is_loaded_and_does_nothing(const char *text)
{
    TEST_ASSERT_TRUE(load(text));
    TEST_ASSERT_EQUAL_UINT8(INTERPRETER_IDLE, interpreter.state);
    TEST_ASSERT_EQUAL_UINT32(0, interpreter.memory.written);
}

void test_a_speed_alone_is_loaded_as_a_command(void)
{
    TEST_ASSERT_TRUE(load("V500"));
    TEST_ASSERT_EQUAL_UINT32(1, interpreter.memory.written);
}

void test_a_program_that_is_loaded_begins_at_the_time_of_loading(void)
{
    TEST_ASSERT_TRUE(load("W1"));
    TEST_ASSERT_EQUAL_UINT64(now() + TICKS_PER_MS, interpreter_poll(&interpreter, now() + 200U * TICKS_PER_US));
}
