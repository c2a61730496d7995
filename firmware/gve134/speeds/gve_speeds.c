#include "gve_speeds.h"

#include "base_wide.h"
#include "path_fixed.h"

#define US_PER_S UINT64_C(1000000)
#define UNITS ((uint64_t)PATH_SPEED_UNITS) /* a pulse/s */
#define SPEED_MAX (UNITS * GVE_SPEED_TOP)
#define HALF_FACTOR ((uint64_t)GVE_FACTOR_ONE / 2U)
#define FACTOR_MIN GVE_FACTOR_PER_CENT
#define FACTOR_MAX (1000U * GVE_FACTOR_PER_CENT)

enum {
    SPATIAL_AXES = 3, /* X, Y, Z: A is not in the extent */
    SIXTEENTHS = 16,
    DELIVERED_SPEED = 1000,
    DELIVERED_ACCEL = 20,
    DELIVERED_SHORT = 512,
};

static_assert(SPEED_MAX < UINT64_C(1) << 26, "the search for a speed has 26 steps");
static_assert(GVE_FACTOR_ONE == 100U * GVE_FACTOR_PER_CENT, "100 per cent");
static_assert(SPEED_MAX * 10U <= UINT32_MAX, "V with the greatest factor fits 32 bits");

void gve_modal_init(struct gve_modal *modal)
{
    *modal = (struct gve_modal){
        .speed = DELIVERED_SPEED,
        .accel = DELIVERED_ACCEL,
        .brake = GVE_SPEED_TOP,
        .short_pulses = DELIVERED_SHORT,
        .pause_ms = 1,
    };
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        modal->limit[axis] = GVE_SPEED_TOP;
    }
}

static uint32_t magnitude(int32_t steps)
{
    return steps < 0 ? 0U - (uint32_t)steps : (uint32_t)steps;
}

static uint32_t longest(const struct gve_vector *vector)
{
    uint32_t length = 0;
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        uint32_t steps = magnitude(vector->steps[axis]);
        length = steps > length ? steps : length;
    }
    return length;
}

struct gve_vector gve_speeds_take(const struct gve_modal *modal, const int32_t steps[PATH_AXES])
{
    struct gve_vector vector = {
        .speed = modal->speed, .brake = modal->brake, .accel = modal->accel, .corrected = modal->corrected};
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        vector.steps[axis] = steps[axis];
    }
    vector.is_short = longest(&vector) < modal->short_pulses;
    return vector;
}

/* The square of the way of X, Y and Z if speeds count it; 0: they count pulses of the longest axis. */
static uint64_t way2(const struct gve_vector *vector)
{
    uint64_t sum = 0;
    for (unsigned axis = 0; vector->corrected && axis < (unsigned)SPATIAL_AXES; axis++) {
        uint64_t steps = magnitude(vector->steps[axis]);
        sum += steps * steps;
    }
    return sum;
}

uint64_t gve_speeds_extent2(const struct gve_vector *vector)
{
    uint64_t way = way2(vector);
    uint64_t length = longest(vector);
    return way != 0 ? way : length * length;
}

static uint64_t lower(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

/* floor(speed*L/E + 1/2), SPEED_MAX if it is more: the greatest r with (2r - 1)^2 * E^2 <= (2*speed*L)^2. */
static uint64_t along_longest(uint64_t speed, uint32_t length, uint64_t extent2)
{
    struct wide square = wide_multiply(speed * speed, (uint64_t)length * length);
    struct wide wanted = wide_shift_left(square, 2);
    uint64_t found = 0;
    for (uint64_t bit = UINT64_C(1) << 25; bit != 0; bit >>= 1U) {
        uint64_t twice = 2U * (found + bit) - 1U;
        if (wide_is_at_least(wanted, wide_multiply(twice * twice, extent2))) {
            found += bit;
        }
    }
    return lower(found, SPEED_MAX);
}

/* V under the factor, at most B where the vector is short; in terms of V. */
static uint64_t ordered(const struct gve_vector *vector, uint32_t factor)
{
    uint64_t scaled = UNITS * vector->speed * factor;
    uint64_t speed = (scaled + HALF_FACTOR) / GVE_FACTOR_ONE;
    uint64_t brake = UNITS * vector->brake;
    speed = speed == 0 ? 1U : speed;
    return vector->is_short ? lower(speed, brake) : speed;
}

uint32_t gve_speeds_limit(const struct gve_vector *vector, uint32_t factor, const uint32_t limit[PATH_AXES])
{
    uint32_t length = longest(vector);
    uint64_t speed = ordered(vector, factor);
    if (way2(vector) != 0) {
        speed = along_longest(speed, length, way2(vector));
    }
    speed = lower(speed, SPEED_MAX);
    speed = lower(speed, UNITS * US_PER_S / (uint64_t)GVE_VECTOR_US_MIN * length);
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        uint32_t steps = magnitude(vector->steps[axis]);
        if (steps != 0 && limit[axis] < GVE_SPEED_TOP) {
            speed = lower(speed, UNITS * limit[axis] * length / steps);
        }
    }
    return speed == 0 ? 1U : (uint32_t)speed;
}

/* N, below 2^49. */
static uint64_t extent_up(const struct gve_vector *vector)
{
    uint64_t way = way2(vector);
    if (way == 0) {
        return (uint64_t)longest(vector) << 16U;
    }
    struct wide scaled = wide_shift_left((struct wide){.low = way}, 32);
    uint64_t root = wide_root_nearest(scaled);
    return wide_is_at_least(wide_multiply(root, root), scaled) ? root : root + 1U;
}

/* |d' * N - d * N'|, below 2^81. */
static struct wide difference(int32_t after, uint64_t extent, int32_t before, uint64_t extent_after)
{
    struct wide a = wide_multiply(magnitude(after), extent);
    struct wide b = wide_multiply(magnitude(before), extent_after);
    if ((after < 0) != (before < 0)) {
        return wide_add(a, b);
    }
    return wide_is_at_least(a, b) ? wide_subtract(a, b) : wide_subtract(b, a);
}

/* The greatest r up to SPEED_MAX with r * 2^16 * change <= `most`. */
static uint64_t within_jump(struct wide most, struct wide change)
{
    struct wide unit = wide_shift_left(change, 16);
    uint64_t found = 0;
    for (uint64_t bit = UINT64_C(1) << 25; bit != 0; bit >>= 1U) {
        if (wide_is_at_least(most, path_wide_times(unit, found + bit))) {
            found += bit;
        }
    }
    return lower(found, SPEED_MAX);
}

uint32_t gve_speeds_border(const struct gve_vector *before, const struct gve_vector *after,
                           const uint32_t jump[PATH_AXES])
{
    uint64_t speed = UNITS * before->brake;
    uint64_t extent = 0;
    uint64_t extent_after = 0;
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        if (jump[axis] != 0) {
            extent = extent == 0 ? extent_up(before) : extent;
            extent_after = extent_after == 0 ? extent_up(after) : extent_after;
            struct wide change = difference(after->steps[axis], extent, before->steps[axis], extent_after);
            struct wide most = path_wide_times(wide_multiply(extent, extent_after), UNITS * jump[axis]);
            speed = lower(speed, within_jump(most, change));
        }
    }
    return (uint32_t)speed;
}

uint32_t gve_factor_up(uint32_t factor)
{
    uint32_t up = (factor * (SIXTEENTHS + 1U) + SIXTEENTHS / 2U) / SIXTEENTHS;
    return up > FACTOR_MAX ? FACTOR_MAX : up;
}

uint32_t gve_factor_down(uint32_t factor)
{
    uint32_t down = (factor * (SIXTEENTHS - 1U) + SIXTEENTHS / 2U) / SIXTEENTHS;
    return down < FACTOR_MIN ? FACTOR_MIN : down;
}
