/*
 * A line over time, thinned while it is made: of each column of time at most six points stay, the first, the last, and
 * those of the least and greatest speed and position. So peaks, and where ramps begin and end, stay where they are.
 *
 * Columns begin one tick wide; whenever there may be too many points they become twice as wide and neighbours become
 * one. So a line of few points keeps all of them. Memory: a column for each point, on the heap.
 */
#ifndef THIN_H
#define THIN_H

#include <stdbool.h>
#include <stdint.h>

enum {
    THIN_POINTS_PER_COLUMN = 6
};

struct thin_point {
    uint64_t tick;
    uint64_t ordinal;    /* of all points of the line, from 0 */
    int64_t milli_speed; /* thousandths of a step/s, negative: backward */
    int64_t position;    /* steps */
};

struct thin_column {
    uint64_t index; /* tick >> shift of all its points */
    uint32_t taken; /* points; more than stay are not counted */
    struct thin_point first;
    struct thin_point last;
    struct thin_point slowest; /* these four: of all but the last one, which counts once none follows it */
    struct thin_point fastest;
    struct thin_point lowest;
    struct thin_point highest;
};

struct thin {
    struct thin_column *columns;
    uint32_t count;  /* of columns, at most points_max */
    uint32_t points; /* at least as many as stay */
    uint32_t points_max;
    unsigned shift;    /* the width of a column is 2^shift ticks */
    uint64_t ordinals; /* points taken */
};

/* An empty line of at most so many points (at least THIN_POINTS_PER_COLUMN). False: there is not memory enough. */
bool thin_begin(struct thin *thin, uint32_t points);

/* Adds a point; time never goes back. Its ordinal is given here. */
void thin_put(struct thin *thin, const struct thin_point *point);

/* Writes the points of a column that stay, in their order, and returns how many. */
unsigned thin_list_column(const struct thin_column *column, struct thin_point points[THIN_POINTS_PER_COLUMN]);

void thin_discard(struct thin *thin);

#endif
