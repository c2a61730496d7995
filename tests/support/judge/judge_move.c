#include <inttypes.h>
#include <stddef.h>

#include "judge_private.h"

void judge_complain_move(struct judge *judge, unsigned number, enum judge_rule rule, const char *what, uint64_t tick)
{
    const struct judge_motor *motor = &judge->motor[number];
    judge_complain(judge, judge_key(rule, number, motor->moves),
                   "motor %u: the move at tick %" PRIu64 " %s tick %" PRIu64, number, motor->start_tick, what, tick);
}

static void complain_steps(struct judge *judge, unsigned number, enum judge_rule rule, const char *what, int64_t made)
{
    const struct judge_motor *motor = &judge->motor[number];
    judge_complain(judge, judge_key(rule, number, motor->moves),
                   "motor %u: the move at tick %" PRIu64 " of %" PRId64 " steps %s: %" PRId64, number,
                   motor->start_tick, motor->steps, what, made);
}

static uint64_t magnitude(int64_t value)
{
    return value < 0 ? (uint64_t)-value : (uint64_t)value;
}

/* A move without end that no stop has explained. */
static void judge_unexplained(struct judge *judge, unsigned number)
{
    struct judge_motor *motor = &judge->motor[number];
    if (motor->unexplained) {
        judge_complain(judge, judge_key(JUDGE_RULE_TARGET, number, motor->moves),
                       "motor %u: the move at tick %" PRIu64 " of 0 steps ended at %" PRId64 " with no stop", number,
                       motor->start_tick, (int64_t)motor->made * motor->way);
    }
    motor->unexplained = false;
}

static void begin_move(struct judge *judge, uint64_t tick, unsigned number, int64_t steps)
{
    struct judge_motor *motor = &judge->motor[number];
    judge_unexplained(judge, number);
    if (motor->moving) {
        judge_complain(judge, judge_key(JUDGE_RULE_PAIR, number, motor->moves),
                       "motor %u: no done of the move at %" PRIu64, number, motor->start_tick);
    }
    motor->moves++;
    motor->start_tick = tick;
    motor->steps = steps;
    motor->made = 0;
    motor->interval = 0;
    motor->leg = NULL;
    motor->start_excess = 0.0L;
    motor->way = steps > 0 ? 1 : steps < 0 ? -1 : 0;
    motor->moving = true;
    motor->planned = false;
    motor->cut = false;
    motor->nothing = false;
}

void judge_order(struct judge *judge, unsigned number, const struct motion_order *order, int64_t position)
{
    struct judge_motor *motor = &judge->motor[number];
    motor->position = position;
    motor->has_position = true;
    motor->planned = true;
    judge_curve_begin(&motor->curve, order);
}

/* The pulses of a move against what it was asked for and what it says. */
static void judge_count(struct judge *judge, unsigned number, int64_t told)
{
    const struct judge_motor *motor = &judge->motor[number];
    uint64_t asked = magnitude(motor->steps);
    if (motor->made != magnitude(told)) {
        judge_complain(judge, judge_key(JUDGE_RULE_COUNT, number, motor->moves),
                       "motor %u: the move at tick %" PRIu64 " made %" PRIu64 " pulses, its done says %" PRId64, number,
                       motor->start_tick, motor->made, told);
    }
    if (asked != 0 && motor->made > asked) {
        judge_complain(judge, judge_key(JUDGE_RULE_TARGET, number, motor->moves),
                       "motor %u: the move at tick %" PRIu64 " made %" PRIu64 " pulses for %" PRIu64 " steps", number,
                       motor->start_tick, motor->made, asked);
    }
}

static void judge_target(struct judge *judge, unsigned number, int64_t told)
{
    struct judge_motor *motor = &judge->motor[number];
    bool other_way = (motor->steps > 0 && told < 0) || (motor->steps < 0 && told > 0);
    if (other_way) {
        complain_steps(judge, number, JUDGE_RULE_END, "went the other way", told);
    } else if (told != motor->steps && !motor->cut && motor->steps != 0) {
        judge_complain(judge, judge_key(JUDGE_RULE_END, number, motor->moves),
                       "motor %u: the move at tick %" PRIu64 " of %" PRId64 " steps ended at %" PRId64 " with no stop",
                       number, motor->start_tick, motor->steps, told);
    }
    if (motor->steps == 0 && motor->way != 0 && told * motor->way < 0) {
        complain_steps(judge, number, JUDGE_RULE_BACK, "steps back", told);
    }
    motor->unexplained = motor->steps == 0 && !motor->cut;
}

/* A plan that is known says where a move ends, and `done` is at its last pulse. */
static void judge_plan_end(struct judge *judge, unsigned number, uint64_t tick)
{
    const struct judge_motor *motor = &judge->motor[number];
    bool nothing = motor->nothing && motor->made == 0;
    if (!nothing && motor->made != motor->curve.last) {
        complain_steps(judge, number, JUDGE_RULE_AFTER_STOP, "does not end where its plan does, but at",
                       (int64_t)motor->made);
    }
    if (tick != (motor->made > 0 ? motor->last_tick : motor->start_tick)) {
        judge_complain_move(judge, number, JUDGE_RULE_DONE_TICK, "has a done that is not at its last pulse:", tick);
    }
}

static void end_move(struct judge *judge, uint64_t tick, unsigned number, int64_t told)
{
    struct judge_motor *motor = &judge->motor[number];
    if (!motor->moving) {
        judge_complain(judge, judge_key(JUDGE_RULE_PAIR, number, motor->moves),
                       "motor %u: done without a move at %" PRIu64, number, tick);
        return;
    }
    judge_count(judge, number, told);
    judge_target(judge, number, told);
    if (motor->planned) {
        judge_plan_end(judge, number, tick);
    } else {
        judge_free_end(judge, number);
    }
    motor->moving = false;
}

/* A stop, or an error: it explains why a move ends early, and a plan that is known says where. It takes effect at the
 * first pulse after its cause; an interrupt that is late may have seen that pulse come. */
static void cut_move(struct judge *judge, uint64_t tick, unsigned number, int64_t cause)
{
    struct judge_motor *motor = &judge->motor[number];
    motor->unexplained = false;
    if (!motor->moving) {
        return;
    }
    bool before_all = tick <= motor->start_tick && motor->made == 0 && !motor->cut;
    motor->nothing = motor->nothing || before_all;
    motor->cut = true;
    if (!motor->planned) {
        return;
    }
    if (cause == AXIS_CAUSE_LIMIT) {
        judge_curve_halt(&motor->curve, motor->made);
    } else {
        bool took_back = motor->made > 0 && tick < motor->last_tick;
        judge_curve_stop(&motor->curve, motor->made + (took_back ? 0U : 1U));
        motor->leg = NULL;
    }
}

void judge_motor_event(struct judge *judge, uint64_t tick, unsigned number, enum hal_trace_event event, int64_t value)
{
    struct judge_motor *motor = &judge->motor[number];
    switch (event) {
    case HAL_TRACE_MOVE:
        begin_move(judge, tick, number, value);
        break;
    case HAL_TRACE_DONE:
        end_move(judge, tick, number, value);
        break;
    case HAL_TRACE_STOP:
        cut_move(judge, tick, number, value);
        break;
    case HAL_TRACE_ERROR:
        motor->cut = motor->cut || motor->moving;
        motor->unexplained = false;
        break;
    case HAL_TRACE_SPEED:
        if (motor->moving && motor->planned) {
            judge_curve_change_speed(&motor->curve, motor->made + 1U, (uint32_t)value);
            motor->leg = NULL;
        }
        break;
    case HAL_TRACE_START:
    case HAL_TRACE_OUT:
    case HAL_TRACE_VAR:
    case HAL_TRACE_WAIT:
    case HAL_TRACE_COMMAND:
    case HAL_TRACE_END:
        break;
    }
}

void judge_restart(struct judge *judge)
{
    for (unsigned i = 1; i <= JUDGE_MOTORS; i++) {
        struct judge_motor *motor = &judge->motor[i];
        motor->moving = false;
        motor->disconnected = false;
        motor->unexplained = false;
        motor->position = 0;
        motor->has_position = false;
        motor->has_pulse = false;
        motor->dir = 0;
    }
    judge->events_of_pass = 0;
}

/* The next pulse of a plan should have come. */
static void judge_overdue(struct judge *judge, uint64_t tick, unsigned number)
{
    struct judge_motor *motor = &judge->motor[number];
    uint64_t next = motor->made + 1U;
    if (!motor->moving || !motor->planned || motor->nothing || next > motor->curve.last) {
        return;
    }
    long double due = (long double)motor->start_tick + judge_curve_tick(&motor->curve, next);
    if (due + (long double)judge->limits.slack_ticks < (long double)tick) {
        judge_complain_move(judge, number, JUDGE_RULE_OVERDUE, "owes a pulse at", tick);
    }
}

void judge_finish(struct judge *judge, uint64_t tick)
{
    for (unsigned i = 1; i <= JUDGE_MOTORS; i++) {
        judge_unexplained(judge, i);
        if (tick != UINT64_MAX) {
            judge_overdue(judge, tick, i);
        }
    }
}
