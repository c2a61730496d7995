/* Get Status: its bytes, and what they say of motors, inputs, outputs and board. */
#include "messages_status.h"
#include "unity.h"

#include <string.h>

#include "base_tick.h"
#include "epoch.h"
#include "host_machine.h"
#include "messages.h"
#include "status_vectors.h"

enum {
    ROOM_BYTES = 200,
    GUARD = 0xA5
};

static struct host_machine machine;
static struct io io;
static struct interpreter_shared shared;
static struct axis axis[UNIT_MOTORS];
static struct interpreter interpreter[UNIT_MOTORS];
static struct messages_status status;

static unsigned lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    (void)context;
    return axis_lay_isr(&axis[motor], room);
}

static void tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
    (void)io_sample(&io);
}

static void plan_isr(void *context)
{
    (void)context;
}

static void start(void)
{
    static const struct hal_client client = {.lay_isr = lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    io_init(&io);
    interpreter_shared_init(&shared, &io);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        axis_init(&axis[motor], motor);
        interpreter_init(&interpreter[motor], motor, &axis[motor], &shared);
    }
    hal_run_start(&client);
}

void setUp(void)
{
    host_machine_init(&machine, epoch_random());
    host_machine_select(&machine);
    start();
}

void tearDown(void)
{
}

static uint64_t poll(void *context)
{
    uint64_t wake = TICK_NEVER;
    (void)context;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        uint64_t next = interpreter_poll(&interpreter[motor], machine.epoch + machine.now);
        wake = next < wake ? next : wake;
        axis_feed(&axis[motor]);
    }
    return wake;
}

static void run_ms(uint32_t milliseconds)
{
    host_machine_run(&machine, machine.now + (uint64_t)milliseconds * TICKS_PER_MS, poll, NULL, NULL);
}

static void take(unsigned motor, const char *text)
{
    const uint8_t *bytes = (const uint8_t *)text;
    uint32_t length = (uint32_t)strlen(text);
    struct program_summary summary = program_check(bytes, length);
    (void)interpreter_take(&interpreter[motor - 1U], bytes, length, &summary, machine.epoch + machine.now);
}

static void assert_motor(unsigned motor, unsigned bits)
{
    messages_status_read(&status, interpreter, &shared);
    TEST_ASSERT_EQUAL_HEX8(bits, status.motors[motor - 1U]);
}

void test_the_bytes_are_those_of_the_shared_vectors(void)
{
    for (size_t i = 0; i < sizeof status_vectors / sizeof status_vectors[0]; i++) {
        const struct status_vector *vector = &status_vectors[i];
        uint8_t bytes[ROOM_BYTES];
        struct text text;
        memset(bytes, GUARD, sizeof bytes);
        text_init(&text, bytes, sizeof bytes);
        messages_status_put(&vector->status, &text);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(vector->length, text.length, vector->name);
        TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(vector->answer, bytes, vector->length, vector->name);
    }
}

void test_a_new_unit_is_at_rest_by_power_on(void)
{
    static const struct messages_status zero;
    messages_status_read(&status, interpreter, &shared);
    TEST_ASSERT_EQUAL_MEMORY(&zero, &status, sizeof status);
}

void test_inputs_are_told_as_they_were_sampled(void)
{
    host_machine_set_input(&machine, 1, true);
    host_machine_set_input(&machine, 6, true);
    (void)io_sample(&io);
    messages_status_read(&status, interpreter, &shared);
    TEST_ASSERT_EQUAL_HEX8(0x21, status.inputs);
    TEST_ASSERT_EQUAL_HEX8(0, status.outputs);
}

void test_outputs_are_told_as_programs_have_set_them(void)
{
    take(2, "T1T8C1T41");
    run_ms(1);
    messages_status_read(&status, interpreter, &shared);
    TEST_ASSERT_EQUAL_HEX8(0x80, status.outputs);
    TEST_ASSERT_EQUAL_HEX8(MESSAGES_STATUS_SIMULATING, status.switches);
    TEST_ASSERT_EQUAL_HEX8(0, machine.outputs);
}

/* T41 while motor 1 moves: it is simulated when it stands, motor 2 at once; and the other way round. */
void test_a_motor_whose_pins_are_disconnected_is_simulated(void)
{
    take(1, "F20 R F20 R");
    run_ms(50);
    take(2, "T41");
    run_ms(10);
    assert_motor(1, INTERPRETER_STATUS_MOVING | INTERPRETER_STATUS_RUNNING);
    assert_motor(2, INTERPRETER_STATUS_SIMULATED);
    run_ms(150);
    assert_motor(1, INTERPRETER_STATUS_MOVING | INTERPRETER_STATUS_RUNNING | INTERPRETER_STATUS_SIMULATED);
    take(2, "C41");
    run_ms(10);
    assert_motor(1, INTERPRETER_STATUS_MOVING | INTERPRETER_STATUS_RUNNING | INTERPRETER_STATUS_SIMULATED);
    TEST_ASSERT_EQUAL_HEX8(0, status.switches & MESSAGES_STATUS_SIMULATING);
    run_ms(200);
    assert_motor(1, 0);
    TEST_ASSERT_EQUAL_INT64(20, status.positions_steps[0]);
}

void test_the_memory_that_is_locked_is_told(void)
{
    take(1, "T40");
    run_ms(1);
    messages_status_read(&status, interpreter, &shared);
    TEST_ASSERT_EQUAL_HEX8(MESSAGES_STATUS_LOCKED, status.switches);
}

void test_a_move_is_moving_and_running_and_tells_its_position(void)
{
    take(3, "B5R");
    run_ms(15);
    assert_motor(3, INTERPRETER_STATUS_MOVING | INTERPRETER_STATUS_RUNNING);
    TEST_ASSERT_EQUAL_INT64(-1, status.positions_steps[2]);
    run_ms(1000);
    assert_motor(3, 0);
    TEST_ASSERT_EQUAL_INT64(-5, status.positions_steps[2]);
    TEST_ASSERT_EQUAL_INT64(0, status.positions_steps[0]);
}

void test_commands_that_have_come_and_not_begun_are_running(void)
{
    take(4, "F5R");
    assert_motor(4, INTERPRETER_STATUS_RUNNING);
}

void test_a_loop_without_a_wait_is_running(void)
{
    take(4, "@1J1");
    run_ms(10);
    assert_motor(4, INTERPRETER_STATUS_RUNNING);
}

void test_waits_for_a_time_a_level_and_a_bracket_are_waiting(void)
{
    static const char *const programs[] = {"W1000", "O1", "[F1R"};
    for (size_t i = 0; i < sizeof programs / sizeof programs[0]; i++) {
        setUp();
        take(1, programs[i]);
        run_ms(10);
        assert_motor(1, INTERPRETER_STATUS_RUNNING | INTERPRETER_STATUS_WAITING);
    }
}

void test_what_a_motor_waits_for_is_told_while_it_waits(void)
{
    static const struct {
        const char *program;
        uint8_t waits;
    } cases[] = {{"W1000", 96}, {"O1", 129}, {"Z8", 8}, {"O80", 208}, {"T95Z95", 95}, {"[F1R", 97}, {"@1J1", 0}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        setUp();
        host_machine_set_input(&machine, 8, true);
        run_ms(1);
        take(3, cases[i].program);
        run_ms(10);
        messages_status_read(&status, interpreter, &shared);
        TEST_ASSERT_EQUAL_UINT8_MESSAGE(cases[i].waits, status.waits[2], cases[i].program);
        TEST_ASSERT_EQUAL_UINT8(0, status.waits[0]);
        take(3, "K");
        messages_status_read(&status, interpreter, &shared);
        TEST_ASSERT_EQUAL_UINT8_MESSAGE(0, status.waits[2], cases[i].program);
    }
}

void test_k_is_stopped_and_moving_until_the_motor_stands(void)
{
    take(1, "S100V4000A2000F5000R");
    run_ms(1000);
    take(1, "K");
    assert_motor(1, INTERPRETER_STATUS_STOPPED | INTERPRETER_STATUS_MOVING);
    run_ms(3000);
    assert_motor(1, INTERPRETER_STATUS_STOPPED);
    take(1, "C75");
    run_ms(10);
    assert_motor(1, INTERPRETER_STATUS_RUNNING | INTERPRETER_STATUS_MOVING);
}

void test_an_error_is_told_until_the_reset(void)
{
    take(2, "J5");
    run_ms(1);
    assert_motor(2, INTERPRETER_STATUS_FAILED);
    TEST_ASSERT_EQUAL_UINT8(INTERPRETER_ERROR_NO_LABEL, status.errors[1]);
    take(2, "\\");
    run_ms(1);
    assert_motor(2, 0);
    TEST_ASSERT_EQUAL_UINT8(INTERPRETER_ERROR_NONE, status.errors[1]);
}

void test_a_reset_under_way_is_moving_only(void)
{
    take(1, "S100V4000A2000F5000R");
    run_ms(1000);
    take(1, "\\");
    assert_motor(1, INTERPRETER_STATUS_MOVING);
}

void test_x_is_ended_until_the_reset(void)
{
    take(1, "X2W100000");
    run_ms(1);
    host_machine_set_input(&machine, 2, true);
    run_ms(5);
    assert_motor(1, INTERPRETER_STATUS_ENDED);
}

void test_causes_of_the_start_are_told_and_whether_programs_were_started(void)
{
    static const uint8_t switches[] = {0, 0, MESSAGES_STATUS_NOT_STARTED, MESSAGES_STATUS_NOT_STARTED};
    for (unsigned cause = HAL_BOARD_CAUSE_POWER; cause <= HAL_BOARD_CAUSE_FAULT; cause++) {
        machine.faults.start_cause = (enum hal_board_cause)cause;
        messages_status_read(&status, interpreter, &shared);
        TEST_ASSERT_EQUAL_UINT8(cause, status.cause);
        TEST_ASSERT_EQUAL_HEX8(switches[cause], status.switches);
    }
}

void test_a_missing_crystal_is_told(void)
{
    machine.faults.no_crystal = true;
    messages_status_read(&status, interpreter, &shared);
    TEST_ASSERT_EQUAL_HEX8(MESSAGES_STATUS_NO_CRYSTAL, status.switches);
}

void test_a_part_too_small_for_stored_programs_is_told(void)
{
    machine.faults.no_flash = true;
    messages_status_read(&status, interpreter, &shared);
    TEST_ASSERT_EQUAL_HEX8(MESSAGES_STATUS_NO_STORE, status.switches);
}

void test_steps_that_no_timer_makes_are_told(void)
{
    machine.faults.no_step_timer = true;
    messages_status_read(&status, interpreter, &shared);
    TEST_ASSERT_EQUAL_HEX8(MESSAGES_STATUS_UNTIMED, status.switches);
}

void test_late_steps_are_counted(void)
{
    machine.late_steps = UINT64_C(0x123456789);
    messages_status_read(&status, interpreter, &shared);
    TEST_ASSERT_EQUAL_HEX32(0x23456789, status.late_steps);
}

void test_the_answer_has_the_counters_of_the_link(void)
{
    static uint8_t answer[MESSAGES_ANSWER_BYTES_MAX];
    static const uint32_t counts[MESSAGES_LINE_COUNTS] = {0x01020304, [MESSAGES_LINE_COUNTS - 1] = 9};
    struct messages messages = {.interpreters = interpreter, .shared = &shared, .line_counts = counts};

    uint32_t length = messages_answer(&messages, (const uint8_t *)"\xC8more", 5, 0, answer);

    TEST_ASSERT_EQUAL_UINT32(102, length);
    TEST_ASSERT_EQUAL_HEX8(200, answer[0]);
    TEST_ASSERT_EQUAL_HEX8_ARRAY("\x04\x03\x02\x01", answer + 50, 4);
    TEST_ASSERT_EQUAL_HEX8_ARRAY("\x09\0\0", answer + 94, 4);
}
