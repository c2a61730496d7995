/*
 * What the summary counts for a motor, as it happens. Pulses are those at the pin: while outputs are disconnected (T41)
 * the position goes on without them.
 */
#ifndef TALLY_H
#define TALLY_H

#include <stdbool.h>
#include <stdint.h>

struct tally {
    uint64_t moves;
    uint64_t pulses;
    uint64_t moving_ticks;   /* in moves that have ended */
    uint64_t shortest_ticks; /* between two pulses of a move, or its start and first pulse; 0: no pulse yet */
    uint64_t move_tick;      /* start of the move in progress */
    uint64_t move_pulses;    /* pulses before it */
    uint64_t pulse_tick;     /* of its last pulse; of its start before the first */
    int64_t position;        /* at pulse_tick, steps */
    bool moving;
};

void tally_begin_move(struct tally *tally, uint64_t tick, int64_t position);

/* Returns the time since the pulse before, or since the start of the move; 0 if that pulse did not reach the pin.
 * `position` is the one after the pulse. */
uint64_t tally_count_pulse(struct tally *tally, uint64_t tick, int64_t position);

/* `together`: other motors have moved, and without pulses the move was none of this one. */
void tally_end_move(struct tally *tally, uint64_t tick, bool together);

/* Time spent in moves up to `now_ticks`; one that goes on then counts as it would if it ended. */
uint64_t tally_moving_ticks(const struct tally *tally, uint64_t now_ticks, bool together);

#endif
