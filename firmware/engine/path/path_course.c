#include "path_course.h"

#include "path_fixed.h"
#include "path_root.h"
#include "step_scale.h"

static uint64_t lower(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static uint64_t higher(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

/* What laying goes through: the corner where the first ramp ends and the one where the last begins. */
struct profile {
    uint64_t enter;  /* twice_speed2 of all */
    uint64_t turn;   /* at the end of the first ramp */
    uint64_t cruise; /* after it: less than `turn` where the speed falls at once */
    uint64_t exit;
};

/* What twice_speed2 gains or loses on the way from a place to the end, all in one: grains. */
static uint64_t gain_until_end(const struct path_course *course, struct wide place)
{
    struct wide way = path_wide_subtract(course->end, place);
    return way.high != 0 ? PATH_SPEED2_ENDLESS : lower(way.low, PATH_SPEED2_ENDLESS);
}

static uint64_t square(uint32_t value)
{
    return (uint64_t)value * value;
}

/* Up to the speed, or to where the ramps meet; or down to it, if it is entered faster: (a + b + c) / 2 is whole, as all
 * three are even. */
static struct profile profile_of(const struct path_course *course, const struct path_entry *entry,
                                 const struct path_goal *goal)
{
    struct profile profile = {.enter = 2U * entry->speed2, .exit = 2U * goal->exit_speed2};
    uint64_t limit = 2U * higher(square(goal->speed), goal->exit_speed2);
    uint64_t meet = (profile.enter + profile.exit + gain_until_end(course, entry->place)) / 2U;
    if (goal->rests) {
        profile.turn = lower(profile.enter, profile.exit);
    } else if (profile.enter > limit) {
        profile.turn = lower(profile.enter, higher(limit, 2U * square(goal->start_speed)));
        profile.cruise = limit;
    } else {
        profile.turn = lower(limit, meet);
        profile.cruise = profile.turn;
    }
    return profile;
}

/* A place in steps, 64.64. Most cruises begin and end with their vector. */
static struct wide steps_of(const struct path_course *course, struct wide place)
{
    if (path_wide_is_equal(place, (struct wide){0})) {
        return place;
    }
    if (path_wide_is_equal(place, course->whole)) {
        return (struct wide){.high = course->length};
    }
    return path_fixed_divide(place, course->grains_per_step);
}

/* When the path is at a place of a cruise, in steps. */
static struct wide cruise_time(const struct path_leg *leg, struct wide steps)
{
    return path_wide_add(leg->time, path_fixed_multiply(path_wide_subtract(steps, leg->begin), leg->pace));
}

/* The path at a place of a cruise, `steps` of it. */
static struct path_entry cruise_at(const struct path_leg *leg, struct wide place, struct wide steps)
{
    return (struct path_entry){.time = cruise_time(leg, steps), .place = place, .speed2 = leg->twice_speed2 / 2U};
}

struct path_entry path_course_step(const struct path_course *course, uint64_t step)
{
    struct wide place = path_wide_multiply(course->grains_per_step, step);
    const struct path_leg *leg = &course->leg[0];
    if (!path_wide_is_at_least(place, leg->place)) {
        return path_course_at(course, leg, leg->place);
    }
    for (unsigned i = 0; i + 1U < course->legs && !path_wide_is_at_least(course->leg[i].end, place); i++) {
        leg = &course->leg[i + 1U];
    }
    return leg->accel == 0 ? cruise_at(leg, place, (struct wide){.high = step}) : path_course_at(course, leg, place);
}

struct path_entry path_course_cruise_at(const struct path_leg *leg, struct wide place, uint64_t grains_per_step)
{
    return cruise_at(leg, place, path_fixed_divide(place, grains_per_step));
}

/* The time between two speeds of a ramp. */
static struct wide ramp_time(const struct path_course *course, struct wide slope_a, struct wide slope_b)
{
    struct wide change = path_wide_is_at_least(slope_a, slope_b) ? path_wide_subtract(slope_a, slope_b)
                                                                 : path_wide_subtract(slope_b, slope_a);
    return path_divide_wide(change, &course->per_accel);
}

/* The speed, with its root. */
static struct path_speed *speed_of(struct path_speeds *speeds, uint64_t twice_speed2)
{
    if (speeds->known[speeds->last].twice_speed2 != twice_speed2) {
        speeds->last ^= 1U;
    }
    struct path_speed *speed = &speeds->known[speeds->last];
    if (speed->twice_speed2 != twice_speed2) {
        *speed = (struct path_speed){.twice_speed2 = twice_speed2, .slope = path_fixed_slope(twice_speed2)};
    }
    return speed;
}

static struct wide pace_of(struct path_speeds *speeds, uint64_t twice_speed2)
{
    struct path_speed *speed = speed_of(speeds, twice_speed2);
    if (speed->pace.high == 0) {
        speed->pace = path_fixed_pace(speed->slope);
    }
    return speed->pace;
}

/* Where the course has come. */
struct progress {
    struct wide time;
    struct wide place;
    struct wide slope;
    uint64_t twice_speed2;
    struct path_speeds *speeds;
};

static struct path_leg *begin_leg(struct path_course *course, const struct progress *at)
{
    struct path_leg *leg = &course->leg[course->legs++];
    leg->time = at->time;
    leg->place = at->place;
    leg->slope = at->slope;
    leg->twice_speed2 = at->twice_speed2;
    return leg;
}

static void lay_ramp(struct path_course *course, struct progress *at, uint64_t to, uint32_t accel)
{
    uint64_t from = at->twice_speed2;
    if (from == to) {
        return;
    }
    struct path_leg *leg = begin_leg(course, at);
    struct wide slope = speed_of(at->speeds, to)->slope;
    course->per_accel = path_divisor_of(2U * (uint64_t)accel);
    leg->accel = to > from ? (int32_t)accel : -(int32_t)accel;
    leg->end = path_wide_add(at->place, (struct wide){.low = to > from ? to - from : from - to});
    at->time = path_wide_add(at->time, ramp_time(course, slope, at->slope));
    at->place = leg->end;
    at->slope = slope;
    at->twice_speed2 = to;
}

static void lay_cruise(struct path_course *course, struct progress *at, struct wide end)
{
    if (path_wide_is_at_least(at->place, end)) {
        return;
    }
    struct path_leg *leg = begin_leg(course, at);
    leg->accel = 0;
    leg->begin = steps_of(course, at->place);
    leg->pace = pace_of(at->speeds, at->twice_speed2);
    leg->end = end;
    struct wide time = cruise_time(leg, steps_of(course, end));
    at->time = time.high < 2U * PATH_FIXED_NEVER ? time : (struct wide){.high = 2U * PATH_FIXED_NEVER};
    at->place = end;
}

/* At once. */
static void set_speed(struct progress *at, uint64_t twice_speed2)
{
    if (at->twice_speed2 != twice_speed2) {
        at->twice_speed2 = twice_speed2;
        at->slope = speed_of(at->speeds, twice_speed2)->slope;
    }
}

void path_course_lay(struct path_course *course, const struct path_section *section, const struct path_entry *entry,
                     const struct path_goal *goal, struct path_speeds *speeds)
{
    course->legs = 0;
    course->grains_per_step = path_section_grains_per_step(section);
    course->length = section->length;
    course->per_length = path_divisor_of(section->length);
    course->whole = path_section_end(section);
    course->end = course->whole;
    struct profile profile = profile_of(course, entry, goal);
    struct progress at = {
        .time = entry->time,
        .place = entry->place,
        .slope = speed_of(speeds, profile.enter)->slope,
        .twice_speed2 = profile.enter,
        .speeds = speeds,
    };
    lay_ramp(course, &at, profile.turn, section->vector.accel);
    if (!goal->rests) {
        struct wide last_ramp = {.low = profile.cruise - profile.exit};
        set_speed(&at, profile.cruise);
        lay_cruise(course, &at, path_wide_subtract(course->end, last_ramp));
        lay_ramp(course, &at, profile.exit, section->vector.accel);
    }
    course->end = at.place;
    course->end_time = at.time;
}

struct path_entry path_course_at(const struct path_course *course, const struct path_leg *leg, struct wide place)
{
    if (leg->accel == 0) {
        return path_course_cruise_at(leg, place, course->grains_per_step);
    }
    uint64_t way = path_wide_subtract(place, leg->place).low;
    uint64_t twice_speed2 = leg->accel > 0 ? leg->twice_speed2 + way : leg->twice_speed2 - way;
    struct wide time = ramp_time(course, leg->slope, path_fixed_slope(twice_speed2));
    return (struct path_entry){.time = path_wide_add(leg->time, time), .place = place, .speed2 = twice_speed2 / 2U};
}

/* Rounding down twice is rounding down once. */
uint32_t path_course_last_pulse(const struct path_course *course, struct wide place, uint32_t steps)
{
    if (path_wide_is_equal(place, course->whole)) {
        return steps;
    }
    uint64_t rest = 0;
    bool all = steps == course->length;
    const struct path_divisor grains = path_divisor_of(course->grains_per_step);
    uint64_t way = path_divide(all ? place : path_wide_times(place, steps), &grains, &rest);
    return (uint32_t)(all ? way : path_divide((struct wide){.low = way}, &course->per_length, &rest));
}

/* The place of a pulse, steps of the longest axis: 64.64. */
static struct wide place_of(const struct path_course *course, uint32_t steps, uint32_t pulse)
{
    if (steps == course->length) {
        return (struct wide){.high = pulse};
    }
    return path_fixed_divide((struct wide){.low = (uint64_t)pulse * course->length}, steps);
}

static uint64_t slope256_of(struct wide slope)
{
    return (slope.high << 8U) + (((slope.low >> 55U) + 1U) >> 1U);
}

static struct path_pulse cruise_pulse(const struct path_course *course, const struct path_leg *leg, uint32_t steps,
                                      uint32_t pulse)
{
    struct wide time = cruise_time(leg, place_of(course, steps, pulse));
    return (struct path_pulse){
        .ticks = time.high, .fraction = (uint32_t)(time.low >> 32U), .slope256 = slope256_of(leg->slope)};
}

/* twice_speed2 at a pulse of a ramp, 64.64: the whole and the part are exact. Its place is pulse*L/steps, so all of it
 * is whole when it is multiplied by steps, or where the axis makes all steps; differences wrap, the sum is right. */
static struct wide twice_speed2_at(const struct path_course *course, const struct path_leg *leg, uint32_t steps,
                                   uint32_t pulse)
{
    if (steps == course->length) {
        uint64_t way = path_wide_subtract(path_wide_multiply(pulse, course->grains_per_step), leg->place).low;
        return (struct wide){.high = leg->accel > 0 ? leg->twice_speed2 + way : leg->twice_speed2 - way};
    }
    struct wide place = path_wide_multiply((uint64_t)pulse * course->length, course->grains_per_step);
    struct wide change = path_wide_subtract(place, path_wide_times(leg->place, steps));
    struct wide begin = path_wide_multiply(leg->twice_speed2, steps);
    return path_fixed_divide(leg->accel > 0 ? path_wide_add(begin, change) : path_wide_subtract(begin, change), steps);
}

/* 256 times the root of PATH_SLOPE2_PER_TWICE_SPEED2 * twice_speed2: below 2^125. */
static uint64_t root256(struct wide twice_speed2)
{
    struct wide fine = path_wide_multiply(PATH_SLOPE2_PER_TWICE_SPEED2, twice_speed2.low);
    struct wide whole = path_wide_shift(path_wide_multiply(PATH_SLOPE2_PER_TWICE_SPEED2, twice_speed2.high), 16U);
    struct wide part = {.high = fine.high >> 48U, .low = (fine.high << 16U) | (fine.low >> 48U)};
    return path_root(path_wide_add(whole, part));
}

static struct path_pulse ramp_pulse(const struct path_course *course, const struct path_leg *leg, uint32_t steps,
                                    uint32_t pulse)
{
    uint64_t slope256 = root256(twice_speed2_at(course, leg, steps, pulse));
    uint64_t begin256 = slope256_of(leg->slope);
    uint64_t change = leg->accel > 0 ? slope256 - begin256 : begin256 - slope256;
    struct wide way = path_divide_wide((struct wide){.high = change >> 8U, .low = change << 56U}, &course->per_accel);
    struct wide time = path_wide_add(leg->time, change <= INT64_MAX ? way : (struct wide){0});
    return (struct path_pulse){.ticks = time.high, .fraction = (uint32_t)(time.low >> 32U), .slope256 = slope256};
}

struct path_pulse path_course_pulse(const struct path_course *course, const struct path_leg *leg, uint32_t steps,
                                    uint32_t pulse)
{
    return leg->accel != 0 ? ramp_pulse(course, leg, steps, pulse) : cruise_pulse(course, leg, steps, pulse);
}
