#include "path_course.h"

#include "path_fixed.h"
#include "step_scale.h"

static uint64_t lower(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static uint64_t higher(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

static uint32_t size_of(int32_t accel)
{
    return (uint32_t)(accel < 0 ? -accel : accel);
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
    struct wide way = wide_subtract(course->end, place);
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

struct path_entry path_course_cruise_at(const struct path_course *course, const struct path_leg *leg, struct wide place,
                                        uint64_t grains_per_step)
{
    struct wide begin = path_fixed_divide(leg->place, course->grains_per_step);
    struct wide way = wide_subtract(path_fixed_divide(place, grains_per_step), begin);
    return (struct path_entry){
        .time = wide_add(leg->time, path_fixed_multiply(way, leg->pace)),
        .place = place,
        .speed2 = leg->twice_speed2 / 2U,
    };
}

/* The time between two speeds of a ramp. */
static struct wide ramp_time(struct wide slope_a, struct wide slope_b, uint32_t accel)
{
    struct wide change =
        wide_is_at_least(slope_a, slope_b) ? wide_subtract(slope_a, slope_b) : wide_subtract(slope_b, slope_a);
    return path_fixed_part(change, 2U * (uint64_t)accel);
}

/* Where the course has come. */
struct progress {
    struct wide time;
    struct wide place;
    struct wide slope;
    uint64_t twice_speed2;
};

static struct path_leg *begin_leg(struct path_course *course, const struct progress *at)
{
    struct path_leg *leg = &course->leg[course->legs++];
    *leg =
        (struct path_leg){.time = at->time, .place = at->place, .slope = at->slope, .twice_speed2 = at->twice_speed2};
    return leg;
}

static void lay_ramp(struct path_course *course, struct progress *at, uint64_t to, uint32_t accel)
{
    uint64_t from = at->twice_speed2;
    if (from == to) {
        return;
    }
    struct path_leg *leg = begin_leg(course, at);
    struct wide slope = path_fixed_slope(to);
    leg->accel = to > from ? (int32_t)accel : -(int32_t)accel;
    leg->end = wide_add(at->place, (struct wide){.low = to > from ? to - from : from - to});
    at->time = wide_add(at->time, ramp_time(slope, at->slope, accel));
    at->place = leg->end;
    at->slope = slope;
    at->twice_speed2 = to;
}

static void lay_cruise(struct path_course *course, struct progress *at, struct wide end)
{
    if (wide_is_at_least(at->place, end)) {
        return;
    }
    struct path_leg *leg = begin_leg(course, at);
    leg->pace = path_fixed_pace(at->slope);
    leg->end = end;
    struct wide time = path_course_cruise_at(course, leg, end, course->grains_per_step).time;
    at->time = time.high < 2U * PATH_FIXED_NEVER ? time : (struct wide){.high = 2U * PATH_FIXED_NEVER};
    at->place = end;
}

/* At once. */
static void set_speed(struct progress *at, uint64_t twice_speed2)
{
    if (at->twice_speed2 != twice_speed2) {
        at->twice_speed2 = twice_speed2;
        at->slope = path_fixed_slope(twice_speed2);
    }
}

void path_course_lay(struct path_course *course, const struct path_section *section, const struct path_entry *entry,
                     const struct path_goal *goal)
{
    *course = (struct path_course){
        .grains_per_step = path_section_grains_per_step(section),
        .length = section->length,
        .end = path_section_end(section),
    };
    struct profile profile = profile_of(course, entry, goal);
    struct progress at = {
        .time = entry->time,
        .place = entry->place,
        .slope = path_fixed_slope(profile.enter),
        .twice_speed2 = profile.enter,
    };
    lay_ramp(course, &at, profile.turn, section->vector.accel);
    if (!goal->rests) {
        struct wide last_ramp = {.low = profile.cruise - profile.exit};
        set_speed(&at, profile.cruise);
        lay_cruise(course, &at, wide_subtract(course->end, last_ramp));
        lay_ramp(course, &at, profile.exit, section->vector.accel);
    }
    course->end = at.place;
    course->end_time = at.time;
}

struct path_entry path_course_at(const struct path_course *course, const struct path_leg *leg, struct wide place)
{
    if (leg->accel == 0) {
        return path_course_cruise_at(course, leg, place, course->grains_per_step);
    }
    uint64_t way = wide_subtract(place, leg->place).low;
    uint64_t twice_speed2 = leg->accel > 0 ? leg->twice_speed2 + way : leg->twice_speed2 - way;
    struct wide time = ramp_time(leg->slope, path_fixed_slope(twice_speed2), size_of(leg->accel));
    return (struct path_entry){.time = wide_add(leg->time, time), .place = place, .speed2 = twice_speed2 / 2U};
}

/* Rounding down twice is rounding down once. */
uint32_t path_course_last_pulse(const struct path_course *course, struct wide place, uint32_t steps)
{
    uint64_t rest = 0;
    uint64_t way = wide_divide(path_wide_times(place, steps), course->grains_per_step, &rest);
    return (uint32_t)(way / course->length);
}

/* The place of a pulse, steps of the longest axis: 64.64. */
static struct wide place_of(const struct path_course *course, uint32_t steps, uint32_t pulse)
{
    return path_fixed_divide((struct wide){.low = (uint64_t)pulse * course->length}, steps);
}

static uint64_t slope256_of(struct wide slope)
{
    return (slope.high << 8U) + (((slope.low >> 55U) + 1U) >> 1U);
}

static struct path_pulse cruise_pulse(const struct path_course *course, const struct path_leg *leg, uint32_t steps,
                                      uint32_t pulse)
{
    struct wide begin = path_fixed_divide(leg->place, course->grains_per_step);
    struct wide way = wide_subtract(place_of(course, steps, pulse), begin);
    struct wide time = wide_add(leg->time, path_fixed_multiply(way, leg->pace));
    return (struct path_pulse){
        .ticks = time.high, .fraction = (uint32_t)(time.low >> 32U), .slope256 = slope256_of(leg->slope)};
}

/* twice_speed2 at a pulse of a ramp, 64.64: the whole and the part are exact. Its place is pulse*L/steps, so all of it
 * is whole when it is multiplied by steps; the differences wrap, the sum is right. */
static struct wide twice_speed2_at(const struct path_course *course, const struct path_leg *leg, uint32_t steps,
                                   uint32_t pulse)
{
    struct wide place = wide_multiply((uint64_t)pulse * course->length, course->grains_per_step);
    struct wide change = wide_subtract(place, path_wide_times(leg->place, steps));
    struct wide begin = wide_multiply(leg->twice_speed2, steps);
    return path_fixed_divide(leg->accel > 0 ? wide_add(begin, change) : wide_subtract(begin, change), steps);
}

/* 256 times the root of PATH_SLOPE2_PER_TWICE_SPEED2 * twice_speed2: below 2^122. */
static uint64_t root256(struct wide twice_speed2)
{
    struct wide fine = wide_multiply(PATH_SLOPE2_PER_TWICE_SPEED2, twice_speed2.low);
    struct wide whole = wide_shift_left(wide_multiply(PATH_SLOPE2_PER_TWICE_SPEED2, twice_speed2.high), 16U);
    struct wide part = {.high = fine.high >> 48U, .low = (fine.high << 16U) | (fine.low >> 48U)};
    return wide_root_nearest(wide_add(whole, part));
}

static struct path_pulse ramp_pulse(const struct path_course *course, const struct path_leg *leg, uint32_t steps,
                                    uint32_t pulse)
{
    uint64_t slope256 = root256(twice_speed2_at(course, leg, steps, pulse));
    uint64_t begin256 = slope256_of(leg->slope);
    uint64_t change = leg->accel > 0 ? slope256 - begin256 : begin256 - slope256;
    struct wide way = path_fixed_part((struct wide){.high = change}, UINT64_C(512) * size_of(leg->accel));
    struct wide time = wide_add(leg->time, change <= INT64_MAX ? way : (struct wide){0});
    return (struct path_pulse){.ticks = time.high, .fraction = (uint32_t)(time.low >> 32U), .slope256 = slope256};
}

struct path_pulse path_course_pulse(const struct path_course *course, const struct path_leg *leg, uint32_t steps,
                                    uint32_t pulse)
{
    return leg->accel != 0 ? ramp_pulse(course, leg, steps, pulse) : cruise_pulse(course, leg, steps, pulse);
}
