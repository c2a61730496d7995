/*
 * An axis in the soak test of the positioning unit: what the master tells it, by chance, and where the contract says
 * that it has to stand. B and M are those of the contract; the axis is never referenced, so C and X stay 0.
 */
#ifndef POS_SOAK_AXIS_H
#define POS_SOAK_AXIS_H

#include "pos_soak.h"

enum pos_soak_doing {
    POS_SOAK_RESTS,   /* a measure may be given */
    POS_SOAK_MOVES,   /* until POL */
    POS_SOAK_GIVES_UP /* POS_INIT in motion: until it stands */
};

struct pos_soak_axis {
    struct pos_soak *soak;
    uint64_t *chance;
    unsigned number; /* 1 to 4 */
    bool faithful;   /* every measure is relative, and is made to its end: M is the sum of all ways */
    int64_t steps;
    int64_t micrometres;
    uint32_t feed_max; /* 100 000 steps/s */
    int64_t base;      /* B */
    int64_t way;       /* M */
    int64_t next_base;
    int64_t next_way;
    enum pos_soak_doing doing;
    uint16_t instruction;
    uint32_t held; /* for so many requests more */
    uint32_t slow; /* likewise */
    uint64_t measures;
    uint64_t given_up;
    uint64_t holds;
    uint64_t feeds;
};

/* Writes the settings of an axis. */
void pos_soak_axis_begin(struct pos_soak_axis *axis, struct pos_soak *soak, unsigned number, uint64_t *chance);

/* Takes the axis, with POS_INIT. */
void pos_soak_axis_take(struct pos_soak_axis *axis);

/* CONTROL and FEED, of the next request. */
void pos_soak_axis_feed(struct pos_soak_axis *axis, uint16_t *words);

/* Sends an instruction in place of feeds, if it is time for one. The cycles of the master that are left bound the way;
 * 0: no measure begins any more. */
bool pos_soak_axis_instruct(struct pos_soak_axis *axis, uint64_t cycles_left);

/* Holds the fast image that was read last against the contract. */
void pos_soak_axis_see(struct pos_soak_axis *axis);

/* Writes registers, and reads the fast image. */
void pos_soak_fast_image(struct pos_soak *soak, unsigned first, uint32_t count, const uint16_t *words);

#endif
