#include "motion_point.h"

#include "step_scale.h"

static uint64_t size_of(int64_t value)
{
    return value < 0 ? (uint64_t)-value : (uint64_t)value;
}

/* Along a segment slope^2 - 4*accel*position does not change (v^2 = v0^2 + 2*A*x), so the square at
 * the whole step follows from slope and residual at the tick next to it. In (steps/s)^2 it is a
 * whole number, which takes the rounding away: slope = speed * STEP_SLOPE_PER_SPEED, and
 * STEP_SLOPE_PER_SPEED^2 = 2 * STEP_ACCEL_PER_ACCEL * STEP_QUANTA. */
static uint64_t speed2_at_step(const struct step_generator *generator, int64_t residual)
{
    struct wide square = wide_multiply(generator->slope, generator->slope);
    struct wide change = wide_multiply(4U * size_of(generator->accel), size_of(residual));
    bool rises = (generator->accel < 0) != (residual < 0);
    square = rises ? wide_add(square, change) : wide_subtract(square, change);
    uint64_t scaled = wide_divide_nearest(square, STEP_QUANTA);
    return (scaled + STEP_ACCEL_PER_ACCEL) / (2U * STEP_ACCEL_PER_ACCEL);
}

struct motion_point motion_point_of(const struct step_cursor *cursor, uint64_t near_ticks)
{
    const struct step_generator *generator = &cursor->generator;
    int64_t residual = wide_to_signed(generator->residual);
    struct motion_time before = {.ticks = tick_extend(generator->tick, near_ticks) - 1U};
    struct wide distance = {.low = generator->slope - generator->residual};
    return (struct motion_point){
        .time = motion_time_add(before, distance, generator->slope),
        .step = step_cursor_pulse(cursor),
        .speed2 = speed2_at_step(generator, residual),
    };
}
