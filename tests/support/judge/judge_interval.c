#include <math.h>

#include "judge_private.h"

/* Ticks. Two neighbouring intervals share three pulses, each rounded by half a tick. */
enum {
    CRUISE_SLACK = 1,
    RAMP_SLACK = 2
};

/* Ticks from one pulse to the next at w. */
static long double interval_at(const struct judge *judge, long double w)
{
    return (long double)judge->limits.tick_hz / sqrtl(w);
}

/* Two neighbouring intervals, three pulses, on one leg: equal in cruise, falling on a ramp up, rising on one down. */
static void judge_monotone(struct judge *judge, unsigned number, uint64_t tick, uint64_t interval,
                           const struct judge_leg *leg)
{
    const struct judge_motor *motor = &judge->motor[number];
    if (motor->interval == 0 || motor->leg != leg || (long double)motor->made - 2.0L < leg->from) {
        return;
    }
    int64_t change = (int64_t)interval - (int64_t)motor->interval;
    int64_t slack = leg->accel == 0.0L ? CRUISE_SLACK : RAMP_SLACK;
    if ((leg->accel >= 0.0L && change > slack) || (leg->accel <= 0.0L && change < -slack)) {
        judge_complain_move(judge, number, JUDGE_RULE_MONOTONE, "has an interval out of its order at", tick);
    }
}

void judge_planned_interval(struct judge *judge, unsigned number, uint64_t tick, uint64_t interval,
                            const struct judge_leg *leg)
{
    struct judge_motor *motor = &judge->motor[number];
    long double ticks = (long double)interval;
    long double slack = (long double)judge->limits.slack_ticks;
    if (interval != 0) {
        if (ticks + slack < interval_at(judge, motor->curve.most_w)) {
            judge_complain_move(judge, number, JUDGE_RULE_FAST, "is faster than its V at", tick);
        }
        if (ticks > interval_at(judge, motor->curve.least_w) + slack) {
            judge_complain_move(judge, number, JUDGE_RULE_GAP, "has a gap that ends at", tick);
        }
        /* The mean speed of the interval is at most that at its begin. */
        long double speed = (long double)judge->limits.tick_hz / (ticks + slack);
        if (speed * speed > judge_curve_stoppable_w(&motor->curve, motor->made - 1U)) {
            judge_complain_move(judge, number, JUDGE_RULE_WAY, "is too fast for the way that is left at", tick);
        }
        judge_monotone(judge, number, tick, interval, leg);
    }
    motor->leg = leg;
}

/* i steps after the start w is at most S^2 + 2*A*i, and so it is before the end, where a stopped move may stand up to
 * a step before the end of its ramp: i + 1. The end is not known yet, so the greatest w - 2*A*i is kept until then. The
 * pulse before the move, if there is one, ends an interval too. */
static void judge_ends(struct judge *judge, unsigned number, uint64_t tick)
{
    struct judge_motor *motor = &judge->motor[number];
    const struct judge_limits *limits = &judge->limits;
    if (!motor->has_pulse) {
        return;
    }
    long double speed = (long double)limits->tick_hz / (long double)(tick - motor->last_tick + limits->slack_ticks);
    long double gain = 2.0L * (long double)limits->accel;
    long double slow = (long double)limits->start_speed * (long double)limits->start_speed;
    if (speed * speed > slow + gain * (long double)motor->made) {
        judge_complain_move(judge, number, JUDGE_RULE_ENDS, "starts or ends too fast at", tick);
    }
    long double excess = speed * speed + gain * (long double)motor->made;
    if (excess > motor->start_excess) {
        motor->start_excess = excess;
        motor->start_excess_tick = tick;
    }
}

void judge_free_end(struct judge *judge, unsigned number)
{
    const struct judge_motor *motor = &judge->motor[number];
    const struct judge_limits *limits = &judge->limits;
    long double slow = (long double)limits->start_speed * (long double)limits->start_speed;
    if (motor->start_excess > slow + 2.0L * (long double)limits->accel * (long double)(motor->made + 2U)) {
        judge_complain_move(judge, number, JUDGE_RULE_ENDS, "starts or ends too fast at", motor->start_excess_tick);
    }
}

/* The mean speeds of two neighbouring intervals differ by no more than the acceleration makes of their mean length,
 * unless the speed jumps, which it may up to S: it cannot where one of them, squared, is above S^2 + 4*A, as two steps
 * of braking would not reach S. Rounding moves each by up to speed*slack/interval. */
static void judge_accel(struct judge *judge, unsigned number, uint64_t tick)
{
    const struct judge_motor *motor = &judge->motor[number];
    const struct judge_limits *limits = &judge->limits;
    if (motor->interval == 0) {
        return;
    }
    long double hz = (long double)limits->tick_hz;
    long double slack = (long double)limits->slack_ticks;
    long double accel = (long double)limits->accel;
    long double before = (long double)motor->interval;
    long double now = fmaxl((long double)(tick - motor->last_tick), 1.0L);
    long double before_off = hz / before * slack / fmaxl(before - slack, 1.0L);
    long double now_off = hz / now * slack / fmaxl(now - slack, 1.0L);
    long double jump = fabsl(hz / now - hz / before) - before_off - now_off;
    long double sure = fmaxl(hz / before - before_off, hz / now - now_off);
    long double start = (long double)limits->start_speed;
    if (sure * sure > start * start + 4.0L * accel && jump > accel * (before + now) / (2.0L * hz)) {
        judge_complain_move(judge, number, JUDGE_RULE_ACCEL, "changes its speed too fast at", tick);
    }
}

void judge_free_interval(struct judge *judge, unsigned number, uint64_t tick)
{
    judge_ends(judge, number, tick);
    judge_accel(judge, number, tick);
}
