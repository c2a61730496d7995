#include "bench.h"

#include <string.h>

#include "epoch.h"
#include "hal_step.h"
#include "unity.h"

#define IDLE_LIMIT_TICKS (UINT64_C(60) * TICK_HZ)

#define MEMORY_COMMANDS_MIN 700

static void on_step(void *context, uint64_t tick, unsigned motor, bool backward)
{
    struct bench *bench = context;
    TEST_ASSERT_LESS_THAN_UINT32_MESSAGE(BENCH_PULSES_MAX, bench->pulse_count, "too many pulses for the bench");
    bench->pulses[bench->pulse_count] =
        (struct bench_pulse){.tick = tick, .motor = (uint8_t)(motor + 1U), .backward = backward};
    bench->pulse_count++;
    bench->made[motor + 1U]++;
    judge_unit_step(bench, tick, motor, backward);
}

static void add_edge(struct bench *bench, uint64_t tick, unsigned motor, uint8_t value)
{
    TEST_ASSERT_LESS_THAN_UINT32_MESSAGE(BENCH_EDGES_MAX, bench->edge_count, "too many edges for the bench");
    bench->edges[bench->edge_count] = (struct bench_edge){.tick = tick, .motor = (uint8_t)motor, .value = value};
    bench->edge_count++;
}

static void on_led(void *context, uint64_t tick, unsigned motor, bool on)
{
    add_edge(context, tick, motor + 1U, on ? 1 : 0);
}

static void on_output(void *context, uint64_t tick, uint8_t levels)
{
    add_edge(context, tick, 0, levels);
}

static void on_trace(void *context, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    struct bench *bench = context;
    if (!bench->forgets_events && event != HAL_TRACE_COMMAND) {
        TEST_ASSERT_LESS_THAN_UINT32_MESSAGE(BENCH_EVENTS_MAX, bench->event_count, "too many events for the bench");
        bench->events[bench->event_count] =
            (struct bench_event){.tick = tick, .value = value, .motor = (uint8_t)motor, .event = event};
        bench->event_count++;
    }
    judge_unit_trace(bench, tick, motor, event, value);
}

static unsigned lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    struct bench *bench = context;
    bool wanted = bench->wanted_motor == motor + 1U && bench->wanted_pulses == bench->made[motor + 1U];
    room->main_has_work = wanted;
    return bench->unit.client.lay_isr(&bench->unit, motor, room);
}

static void tick_isr(void *context, uint64_t since_tick)
{
    struct bench *bench = context;
    bench->unit.client.tick_isr(&bench->unit, since_tick);
}

static void plan_isr(void *context)
{
    struct bench *bench = context;
    bench->unit.client.plan_isr(&bench->unit);
}

static void start_unit(struct bench *bench)
{
    rkm04_init(&bench->unit);
    rkm04_start(&bench->unit);
    bench->machine.client =
        (struct hal_client){.context = bench, .lay_isr = lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
}

void bench_init_at(struct bench *bench, uint64_t epoch)
{
    memset(bench, 0, sizeof *bench);
    bench->judged = (struct judged_unit){.unit = &bench->unit, .judge = &bench->judge, .machine = &bench->machine};
    judge_unit_begin(&bench->judged, epoch);
    bench->machine.listener.step = on_step;
    bench->machine.listener.trace = on_trace;
    bench->machine.listener.led = on_led;
    bench->machine.listener.output = on_output;
    host_machine_set_script(&bench->machine, bench->script, 0);
    start_unit(bench);
}

void bench_init(struct bench *bench)
{
    if (PROGRAM_COMMANDS_MAX < MEMORY_COMMANDS_MIN) {
        TEST_IGNORE_MESSAGE("the program memory of this build is too small");
    }
    bench_init_at(bench, epoch_random());
}

void bench_restart(struct bench *bench)
{
    judge_restart(&bench->judge);
    host_machine_restart(&bench->machine);
    start_unit(bench);
}

void bench_restart_badly(struct bench *bench)
{
    judge_restart(&bench->judge);
    host_machine_restart(&bench->machine);
    bench->machine.faults.start_cause = HAL_BOARD_CAUSE_WATCHDOG;
    start_unit(bench);
}

void bench_message(struct bench *bench, const void *request, uint32_t length)
{
    bench->answer_length = rkm04_message(&bench->unit, request, length, bench->answer);
    bool wanted = length >= 1 && length <= MESSAGES_REQUEST_BYTES_MAX;
    judge_exchange(&bench->judge, wanted ? 1 : 0, bench->answer_length != 0 ? 1 : 0);
}

uint8_t bench_send(struct bench *bench, unsigned motor, const char *text)
{
    uint8_t request[MESSAGES_REQUEST_BYTES_MAX] = {MESSAGES_SET_COMMAND, (uint8_t)('0' + motor)};
    size_t length = strlen(text);
    TEST_ASSERT_LESS_OR_EQUAL_size_t_MESSAGE(BENCH_TEXT_BYTES_MAX, length, "text too long for a message");
    memcpy(request + 2, text, length);
    bench_message(bench, request, (uint32_t)length + 2U);
    TEST_ASSERT_EQUAL_UINT32(4, bench->answer_length);
    TEST_ASSERT_EQUAL_UINT8(MESSAGES_SET_COMMAND, bench->answer[0]);
    return bench->answer[2];
}

const char *bench_ask(struct bench *bench, uint8_t number, unsigned motor)
{
    uint8_t request[2] = {number, (uint8_t)('0' + motor)};
    bench_message(bench, request, sizeof request);
    TEST_ASSERT_LESS_THAN_UINT32(sizeof bench->answer, bench->answer_length);
    bench->answer[bench->answer_length] = '\0';
    return (const char *)bench->answer + 2;
}

uint8_t *bench_find_in_flash(struct bench *bench, const char *text)
{
    size_t length = strlen(text);
    uint8_t *flash = &bench->machine.flash[0][0];
    for (size_t i = 0; i + length <= sizeof bench->machine.flash; i++) {
        if (memcmp(flash + i, text, length) == 0) {
            return flash + i;
        }
    }
    return NULL;
}

static bool is_idle(void *context)
{
    const struct bench *bench = context;
    return rkm04_is_idle(&bench->unit);
}

static bool has_pulses(void *context)
{
    const struct bench *bench = context;
    return bench_pulses(bench, bench->wanted_motor) >= bench->wanted_pulses;
}

void bench_run_ticks(struct bench *bench, uint64_t ticks)
{
    host_machine_run(&bench->machine, bench->machine.now + ticks, judge_unit_pass, NULL, bench);
}

void bench_run_ms(struct bench *bench, uint32_t milliseconds)
{
    bench_run_ticks(bench, (uint64_t)milliseconds * TICKS_PER_MS);
}

void bench_run_idle(struct bench *bench)
{
    host_machine_run(&bench->machine, bench->machine.now + IDLE_LIMIT_TICKS, judge_unit_pass, is_idle, bench);
    TEST_ASSERT_TRUE_MESSAGE(rkm04_is_idle(&bench->unit), "still busy after a minute");
}

void bench_run_pulses(struct bench *bench, unsigned motor, uint32_t pulses)
{
    bench->wanted_motor = motor;
    bench->wanted_pulses = pulses;
    host_machine_run(&bench->machine, bench->machine.now + IDLE_LIMIT_TICKS, judge_unit_pass, has_pulses, bench);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(pulses, bench_pulses(bench, motor), "pulses not made within a minute");
}

void bench_do(struct bench *bench, unsigned motor, const char *text)
{
    TEST_ASSERT_EQUAL_UINT8(0, bench_send(bench, motor, text));
    bench_run_idle(bench);
}

void bench_plan_input(struct bench *bench, uint64_t tick, uint8_t input, bool level)
{
    uint32_t length = bench->machine.script_length;
    TEST_ASSERT_LESS_THAN_UINT32_MESSAGE(BENCH_INPUTS_MAX, length, "too many inputs for the bench");
    bench->script[length] = (struct host_input){.tick = tick, .input = input, .level = level};
    bench->machine.script_length = length + 1U;
}

void bench_set_input(struct bench *bench, uint8_t input, bool level)
{
    bench_plan_input(bench, bench->machine.now, input, level);
    bench_run_ticks(bench, 1);
}

uint64_t bench_now(const struct bench *bench)
{
    return bench->machine.now;
}

uint32_t bench_pulses(const struct bench *bench, unsigned motor)
{
    return bench->made[motor];
}

uint64_t bench_pulse_tick(const struct bench *bench, unsigned motor, uint32_t pulse)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < bench->pulse_count; i++) {
        count += bench->pulses[i].motor == motor ? 1U : 0U;
        if (bench->pulses[i].motor == motor && count == pulse) {
            return bench->pulses[i].tick;
        }
    }
    TEST_FAIL_MESSAGE("there is no such pulse");
    return TICK_NEVER;
}

uint64_t bench_led_tick(const struct bench *bench, unsigned motor, uint32_t edge)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < bench->edge_count; i++) {
        count += bench->edges[i].motor == motor ? 1U : 0U;
        if (bench->edges[i].motor == motor && count == edge) {
            return bench->edges[i].tick;
        }
    }
    TEST_FAIL_MESSAGE("there is no such edge of the LED");
    return TICK_NEVER;
}

uint32_t bench_count(const struct bench *bench, unsigned motor, enum hal_trace_event event)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < bench->event_count; i++) {
        count += bench->events[i].motor == motor && bench->events[i].event == event ? 1U : 0U;
    }
    return count;
}

const struct bench_event *bench_event(const struct bench *bench, unsigned motor, enum hal_trace_event event,
                                      uint32_t which)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < bench->event_count; i++) {
        const struct bench_event *found = &bench->events[i];
        if (found->motor == motor && found->event == event) {
            if (count == which) {
                return found;
            }
            count++;
        }
    }
    TEST_FAIL_MESSAGE("there is no such event");
    return NULL;
}

int64_t bench_position(const struct bench *bench, unsigned motor)
{
    return axis_position_steps(&bench->unit.axis[motor - 1U]);
}

enum interpreter_state bench_state(const struct bench *bench, unsigned motor)
{
    return (enum interpreter_state)bench->unit.interpreter[motor - 1U].state;
}

bool bench_output(const struct bench *bench, unsigned output)
{
    return (bench->machine.outputs >> (output - 1U) & 1U) != 0;
}

void bench_check(struct bench *bench)
{
    char text[JUDGE_TEXT_BYTES + 32];
    struct judge *judge = &bench->judge;
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, bench->machine.late_steps, "a pulse was late");
    judge_flash(judge, bench->machine.flash_rewrites);
    judge_finish(judge, bench->machine.now);
    if (judge->complaints != 0) {
        judge_tell(judge, 0, text);
        TEST_FAIL_MESSAGE(text);
    }
}
