/*
 * A course: the legs of one vector, from where it is entered to where it is left, in exact terms.
 *
 * A leg is a ramp or a cruise, from corner to corner; corners lie at real places, whole numbers of grains, and at real
 * times. All axes of the path have the same legs. Pure functions; main or plan interrupt.
 */
#ifndef PATH_COURSE_H
#define PATH_COURSE_H

#include <stdbool.h>
#include <stdint.h>

#include "base_wide.h"
#include "path_divide.h"
#include "path_vector.h"

enum {
    PATH_LEGS = 3
};

/* Where a vector is entered: at its beginning, or where the path was changed, or where it stood. */
struct path_entry {
    struct wide time;  /* ticks, 64.64 */
    struct wide place; /* grains from the beginning of the vector; even */
    uint64_t speed2;   /* vector's own terms */
};

struct path_leg {
    struct wide time;      /* at its beginning: ticks, 64.64 */
    struct wide place;     /* grains */
    struct wide end;       /* grains */
    struct wide slope;     /* quanta a tick, 64.64 */
    struct wide begin;     /* of a cruise: its place in steps, 64.64, */
    struct wide pace;      /* and ticks a step, 64.64 */
    uint64_t twice_speed2; /* at its beginning */
    int32_t accel;         /* that of the vector; negative when braking, 0: cruise */
};

struct path_course {
    struct path_leg leg[PATH_LEGS];
    unsigned legs; /* those that have a way; none where a path that stops stands from the beginning */

    /* Of the vector, for all that is computed on its legs. */
    uint64_t grains_per_step;
    struct wide whole; /* the end of the vector, grains */
    struct path_divisor per_length;
    struct path_divisor per_accel; /* by twice the acceleration, where there is a ramp */
    uint32_t length;

    struct wide end;      /* grains: the end of the vector, or where the path comes to rest in it */
    struct wide end_time; /* ticks, 64.64 */
};

/* A speed whose root has been drawn. All 0: that of a stand. */
struct path_speed {
    uint64_t twice_speed2;
    struct wide slope; /* quanta a tick, 64.64 */
    struct wide pace;  /* ticks a step, 64.64; 0: not known yet */
};

/* The speeds that were needed last: a vector is entered with the speed with which the one before was left. */
struct path_speeds {
    struct path_speed known[2];
    unsigned last; /* the younger one */
};

/* A pulse of an axis: its exact time, and how fast the path goes there. */
struct path_pulse {
    uint64_t ticks;
    uint32_t fraction; /* 2^-32 tick */
    uint64_t slope256; /* of the path, 1/256 quantum a tick */
};

/* What a vector is laid for. Speeds are its own. */
struct path_goal {
    uint64_t exit_speed2; /* with which its end is left; within reach of the entry */
    uint32_t speed;       /* as high as it may be, but for the exit's; 0: it brakes to exit_speed2 as soon as it can */
    uint32_t start_speed; /* from that down to `speed` it falls at once */
    bool rests;           /* it brakes to exit_speed2 and rests there; at once where it is no faster */
};

/* Lays the legs of a vector from its entry to its end, or to its rest. `speeds` saves drawing roots again, and changes
 * nothing else. */
void path_course_lay(struct path_course *course, const struct path_section *section, const struct path_entry *entry,
                     const struct path_goal *goal, struct path_speeds *speeds);

/* The last pulse of an axis with so many steps that is due up to a place, in grains. */
uint32_t path_course_last_pulse(const struct path_course *course, struct wide place, uint32_t steps);

/* Pulse `pulse` of an axis with so many steps, on a leg that it lies on. */
struct path_pulse path_course_pulse(const struct path_course *course, const struct path_leg *leg, uint32_t steps,
                                    uint32_t pulse);

/* The path at a place of a leg, in even grains; as an entry it loses nothing. */
struct path_entry path_course_at(const struct path_course *course, const struct path_leg *leg, struct wide place);

/* The same at a whole step, on whichever leg it is; of one before the course begins its beginning. */
struct path_entry path_course_step(const struct path_course *course, uint64_t step);

/* The same at a place of a cruise, in grains of which `grains_per_step` are a step. */
struct path_entry path_course_cruise_at(const struct path_leg *leg, struct wide place, uint64_t grains_per_step);

#endif
