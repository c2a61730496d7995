/*
 * Paths compiled for Cortex-M4, as path_count.py calls them function by function: a chain of vectors of four axes, to
 * which a vector is added each time that one has been handed over.
 */
#include <stdbool.h>
#include <stdint.h>

#include "path.h"

enum {
    RING = 128,
    TURN_US = 12
};

static struct path path;
static struct path_section ring[RING];
static struct path_segment segment;

void bench_begin(void);
bool bench_add(int32_t x, int32_t y, int32_t z, uint32_t speed_and_accel);
bool bench_start(void);
uint32_t bench_entry(void);
bool bench_next(unsigned axis, uint32_t until);

void bench_begin(void)
{
    path_init(&path, ring, RING, TURN_US);
}

/* Axis 3 makes a third of the steps of axis 0. Speed in units of 1000 steps/s in the low half, acceleration in units of
 * 1000 steps/s^2 in the high one. */
bool bench_add(int32_t x, int32_t y, int32_t z, uint32_t speed_and_accel)
{
    uint64_t length2 = (uint64_t)((int64_t)x * x);
    const struct path_vector vector = {
        .steps = {x, y, z, x / 3},
        .speed = (speed_and_accel & 0xFFFFU) * 1000U * PATH_SPEED_UNITS,
        .accel = (speed_and_accel >> 16U) * 1000U * STEP_ACCEL_PER_ACCEL,
        .extent2 = length2,
        .border_speed = UINT32_MAX,
    };
    return path_add(&path, &vector);
}

bool bench_start(void)
{
    return path_start(&path, 0);
}

/* When the section that is laid next is entered. */
uint32_t bench_entry(void)
{
    return (uint32_t)path.next.time.high;
}

/* The next segment of an axis that begins before a tick; false if there is none. */
bool bench_next(unsigned axis, uint32_t until)
{
    return path_next(&path, axis, until, &segment);
}
