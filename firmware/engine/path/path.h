/*
 * A path: a chain of vectors on one to four axes, from a stand to a stand.
 *
 * Comes in: vectors, into a ring of the caller's. Goes out: for each axis segments for the step generator, each with
 * its direction. Look-ahead over the ring sets the speeds at the borders as high as the vectors, their border speeds
 * and the axes that turn allow; all axes follow the one curve s(t) that results, and pulse k of an axis with d steps is
 * due where s = k*L/d. A path may be changed or stopped at any whole step of its longest axis, and in a cruise between
 * steps too; it rests at a real place and goes on from there, without limit, and every pulse stays on its tick.
 * Pure arithmetic on the caller's structs; main or plan interrupt, never both at once.
 */
#ifndef PATH_H
#define PATH_H

#include <stdbool.h>
#include <stdint.h>

#include "path_course.h"
#include "path_vector.h"
#include "base_tick.h"
#include "../step/step_segment.h"

/* A place at which a change can take effect. Sections are counted from path_init on, modulo 2^32: between a start or a
 * change and the next one a path goes through fewer vectors than that, less the ring's size. */
struct path_place {
    uint32_t section; /* count of the section that begins or goes on there */
    uint32_t accel; /* with which a stop brakes from there, and of whose grains entry.place is; 0: the section's own */
    struct path_entry entry;
};

/* What a path hands over. */
struct path_segment {
    struct step_segment segment;
    uint64_t tick; /* of its first pulse, the unit's time; segment.tick is the low half */
    bool backward; /* DIR: the axis makes negative steps */
};

/* How far the pulses of an axis have been handed over. */
struct path_cursor {
    struct path_pulse at; /* of `pulse`, if it has been found, but was too late to be handed over */
    uint32_t section;     /* count */
    uint32_t pulse;       /* the next one in that section, from 1 */
    uint32_t last;        /* the last one on the present leg */
    unsigned leg;         /* that of the course which it is on; as many as there are: none is left */
    bool entered;         /* `last` is of `leg` */
    bool found;           /* `at` is known */
};

/* The course of a section that has been laid, kept while it is of use. */
struct path_kept {
    struct path_course course;
    uint32_t section; /* count */
    bool valid;
};

enum {
    PATH_KEPT = 2
};

struct path {
    struct path_section *ring;
    uint32_t size;    /* places of the ring */
    uint32_t turn_us; /* what DIR wants */
    uint32_t start_speed;
    uint32_t first;  /* count of the first section in the ring */
    uint32_t laid;   /* count of the first one whose plan may still change */
    uint32_t known;  /* count after the last one that is planned */
    uint32_t looked; /* count after the last one that look-ahead knows: it waits until what is laid next hangs on it */
    uint32_t end;    /* count after the last one in the ring */
    uint32_t chain;  /* count after the last one that a path with a start speed goes on to */
    bool stopping;
    bool too_fast;            /* `laid` is left at the speed to which it can be braked */
    uint8_t axes;             /* that have had steps since path_init: a bit each */
    bool held_back;           /* the speed at which `laid` is entered was as low as the end that was known made it */
    struct path_place origin; /* where the path left a stand, was changed or stopped */
    struct path_entry next;   /* the entry of section `laid` */
    uint64_t border2;         /* its speed2 in terms of borders, unless it is the origin's section */
    struct path_place rest;   /* where it comes to rest: right when laid = known */
    struct path_speeds speeds;
    struct path_cursor axis[PATH_AXES];
    struct path_kept kept[PATH_KEPT];
    struct path_kept *before; /* path_set_before */
};

/* An empty path that stands. `size` places, a power of two, at least 2. `turn_us`: DIR wants so much time from the last
 * pulse one way to the first the other way, 1 to PATH_TURN_US_MAX.
 *
 * The speed at a border where an axis turns is the one at which its first pulse after it, as the path speeds up, comes
 * just late enough: u = L/(T*|d|) - A*T/2 in the vector after the border. Where that is not above 0 it is 0, the path
 * stands there for a moment; PATH_TURN_US_MAX is chosen so that this always suffices. Of an axis that rests in a vector
 * before it turns nothing is asked: the caller's vectors last `turn_us` at least, L/speed, if axes do so. */
void path_init(struct path *path, struct path_section *ring, uint32_t size, uint32_t turn_us);

/* The start/stop speed of what begins with the next start, 1/256 step/s of the longest axis, 0 to PATH_SPEED_MAX; 0
 * after path_init. A path with a start speed S
 *   begins with it, or the speed of its first vector if that is less, as far as the end can be braked to; ends with it,
 *   or the speed of its last vector; and goes on with it after a stop,
 *   takes speeds up to S at once where it is changed, no higher than the border allowed as long as an axis that turned
 *   there has not made its first pulse; and falls from S to a speed below at once, in the vector that it is in then,
 *   is stopped when it has braked to S; at once, if it is no faster,
 *   is the vectors that were there when it left the stand, and later ones that go straight on, up to the first that
 *   does not: that one and all after it wait for the next start, as a border with a turn or a low border speed may be
 *   slower than the end that was planned.
 * Borders are as ever: the path is at 0 where a border speed wants it. The path must stand. */
void path_set_start_speed(struct path *path, uint32_t start_speed);

/* Where the path keeps its course up to the last change, as it was before it; NULL, as after path_init: nowhere. It is
 * of use for changes between steps while another one is yet to come, and for path_speed_at. The path must stand. */
void path_set_before(struct path *path, struct path_kept *before);

/* Appends a vector; false if the ring is full. A path that moves joins it by itself, if not all of it has been laid.
 * Look-ahead comes later, once for all vectors that have been added until the path hangs on them. */
bool path_add(struct path *path, const struct path_vector *vector);

/* The speed with which the path comes through a whole step of a section's longest axis, as it is planned, or was before
 * the last change, if that comes after the step (path_set_before); where it was changed between that step and the last
 * change, the speed at the one before. 1/256 step/s; 0 where the section has not been laid. Not for a step after the
 * rest. */
uint32_t path_speed_at(struct path *path, uint32_t section, uint32_t step);

/* Whether a change would make the path faster or longer, as vectors have been added after it had been laid so far that
 * they did not count. */
bool path_lags(struct path *path);

/* Leaves a stand at a whole tick: begins, or goes on from where it rests. False if no vector is left. Pulses up to the
 * rest must have been handed over. */
bool path_start(struct path *path, uint64_t start_tick);

/* Whether an axis has had steps since path_init: else nothing is to be handed over, and path_next need not be asked. */
static inline bool path_moves(const struct path *path, unsigned axis)
{
    return (path->axes >> axis & 1U) != 0U;
}

/* The next segment of an axis; false if there is none whose first pulse is before `until_tick`. Sections that begin
 * later are not laid, so that vectors may still join without a change. */
bool path_next(struct path *path, unsigned axis, uint64_t until_tick, struct path_segment *segment);

/* From when on a path is to be changed. */
struct path_wish {
    uint64_t tick;
    uint64_t patience_ticks; /* in a cruise, also one that begins within so many more, a place between steps is
                                taken if no step is due within them; at least 1; from 2^62 on: whole steps only */
    uint64_t early_ticks;    /* up to PATH_EARLY_US_MAX. On a ramp, where no step is due for so long, a step up to so
                                many earlier than `tick`, if whatever follows a change there comes at `tick` or later */
    uint32_t accel;          /* for a stop with an acceleration of its own, 1 to PATH_ACCEL_MAX; else 0 */
};

enum {
    PATH_EARLY_US_MAX = 330
};

/* The first whole step of the longest axis that is due at or after the wish, or, in a cruise, a place between steps
 * about then, or where the cruise begins. Where the path left its stand or was changed last counts as a step, so that
 * what comes together acts together, unless it is in a cruise until then, and no step is due within the patience; not
 * between steps for a stop with an acceleration of its own. False if the path comes to rest before; where vectors were
 * added after all had been laid, the rest itself is a place. Lays sections up to the wish, goes back over those of the
 * ring at most, and looks at five steps at most. */
bool path_find(struct path *path, const struct path_wish *wish, struct path_place *place);

/* Whether a path that is stopped at a place with an acceleration of its own comes to rest before its end. Not where
 * that brakes less than planned and a vector counts another length (extent2): beyond a border it could be faster than
 * any vector may be. Where it brakes less than planned no axis may turn on the way: it would come through that border
 * faster than DIR wants. */
bool path_can_rest(const struct path *path, const struct path_place *place);

/* Another speed for a section, in two parts, as the first takes time: it changes nothing yet, at any time after the
 * section was added; then it is taken, from the place on at which the path is changed next, or from the next start on.
 * Nothing may be handed over between the second part and that. A section that has been given none takes the speed that
 * it has. */
static inline void path_ready_speed(const struct path *path, uint32_t section, uint32_t speed)
{
    path_section_ready_speed(&path->ring[section & (path->size - 1U)], speed);
}

static inline void path_take_speed(const struct path *path, uint32_t section)
{
    path_section_take_speed(&path->ring[section & (path->size - 1U)]);
}

/* How many of the last pulses of each axis that were handed over lie after a place that path_find has found: those that
 * a change there makes void. False if an axis has not been handed over as far as that. */
bool path_back(const struct path *path, const struct path_place *place, uint64_t back[PATH_AXES]);

/* Plans anew from a place that path_find has found and path_back is true for. */
void path_change(struct path *path, const struct path_place *place);

/* The same, and it brakes to a stand as soon as it can, with the acceleration of each vector that it comes through.
 * With place->accel, for which path_can_rest must be true, it brakes with that one, and so all vectors from there on
 * have it: what is left of the path is not to be gone on with, or so. */
void path_stop(struct path *path, const struct path_place *place);

/* Whether all that is planned has been laid; then `rest` says where and when the path stands. */
bool path_is_laid(const struct path *path);

/* Frees the places of sections before `section`, all of whose pulses have been made. */
void path_drop(struct path *path, uint32_t section);

#endif
