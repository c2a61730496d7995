#include "motion_profile.h"

static const uint64_t GAIN_MAX = UINT64_C(1) << 60;

static uint64_t lower(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static uint64_t higher(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

uint64_t motion_square(uint32_t speed_steps_per_s)
{
    return (uint64_t)speed_steps_per_s * speed_steps_per_s;
}

uint64_t motion_gain(uint32_t accel_steps_per_s2, uint64_t steps)
{
    uint64_t per_step = 2U * (uint64_t)accel_steps_per_s2;
    return steps > GAIN_MAX / per_step ? GAIN_MAX : per_step * steps;
}

uint64_t motion_profile_floor(const struct motion_way *way)
{
    uint64_t limit = motion_square(way->speed_steps_per_s);
    return way->jumps ? higher(limit, motion_square(way->start_speed_steps_per_s)) : limit;
}

uint64_t motion_profile_enter(const struct motion_way *way)
{
    uint64_t limit = motion_square(way->speed_steps_per_s);
    if (!way->jumps) {
        return way->enter_speed2;
    }
    if (way->enter_speed2 > limit) {
        return way->enter_speed2 <= motion_profile_floor(way) ? limit : way->enter_speed2;
    }
    uint64_t jump = lower(limit, motion_square(way->start_speed_steps_per_s));
    uint64_t brakeable = way->exit_speed2 + motion_gain(way->accel_steps_per_s2, way->steps);
    return higher(way->enter_speed2, lower(jump, brakeable));
}

/* Faster than allowed: brake first, to the exit speed at least. */
static void lay_braking(const struct motion_way *way, struct motion_profile *profile)
{
    uint64_t limit = 2U * motion_square(way->speed_steps_per_s);
    profile->turn = higher(2U * motion_profile_floor(way), profile->exit);
    profile->cruise = higher(limit, profile->exit);
    profile->corner_a =
        motion_place_add(way->begin, profile->enter - profile->turn, 4U * (uint64_t)way->accel_steps_per_s2);
}

/* Up to the limit, or to where the two ramps meet. */
static void lay_rising(const struct motion_way *way, struct motion_profile *profile)
{
    uint64_t limit = 2U * motion_square(way->speed_steps_per_s);
    uint64_t meet = (profile->enter + profile->exit) / 2U + motion_gain(way->accel_steps_per_s2, way->steps);
    profile->turn = lower(limit, meet);
    profile->cruise = profile->turn;
    profile->corner_a =
        motion_place_add(way->begin, profile->turn - profile->enter, 4U * (uint64_t)way->accel_steps_per_s2);
}

struct motion_profile motion_profile_lay(const struct motion_way *way)
{
    struct motion_profile profile = {
        .enter = 2U * motion_profile_enter(way),
        .exit = 2U * way->exit_speed2,
        .begin = way->begin,
        .end = way->begin + way->steps,
        .accel_steps_per_s2 = way->accel_steps_per_s2,
    };
    if (profile.enter > 2U * motion_square(way->speed_steps_per_s)) {
        lay_braking(way, &profile);
    } else {
        lay_rising(way, &profile);
    }
    profile.corner_b =
        motion_place_subtract(profile.end, profile.cruise - profile.exit, 4U * (uint64_t)way->accel_steps_per_s2);
    return profile;
}

struct motion_profile motion_profile_lay_stop(const struct motion_way *way)
{
    uint64_t change = way->enter_speed2 - way->exit_speed2;
    struct motion_place corner = motion_place_add(way->begin, change, 2U * (uint64_t)way->accel_steps_per_s2);
    return (struct motion_profile){
        .enter = 2U * way->enter_speed2,
        .turn = 2U * way->exit_speed2,
        .cruise = 2U * way->exit_speed2,
        .exit = 2U * way->exit_speed2,
        .corner_a = corner,
        .corner_b = corner,
        .begin = way->begin,
        .end = corner.step,
        .accel_steps_per_s2 = way->accel_steps_per_s2,
    };
}
