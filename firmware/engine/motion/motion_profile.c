#include "motion_profile.h"

static const uint64_t GAIN_MAX = UINT64_C(1) << 60;

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

uint64_t motion_profile_floor(const struct motion_span *span)
{
    uint64_t limit = motion_square(span->speed_steps_per_s);
    return span->jumps ? higher(limit, motion_square(span->start_speed_steps_per_s)) : limit;
}

uint64_t motion_profile_enter(const struct motion_span *span)
{
    uint64_t limit = motion_square(span->speed_steps_per_s);
    if (!span->jumps) {
        return span->enter_speed2;
    }
    if (span->enter_speed2 > limit) {
        return span->enter_speed2 <= motion_profile_floor(span) ? limit : span->enter_speed2;
    }
    uint64_t jump = motion_lower(limit, motion_square(span->start_speed_steps_per_s));
    uint64_t brakeable = span->exit_speed2 + motion_gain(span->accel_steps_per_s2, span->steps);
    return higher(span->enter_speed2, motion_lower(jump, brakeable));
}

/* Faster than allowed: brake first, to the exit speed at least. */
static void fit_braking(const struct motion_span *span, struct motion_profile *profile)
{
    uint64_t limit = 2U * motion_square(span->speed_steps_per_s);
    profile->turn = higher(2U * motion_profile_floor(span), profile->exit);
    profile->cruise = higher(limit, profile->exit);
    profile->corner_a =
        motion_place_add(span->begin, profile->enter - profile->turn, 4U * (uint64_t)span->accel_steps_per_s2);
}

/* Up to the limit, or to where the two ramps meet. */
static void fit_rising(const struct motion_span *span, struct motion_profile *profile)
{
    uint64_t limit = 2U * motion_square(span->speed_steps_per_s);
    uint64_t meet = (profile->enter + profile->exit) / 2U + motion_gain(span->accel_steps_per_s2, span->steps);
    profile->turn = motion_lower(limit, meet);
    profile->cruise = profile->turn;
    profile->corner_a =
        motion_place_add(span->begin, profile->turn - profile->enter, 4U * (uint64_t)span->accel_steps_per_s2);
}

struct motion_profile motion_profile_fit(const struct motion_span *span)
{
    struct motion_profile profile = {
        .enter = 2U * motion_profile_enter(span),
        .exit = 2U * span->exit_speed2,
        .begin = span->begin,
        .end = span->begin + span->steps,
        .accel_steps_per_s2 = span->accel_steps_per_s2,
    };
    if (profile.enter > 2U * motion_square(span->speed_steps_per_s)) {
        fit_braking(span, &profile);
    } else {
        fit_rising(span, &profile);
    }
    profile.corner_b =
        motion_place_subtract(profile.end, profile.cruise - profile.exit, 4U * (uint64_t)span->accel_steps_per_s2);
    return profile;
}

struct motion_profile motion_profile_fit_stop(const struct motion_span *span)
{
    uint64_t change = span->enter_speed2 - span->exit_speed2;
    struct motion_place corner = motion_place_add(span->begin, change, 2U * (uint64_t)span->accel_steps_per_s2);
    return (struct motion_profile){
        .enter = 2U * span->enter_speed2,
        .turn = 2U * span->exit_speed2,
        .cruise = 2U * span->exit_speed2,
        .exit = 2U * span->exit_speed2,
        .corner_a = corner,
        .corner_b = corner,
        .begin = span->begin,
        .end = corner.step,
        .accel_steps_per_s2 = span->accel_steps_per_s2,
    };
}
