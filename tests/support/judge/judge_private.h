/*
 * What the files of the judge share: judge.c (what comes in), judge_move.c (moves, from MOVE to DONE), judge_interval.c
 * (the interval before a pulse).
 */
#ifndef JUDGE_PRIVATE_H
#define JUDGE_PRIVATE_H

#include "judge.h"

enum judge_rule {
    JUDGE_RULE_NO_MOTOR,
    JUDGE_RULE_TIME,
    JUDGE_RULE_POSITION,
    JUDGE_RULE_TOO_CLOSE,
    JUDGE_RULE_FAST,
    JUDGE_RULE_EXACT,
    JUDGE_RULE_MONOTONE,
    JUDGE_RULE_WAY,
    JUDGE_RULE_OUTSIDE,
    JUDGE_RULE_PAIR,
    JUDGE_RULE_COUNT,
    JUDGE_RULE_TARGET,
    JUDGE_RULE_END,
    JUDGE_RULE_DONE_TICK,
    JUDGE_RULE_BACK,
    JUDGE_RULE_DIR,
    JUDGE_RULE_DIR_LEVEL,
    JUDGE_RULE_CONNECTION,
    JUDGE_RULE_GAP,
    JUDGE_RULE_OVERDUE,
    JUDGE_RULE_AFTER_STOP,
    JUDGE_RULE_ENDS,
    JUDGE_RULE_ACCEL,
    JUDGE_RULE_ANSWERS,
    JUDGE_RULE_BOUNDS,
    JUDGE_RULE_WORK,
    JUDGE_RULE_FLASH,
};

/* The same rule broken by the same motor in the same move is one complaint. */
static inline uint64_t judge_key(enum judge_rule rule, unsigned motor, uint64_t move)
{
    return move << 16U | (uint64_t)motor << 8U | (uint64_t)rule;
}

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void judge_complain(struct judge *judge, uint64_t key, const char *format, ...);

/* "motor 1: the move at tick 1000 <what> tick <tick>" */
void judge_complain_move(struct judge *judge, unsigned motor, enum judge_rule rule, const char *what, uint64_t tick);

/* What of the trace is a motor's own. */
void judge_motor_event(struct judge *judge, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value);

/* The interval before a pulse that is counted already: of a move with a plan, on whose leg the pulse stands (0: it is
 * the first pulse), and of one without. */
void judge_planned_interval(struct judge *judge, unsigned motor, uint64_t tick, uint64_t interval,
                            const struct judge_leg *leg);
void judge_free_interval(struct judge *judge, unsigned motor, uint64_t tick);

/* A move without a plan is over: did it end slowly enough? */
void judge_free_end(struct judge *judge, unsigned motor);

#endif
