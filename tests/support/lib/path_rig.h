/*
 * A path with a ring of its own, and the pulses of its axes as the step generator makes them.
 */
#ifndef PATH_RIG_H
#define PATH_RIG_H

#include "path.h"
#include "step_generator.h"

enum {
    RIG_RING = 8,
    RIG_TURN_US = 12
};

struct path_rig {
    struct path path;
    struct path_section ring[RIG_RING];
};

/* In whole steps/s and steps/s^2, with ordered speeds that count steps of the longest axis. */
static inline struct path_vector rig_vector(int32_t x, int32_t y, uint32_t speed, uint32_t accel)
{
    uint32_t length_x = (uint32_t)(x < 0 ? -x : x);
    uint32_t length_y = (uint32_t)(y < 0 ? -y : y);
    uint64_t length = length_x > length_y ? length_x : length_y;
    return (struct path_vector){
        .steps = {x, y},
        .speed = speed * PATH_SPEED_UNITS,
        .accel = accel * STEP_ACCEL_PER_ACCEL,
        .extent2 = length * length,
        .border_speed = UINT32_MAX,
    };
}

static inline void rig_init(struct path_rig *rig)
{
    path_init(&rig->path, rig->ring, RIG_RING, RIG_TURN_US);
}

static inline bool rig_add(struct path_rig *rig, int32_t x, int32_t y, uint32_t speed, uint32_t accel)
{
    struct path_vector vector = rig_vector(x, y, speed, accel);
    return path_add(&rig->path, &vector);
}

/* Another speed for a section, from the next change or start on. */
static inline void rig_set_speed(struct path *path, uint32_t section, uint32_t speed)
{
    path_ready_speed(path, section, speed);
    path_take_speed(path, section);
}

/* Plans anew from a place, or stops there; false if that is too early. */
static inline bool rig_change(struct path_rig *rig, const struct path_place *place, uint64_t back[PATH_AXES])
{
    bool done = path_back(&rig->path, place, back);
    if (done) {
        path_change(&rig->path, place);
    }
    return done;
}

static inline bool rig_stop(struct path_rig *rig, const struct path_place *place, uint64_t back[PATH_AXES])
{
    bool done = path_back(&rig->path, place, back);
    if (done) {
        path_stop(&rig->path, place);
    }
    return done;
}

/* The ticks of the pulses of an axis that are handed over until a tick, from the one before on; returns how many. The
 * first `most` are kept. */
static inline unsigned rig_pulses(struct path_rig *rig, unsigned axis, uint64_t until_tick, uint64_t *ticks,
                                  unsigned most)
{
    struct step_generator generator = {0};
    struct path_segment next;
    unsigned count = 0;
    while (path_next(&rig->path, axis, until_tick, &next)) {
        step_generator_load(&generator, &next.segment);
        uint64_t tick = next.tick;
        for (uint32_t i = 0; i < next.segment.steps; i++) {
            if (count < most) {
                ticks[count] = tick;
            }
            count++;
            if (i + 1U < next.segment.steps) {
                uint32_t before = generator.tick;
                tick += (uint32_t)(step_generator_next(&generator) - before);
            }
        }
    }
    return count;
}

#endif
