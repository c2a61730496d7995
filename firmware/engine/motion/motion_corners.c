#include "motion_corners.h"

#include <assert.h>

#include "motion_endless.h"
#include "motion_plan_private.h"
#include "step_scale.h"

enum {
    SECTION_CORNERS_MAX = 3
};

static_assert(MOTION_SPEED_MAX <= STEP_SPEED_MAX, "the step generator must be able to make it");

/* Steps up to the end of a ramp, V^2/2A, stay below that with any speed and acceleration. */
static_assert((uint64_t)MOTION_SPEED_MAX * MOTION_SPEED_MAX / 2U < (UINT64_C(1) << 37),
              "a ramp's steps must be countable");

/* The last ramp of a run without end comes after that, the end of any other move before it. */
#define ENDLESS_RAMP_STEP (MOTION_ENDLESS_STEPS - (UINT64_C(1) << 37))
static_assert(MOTION_STEPS_MAX < ENDLESS_RAMP_STEP, "a move's end must be told from that of a run without end");

/* The square root of half of `twice_speed2`, to the nearest: 20 bits below the point decide. */
static uint32_t nearest_speed(uint64_t twice_speed2)
{
    enum {
        POINT_BITS = 20
    };
    uint64_t root = wide_root_nearest(wide_shift_left((struct wide){.low = twice_speed2}, 2U * POINT_BITS - 1U));
    return (uint32_t)((root + (UINT64_C(1) << (POINT_BITS - 1))) >> POINT_BITS);
}

static struct motion_corner corner_at(struct motion_place place, uint64_t twice_speed2)
{
    return (struct motion_corner){
        .step = place.step + (place.quanta >= STEP_QUANTA / 2U ? 1U : 0U),
        .speed_steps_per_s = nearest_speed(twice_speed2),
    };
}

/* The corners inside a section and at its end. A stop ends with its last whole step, before its
 * corner. */
static unsigned section_corners(const struct motion_profile *profile, struct motion_corner corners[SECTION_CORNERS_MAX])
{
    struct motion_place begin = {.step = profile->begin};
    unsigned count = 0;
    if (!motion_place_is_same(profile->corner_a, begin) && profile->corner_a.step < profile->end) {
        corners[count++] = corner_at(profile->corner_a, profile->turn);
    }
    if (!motion_place_is_same(profile->corner_b, profile->corner_a) && profile->corner_b.step < profile->end) {
        corners[count++] = corner_at(profile->corner_b, profile->cruise);
    }
    corners[count++] = corner_at((struct motion_place){.step = profile->end}, profile->exit);
    return count;
}

/* The curve ends at its last pulse with speed 0; a run without end has neither an end nor a ramp
 * down to it. */
static unsigned close_corners(struct motion_corner corners[MOTION_CORNERS_MAX], unsigned count)
{
    corners[count - 1U].speed_steps_per_s = 0;
    while (corners[count - 1U].step >= ENDLESS_RAMP_STEP) {
        count--;
    }
    return count;
}

unsigned motion_corners_of(const struct motion_plan *plan, struct motion_corner corners[MOTION_CORNERS_MAX])
{
    unsigned count = 0;
    corners[count++] = corner_at((struct motion_place){.step = 1}, 2U * plan->begin_speed2);
    if (plan->origin.step > 0) {
        corners[count++] = corner_at((struct motion_place){.step = plan->origin.step}, 2U * plan->origin.speed2);
    }
    for (unsigned i = plan->first; i < plan->order.sections; i++) {
        struct motion_profile profile = motion_legs_fit_section(plan, i);
        count += section_corners(&profile, &corners[count]);
    }
    return close_corners(corners, count);
}
