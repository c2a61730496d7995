/*
 * The one judge of every simulated run: fed by the edge log as it is made, it says what must never be.
 *
 * Comes in: pulses, DIR edges, trace events in the order in which the machine tells them, and, where a caller has them,
 * the order of each move and what the unit says of itself after each pass. Goes out: complaints, each a sentence; none
 * for a lawful run. Motors count from 1, ticks from the start of the machine. No heap, no output; a caller owns the
 * struct (70 kB). Unit tests, fuzzers and rkm04-judge (for files of the simulator and of the virtual board) use it.
 *
 * The invariants of a run, and how each is seen:
 *
 *  1 signed pulses = change of the position    judge_position after each pass and at `done`; in files the column of
 *                                              positions
 *  2 never faster than V in force, never       intervals against the fastest place of the plan (without a plan: the
 *    slower than the plan                      limits); slower than the plan is 3, pulse by pulse
 *  3 every pulse within 1 tick of the exact    judge_curve, for each move whose order is known; without orders the
 *    reference                                 acceleration between neighbours and at both ends of a move is bounded
 *  4 monotone on ramps, equal in cruise        neighbouring intervals of one leg of the plan
 *  5 the way left is a stopping distance       speed of each interval against the way left, section by section
 *  6 ends at the target, no pulse after       `done` against pulses, plan and target; pulses outside of moves
 *    `done`, no `done` before the last pulse
 *  7 DIR stands still around each pulse, STEP  DIR edges against pulses; on the host machine not how soon after one,
 *    high and low long enough                  and not the width of STEP: the board's driver has both in
 *                                              hal/stm32/stm32_step_setup.c, tests/vboard/test_step_pins.py shows them.
 *                                              STEP low is what is left of the interval, bounded by 2. Both are
 *                                              disconnected and connected while the motor stands: judge_connect
 *  8 no gap inside a move                      intervals against the slowest place of the plan (or the lowest speed),
 *                                              and no pulse overdue when the run is over
 *  9 no pulse too many after a stop            the plan ends where the stop lets it
 * 10 one answer for each request, none for a   judge_exchange, as whoever sends the requests counts them
 *    broadcast
 * 11 program counter and stacks in bounds,     judge_interpreter and judge_pass after each pass
 *    bounded work
 * 12 flash: no 0 to 1 without erase, no write  judge_flash; writes outside of an area end in an assertion of the host
 *    outside                                   machine
 * 13 same seed, same bytes                     not to be seen in one run: judge_digest of two runs must be the same
 * 14 a shifted epoch shifts nothing but times  likewise; ticks count from the start, so the digest must be the same
 */
#ifndef JUDGE_H
#define JUDGE_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_trace.h"
#include "interpreter.h"
#include "judge_curve.h"

enum {
    JUDGE_MOTORS = 4,
    JUDGE_COMPLAINTS_MAX = 24,
    JUDGE_TEXT_BYTES = 160,
};

/* The greatest values that a run may use, for what is not known from orders. */
struct judge_limits {
    uint32_t tick_hz;
    uint32_t slowest; /* steps/s */
    uint32_t start_speed;
    uint32_t speed;
    uint32_t accel;           /* steps/s^2 */
    uint32_t slack_ticks;     /* rounding of an interval: a tick for the pulse at each end */
    uint32_t lead_ticks;      /* by which a move may begin later than its clock says */
    uint32_t dir_setup_ticks; /* DIR stands still before a pulse, */
    uint32_t dir_hold_ticks;  /* and after it; 0 on the host machine, whose main may run at the tick of a pulse */
    bool counter_set;         /* programs write the position counter: in files it may jump between moves */
};

struct judge_complaint {
    char text[JUDGE_TEXT_BYTES];
    uint64_t key;   /* what tells one complaint from another: sentence, motor, move */
    uint32_t times; /* how often */
};

/* What is known of one motor. */
struct judge_motor {
    struct judge_curve curve; /* while `planned` */
    uint64_t moves;           /* begun so far */
    uint64_t start_tick;      /* of the move */
    int64_t steps;            /* asked for, signed; 0: no end */
    uint64_t made;
    int64_t position;
    uint64_t last_tick;          /* of the last pulse */
    uint64_t interval;           /* before the last pulse, if it lies in the move; else 0 */
    const struct judge_leg *leg; /* of the last pulse but one; null: not known */
    uint64_t dir_tick;
    long double start_excess; /* of the ends of a move: the greatest w - 2*A*i */
    uint64_t start_excess_tick;
    int8_t way; /* +1, -1; 0: not known yet */
    int8_t dir; /* of the pin, likewise */
    bool has_pulse;
    bool has_dir_edge;
    bool has_position;
    bool moving;
    bool planned;      /* the order of the move is known */
    bool disconnected; /* its pulses do not reach the pins (T41) */
    bool cut;          /* a stop or an error fell into the move */
    bool nothing;      /* a guard had its level at the start: no pulse may come */
    bool unexplained;  /* a move without end has ended, and no cause has come yet */
};

struct judge {
    struct judge_limits limits;
    struct judge_motor motor[JUDGE_MOTORS + 1]; /* from 1 */
    struct judge_complaint complaint[JUDGE_COMPLAINTS_MAX];
    uint32_t complaints;
    uint32_t lost_complaints; /* there was no room for them */
    uint32_t events_of_pass;
    uint64_t tick; /* of the last pulse of any motor */
    uint64_t digest;
    bool without_moves; /* there is no trace: pulses belong to no move that is known */
};

/* The limits of the language and of the host machine. */
struct judge_limits judge_default_limits(void);

void judge_init(struct judge *judge, const struct judge_limits *limits);

/* A pulse, as an edge with a direction, or as a line of a file with the position after it. */
void judge_pulse(struct judge *judge, uint64_t tick, unsigned motor, bool backward);
void judge_pulse_to(struct judge *judge, uint64_t tick, unsigned motor, int64_t position);

/* Of a file: its events are not in order at this tick. */
void judge_events_back(struct judge *judge, uint64_t tick);

/* An edge of DIR. */
void judge_direction(struct judge *judge, uint64_t tick, unsigned motor, bool backward);

/* An event of the trace; motor 0: the unit. */
void judge_event(struct judge *judge, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value);

/* Right after the event MOVE: what was ordered, and the position. From now on the move is judged pulse by pulse. */
void judge_order(struct judge *judge, unsigned motor, const struct motion_order *order, int64_t position);

/* STEP and DIR of a motor are disconnected (T41) or connected again: never inside a move. Pulses are told as before. */
void judge_connect(struct judge *judge, uint64_t tick, unsigned motor, bool connected);

/* After a pass of main: what the unit holds for the position; its interpreters; and the end of all that. */
void judge_position(struct judge *judge, unsigned motor, int64_t position);
void judge_interpreter(struct judge *judge, unsigned motor, const struct interpreter *interpreter);
void judge_pass(struct judge *judge);

/* Requests that want an answer, and the answers. */
void judge_exchange(struct judge *judge, uint32_t requests, uint32_t answers);

/* Words of the flash that were written when not erased. */
void judge_flash(struct judge *judge, uint32_t rewrites);

/* The unit is being switched off and on: what was begun is over, and edges of DIR mean nothing. Before the pins
 * fall. */
void judge_restart(struct judge *judge);

/* The run is over at a tick; UINT64_MAX: not known, what is overdue is not told. */
void judge_finish(struct judge *judge, uint64_t tick);

/* The text of a complaint, with how often; written to `text`. */
void judge_tell(const struct judge *judge, uint32_t complaint, char text[JUDGE_TEXT_BYTES + 32]);

/* A number that two runs share when their pulses and events are the same. */
uint64_t judge_digest(const struct judge *judge);

#endif
