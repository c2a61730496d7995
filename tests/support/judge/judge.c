#include "judge.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base_tick.h"
#include "judge_private.h"

enum {
    EVENTS_OF_PASS_MAX = JUDGE_MOTORS * INTERPRETER_SLICE_COMMANDS * 14,
};

/* Ticks that a pulse may stand off its time. */
static const long double pulse_slack = 1.0L;

struct judge_limits judge_default_limits(void)
{
    return (struct judge_limits){
        .tick_hz = TICK_HZ,
        .slowest = 1,
        .start_speed = 2000,
        .speed = 16000,
        .accel = 60000,
        .slack_ticks = 2,
        .lead_ticks = 100U * TICKS_PER_US,
        .dir_setup_ticks = 5U * TICKS_PER_US,
        .dir_hold_ticks = 0,
    };
}

void judge_init(struct judge *judge, const struct judge_limits *limits)
{
    memset(judge, 0, sizeof *judge);
    judge->limits = *limits;
    judge->digest = UINT64_C(0xCBF29CE484222325);
}

void judge_complain(struct judge *judge, uint64_t key, const char *format, ...)
{
    for (uint32_t i = 0; i < judge->complaints; i++) {
        if (judge->complaint[i].key == key) {
            judge->complaint[i].times++;
            return;
        }
    }
    if (judge->complaints == JUDGE_COMPLAINTS_MAX) {
        judge->lost_complaints++;
        return;
    }
    struct judge_complaint *complaint = &judge->complaint[judge->complaints++];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(complaint->text, sizeof complaint->text, format, arguments);
    va_end(arguments);
    complaint->key = key;
    complaint->times = 1;
}

void judge_tell(const struct judge *judge, uint32_t complaint, char text[JUDGE_TEXT_BYTES + 32])
{
    const struct judge_complaint *told = &judge->complaint[complaint];
    if (told->times == 1) {
        (void)snprintf(text, JUDGE_TEXT_BYTES + 32, "%s", told->text);
    } else {
        (void)snprintf(text, JUDGE_TEXT_BYTES + 32, "%s (%" PRIu32 " times)", told->text, told->times);
    }
}

/* FNV-1a. */
static void digest_add(struct judge *judge, uint64_t value)
{
    for (unsigned i = 0; i < 8; i++) {
        judge->digest = (judge->digest ^ (value >> 8U * i & 0xFFU)) * UINT64_C(0x100000001B3);
    }
}

uint64_t judge_digest(const struct judge *judge)
{
    return judge->digest;
}

static bool motor_exists(struct judge *judge, unsigned motor, const char *what)
{
    if (motor >= 1 && motor <= JUDGE_MOTORS) {
        return true;
    }
    judge_complain(judge, judge_key(JUDGE_RULE_NO_MOTOR, motor, 0), "%s of motor %u, which does not exist", what,
                   motor);
    return false;
}

/* Where in a move a pulse stands: its time, its interval, its speed. */
static void judge_planned_pulse(struct judge *judge, unsigned number, uint64_t tick)
{
    struct judge_motor *motor = &judge->motor[number];
    uint64_t interval = motor->made > 1 ? tick - motor->last_tick : 0;
    if (motor->made > motor->curve.last) {
        judge_complain_move(judge, number, JUDGE_RULE_AFTER_STOP, "makes more pulses than its plan or a stop allow, at",
                            tick);
        return;
    }
    long double due = (long double)motor->start_tick + judge_curve_tick(&motor->curve, motor->made);
    if (fabsl((long double)tick - due) > pulse_slack) {
        judge_complain_move(judge, number, JUDGE_RULE_EXACT, "has a pulse more than a tick off its time, at", tick);
    }
    const struct judge_leg *leg = judge_curve_leg(&motor->curve, motor->made);
    judge_planned_interval(judge, number, tick, interval, leg);
}

/* How long a move may wait for a pulse without a plan. */
static void judge_gap(struct judge *judge, unsigned number, uint64_t tick)
{
    struct judge_motor *motor = &judge->motor[number];
    const struct judge_limits *limits = &judge->limits;
    uint64_t before = motor->made > 1 ? motor->last_tick : motor->start_tick;
    uint64_t allowed = limits->tick_hz / limits->slowest + limits->slack_ticks;
    allowed += motor->made > 1 ? 0 : limits->lead_ticks;
    if (tick - before > allowed) {
        judge_complain_move(judge, number, JUDGE_RULE_GAP, "has a gap that ends at", tick);
    }
}

/* Two pulses of a motor, in one move or in two. */
static void judge_too_close(struct judge *judge, unsigned number, uint64_t tick)
{
    const struct judge_motor *motor = &judge->motor[number];
    const struct judge_limits *limits = &judge->limits;
    if (motor->has_pulse && (tick - motor->last_tick + limits->slack_ticks) * limits->speed < limits->tick_hz) {
        judge_complain(judge, judge_key(JUDGE_RULE_TOO_CLOSE, number, 0),
                       "motor %u: pulses faster than %" PRIu32 " steps/s at tick %" PRIu64, number, limits->speed,
                       tick);
    }
}

static void judge_pins(struct judge *judge, unsigned number, uint64_t tick, bool backward)
{
    const struct judge_motor *motor = &judge->motor[number];
    if (motor->disconnected) {
        return;
    }
    if (motor->has_dir_edge && tick - motor->dir_tick < judge->limits.dir_setup_ticks) {
        judge_complain(judge, judge_key(JUDGE_RULE_DIR, number, 0),
                       "motor %u: DIR moves before the pulse at tick %" PRIu64, number, tick);
    }
    if (motor->dir != 0 && motor->dir != (backward ? -1 : 1)) {
        judge_complain(judge, judge_key(JUDGE_RULE_DIR_LEVEL, number, 0),
                       "motor %u: DIR shows the other way at the pulse at tick %" PRIu64, number, tick);
    }
}

/* A pulse goes the way of its move. `way` 0: what way it goes is not known. */
static void judge_way(struct judge *judge, unsigned number, uint64_t tick, int8_t way)
{
    struct judge_motor *motor = &judge->motor[number];
    if (motor->way == 0) {
        motor->way = way;
    } else if (way != 0 && way != motor->way) {
        judge_complain_move(judge, number, JUDGE_RULE_BACK, "steps back at", tick);
    }
}

static void judge_any_pulse(struct judge *judge, uint64_t tick, unsigned number, int8_t way)
{
    struct judge_motor *motor = &judge->motor[number];
    if (tick < judge->tick) {
        judge_complain(judge, judge_key(JUDGE_RULE_TIME, 1, 0), "pulses go back in time at tick %" PRIu64, tick);
    }
    judge->tick = tick;
    judge_too_close(judge, number, tick);
    if (judge->without_moves) {
        motor->made++;
    } else if (!motor->moving || tick <= motor->start_tick) {
        judge_complain(judge, judge_key(JUDGE_RULE_OUTSIDE, number, 0),
                       "motor %u: a pulse outside any move at tick %" PRIu64, number, tick);
    } else {
        motor->made++;
        judge_way(judge, number, tick, way);
        if (motor->planned) {
            judge_planned_pulse(judge, number, tick);
        } else {
            judge_gap(judge, number, tick);
            judge_free_interval(judge, number, tick);
        }
    }
    motor->interval = motor->made > 1 ? tick - motor->last_tick : 0;
    motor->last_tick = tick;
    motor->has_pulse = true;
}

void judge_pulse(struct judge *judge, uint64_t tick, unsigned motor, bool backward)
{
    digest_add(judge, tick * 16U + motor * 2U + (backward ? 1U : 0U));
    if (motor_exists(judge, motor, "pulses")) {
        judge->motor[motor].position += backward ? -1 : 1;
        judge_pins(judge, motor, tick, backward);
        judge_any_pulse(judge, tick, motor, backward ? -1 : 1);
    }
}

void judge_pulse_to(struct judge *judge, uint64_t tick, unsigned number, int64_t position)
{
    if (!motor_exists(judge, number, "pulses")) {
        return;
    }
    struct judge_motor *motor = &judge->motor[number];
    int64_t change = position - motor->position;
    bool free = judge->limits.counter_set && motor->moving && motor->made == 0;
    if (!free && change != 1 && change != -1) {
        judge_complain(judge, judge_key(JUDGE_RULE_POSITION, number, 0),
                       "motor %u: the position does not change by one at tick %" PRIu64, number, tick);
    }
    motor->position = position;
    judge_any_pulse(judge, tick, number, free ? 0 : change > 0 ? 1 : -1);
}

void judge_events_back(struct judge *judge, uint64_t tick)
{
    judge_complain(judge, JUDGE_RULE_TIME, "events go back in time at tick %" PRIu64, tick);
}

void judge_direction(struct judge *judge, uint64_t tick, unsigned number, bool backward)
{
    if (!motor_exists(judge, number, "DIR")) {
        return;
    }
    struct judge_motor *motor = &judge->motor[number];
    if (motor->has_pulse && tick - motor->last_tick < judge->limits.dir_hold_ticks) {
        judge_complain(judge, judge_key(JUDGE_RULE_DIR, number, 0),
                       "motor %u: DIR moves after a pulse at tick %" PRIu64, number, tick);
    }
    motor->dir = backward ? -1 : 1;
    motor->dir_tick = tick;
    motor->has_dir_edge = true;
}

void judge_connect(struct judge *judge, uint64_t tick, unsigned number, bool connected)
{
    struct judge_motor *motor = &judge->motor[number];
    if (motor->moving) {
        judge_complain_move(judge, number, JUDGE_RULE_CONNECTION, connected ? "is connected at" : "is disconnected at",
                            tick);
    }
    motor->disconnected = !connected;
}

void judge_position(struct judge *judge, unsigned number, int64_t position)
{
    struct judge_motor *motor = &judge->motor[number];
    if (motor->moving && motor->has_position && position != motor->position) {
        judge_complain(judge, judge_key(JUDGE_RULE_POSITION, number, 0),
                       "motor %u: the position %" PRId64 " is not the pulses made, %" PRId64, number, position,
                       motor->position);
    }
    motor->position = position;
    motor->has_position = true;
}

void judge_interpreter(struct judge *judge, unsigned number, const struct interpreter *interpreter)
{
    const struct program_memory *memory = &interpreter->memory;
    bool good = interpreter->state <= INTERPRETER_FAILED && interpreter->resume_state <= INTERPRETER_FAILED &&
                interpreter->next <= memory->written && interpreter->place <= memory->written &&
                interpreter->loop_depth <= INTERPRETER_LOOPS_MAX && interpreter->call_depth <= INTERPRETER_CALLS_MAX &&
                interpreter->compound.order.sections <= MOTION_SECTIONS;
    for (unsigned i = 0; good && i < interpreter->loop_depth; i++) {
        good = interpreter->loops[i].body <= memory->written && interpreter->loops[i].left >= 1;
    }
    for (unsigned i = 0; good && i < interpreter->call_depth; i++) {
        good = interpreter->calls[i] <= memory->written;
    }
    if (!good) {
        judge_complain(judge, judge_key(JUDGE_RULE_BOUNDS, number, 0), "motor %u: its program has left its bounds",
                       number);
    }
}

void judge_pass(struct judge *judge)
{
    if (judge->events_of_pass > EVENTS_OF_PASS_MAX) {
        judge_complain(judge, JUDGE_RULE_WORK, "a pass of main did %" PRIu32 " things", judge->events_of_pass);
    }
    judge->events_of_pass = 0;
}

void judge_exchange(struct judge *judge, uint32_t requests, uint32_t answers)
{
    digest_add(judge, answers);
    if (requests != answers) {
        judge_complain(judge, JUDGE_RULE_ANSWERS, "%" PRIu32 " answers to %" PRIu32 " requests", answers, requests);
    }
}

void judge_flash(struct judge *judge, uint32_t rewrites)
{
    if (rewrites != 0) {
        judge_complain(judge, JUDGE_RULE_FLASH, "%" PRIu32 " words of the flash were written when not erased",
                       rewrites);
    }
}

void judge_event(struct judge *judge, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    digest_add(judge, tick);
    digest_add(judge, motor * 16U + (unsigned)event);
    digest_add(judge, (uint64_t)value);
    judge->events_of_pass++;
    if (motor == 0) {
        for (unsigned i = 1; i <= JUDGE_MOTORS && (event == HAL_TRACE_STOP || event == HAL_TRACE_ERROR); i++) {
            judge_motor_event(judge, tick, i, event, value);
        }
    } else if (motor_exists(judge, motor, "events")) {
        judge_motor_event(judge, tick, motor, event, value);
    }
}
