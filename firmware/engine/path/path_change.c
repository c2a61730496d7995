#include "path.h"

#include <stddef.h>

#include "base_hint.h"
#include "path_fixed.h"
#include "path_lay.h"
#include "path_look.h"
#include "step_scale.h"

/* Where path_find is looking: on a leg of a section's course. */
struct look {
    const struct path_course *course;
    const struct path_leg *leg;
    uint64_t tick;
    uint64_t early_tick; /* from which on a step may count that is earlier */
};

/* A step is earlier than the wish only where the path is no faster: with the highest acceleration it does not come to
 * the next step within PATH_EARLY_US_MAX. */
enum {
    EARLY_STEPS_PER_S = 1500,
    EARLY_ACCEL = PATH_ACCEL_MAX / 128 / 1000000 /* steps/ms^2 */
};
static_assert(PATH_EARLY_US_MAX * EARLY_STEPS_PER_S + PATH_EARLY_US_MAX * PATH_EARLY_US_MAX * EARLY_ACCEL / 2 < 1000000,
              "the way, in millionths, is less than a step");
static const uint32_t EARLY_SPEED = UINT32_C(256) * EARLY_STEPS_PER_S;

/* Whether a time is at or after a tick. */
static bool is_due(struct wide time, uint64_t tick)
{
    return time.high >= tick;
}

/* The leg that the path is on at a tick; the last one after its end. */
static const struct path_leg *leg_at(const struct path_course *course, uint64_t tick)
{
    const struct path_leg *leg = &course->leg[0];
    for (unsigned i = 1; i < course->legs; i++) {
        if (!is_due(course->leg[i].time, tick)) {
            leg = &course->leg[i];
        }
    }
    return leg;
}

/* Steps on the way from the beginning of the leg to a tick, whole and the rest in quanta, a little more or less; none
 * where it begins later. */
static uint64_t way_at(const struct look *look, uint64_t *rest)
{
    uint64_t begin = look->leg->time.high;
    uint64_t ticks = look->tick > begin ? look->tick - begin : 0;
    uint64_t slope = look->leg->slope.high;
    if (look->leg->accel < 0) {
        uint64_t until_stand = slope / (2U * (uint64_t)-(int64_t)look->leg->accel);
        ticks = ticks < until_stand ? ticks : until_stand;
    }
    uint64_t mean = slope + wide_from_signed(look->leg->accel) * ticks;
    return wide_divide(path_wide_multiply(mean, ticks), STEP_QUANTA, rest);
}

/* Finds the first whole step of the course after its beginning that is due at or after a tick; if none is, false and
 * the one after the last. What way_at tells is less than the way of a tick too much, so the step before that one is due
 * earlier. It is hardly too little: the leg's place and the way are rounded down, which makes two steps, a speed's
 * fraction of a quantum and the last digit of a time may make one each. So the search ends after as many more. */
static bool find_step(const struct look *look, uint64_t *step, struct path_entry *entry)
{
    const unsigned most = 4;
    uint64_t rest = 0;
    uint64_t begin = wide_divide(look->leg->place, look->course->grains_per_step, &rest);
    uint64_t before = wide_divide(look->course->leg[0].place, look->course->grains_per_step, &rest);
    uint64_t last = wide_divide(look->course->end, look->course->grains_per_step, &rest);
    uint64_t near = begin + way_at(look, &rest);
    near = near > before ? near : before + 1U;
    *step = last + 1U;
    last = last < near + most ? last : near + most;
    for (uint64_t at = near; at <= last; at++) {
        *entry = path_course_step(look->course, at);
        if (is_due(entry->time, look->tick)) {
            *step = at;
            return true;
        }
    }
    return false;
}

/* A place of a cruise between steps, an even number of grains, at the tick or just after it. */
static struct wide between_steps(const struct look *look, uint64_t grains_per_step)
{
    uint64_t quanta = 0;
    uint64_t unused = 0;
    struct wide way = {.high = way_at(look, &quanta)};
    way.low = wide_divide((struct wide){.high = quanta}, STEP_QUANTA, &unused);
    way = path_wide_add(way, path_fixed_divide(look->leg->place, look->course->grains_per_step));
    struct wide place = path_wide_multiply(way.high, grains_per_step);
    place = path_wide_add(place, (struct wide){.low = path_wide_multiply(way.low, grains_per_step).high + 2U});
    place.low -= place.low % 2U;
    return place;
}

/* Finds a place between steps in the cruise that the path is in, or comes to before `until_tick`. */
BASE_APART static bool find_between(struct look look, uint64_t until_tick, uint64_t grains_per_step,
                                    struct path_entry *entry)
{
    const struct path_leg *end = &look.course->leg[look.course->legs];
    while (look.leg != end && look.leg->accel != 0) {
        look.leg++;
    }
    if (look.leg == end || look.leg->time.high >= until_tick) {
        return false;
    }
    look.tick = look.tick > look.leg->time.high ? look.tick : look.leg->time.high + 1U;
    struct path_entry between = path_course_cruise_at(look.leg, between_steps(&look, grains_per_step), grains_per_step);
    bool stays = !path_wide_is_at_least(between.time, path_course_at(look.course, look.leg, look.leg->end).time);
    if (stays) {
        *entry = between;
    }
    return stays;
}

/* The step before one, if it counts. */
BASE_APART static bool find_early(const struct look *look, uint64_t step, uint64_t grains_per_step,
                                  struct path_entry *entry)
{
    struct path_entry early = path_course_step(look->course, step - 1U);
    bool counts = early.time.high >= look->early_tick && early.speed2 <= (uint64_t)EARLY_SPEED * EARLY_SPEED &&
                  path_wide_is_equal(early.place, path_wide_multiply(look->course->grains_per_step, step - 1U));
    if (counts) {
        *entry = early;
        entry->place = path_wide_multiply(grains_per_step, step - 1U);
    }
    return counts;
}

/* Finds a place in a section; false if the path rests in it before one comes. */
BASE_APART static bool find_in(const struct look *look, uint64_t patience_ticks, uint64_t grains_per_step,
                               struct path_entry *entry)
{
    uint64_t step = 0;
    bool follows = find_step(look, &step, entry);
    if (follows) {
        entry->place = path_wide_multiply(grains_per_step, step);
    }
    uint64_t until_tick = look->tick + patience_ticks;
    bool soon = follows && entry->time.high <= until_tick;
    return soon || find_between(*look, until_tick, grains_per_step, entry) ||
           find_early(look, step, grains_per_step, entry) || follows;
}

/* The last section that is entered before a tick, none before the plan's origin; laid, if the path goes so
 * far. */
static uint32_t section_at(struct path *path, uint64_t tick)
{
    while (!path_is_laid(path) && (path->laid == path->origin.section || !is_due(path->next.time, tick))) {
        path_lay_next(path);
    }
    uint32_t section = path->laid - 1U;
    while (section != path->origin.section && is_due(path_section_of(path, section)->entered, tick)) {
        section--;
    }
    return section;
}

/* The end of a section is the beginning of the next one; the end of what is planned that of one that was added. */
static bool pass_border(const struct path *path, struct path_place *place)
{
    const struct path_section *section = path_section_of(path, place->section);
    if (!path_wide_is_at_least(place->entry.place, path_wide_multiply(path_lay_grains(path, place), section->length))) {
        return true;
    }
    place->section++;
    if (place->section == (path->start_speed == 0 ? path->end : path->known)) {
        return false;
    }
    place->entry.place = (struct wide){0};
    place->entry.speed2 = path_section_from_border2(path_section_of(path, place->section), section->exit2);
    return true;
}

/* In the cruise that the path is in before the place that it has been planned from. */
BASE_APART static bool find_before(const struct path *path, const struct path_wish *wish, struct path_place *place)
{
    uint64_t until_tick = wish->tick + wish->patience_ticks;
    const struct path_kept *before = path_lay_before(path);
    if (before == NULL || !is_due(path->origin.entry.time, until_tick)) {
        return false;
    }
    struct look look = {.course = &before->course, .tick = wish->tick};
    look.leg = leg_at(look.course, wish->tick);
    return find_between(look, until_tick, path_lay_grains(path, place), &place->entry);
}

/* Where the path has been planned from, which is yet to come: it is no later than the first step. Not between two steps
 * with an acceleration whose grains it may not be a whole number of. */
static bool find_origin(const struct path *path, const struct path_wish *wish, struct path_place *place)
{
    uint64_t rest = 0;
    const struct path_section *section = path_section_of(path, path->origin.section);
    uint64_t step = wide_divide(path->origin.entry.place, path_section_grains_per_step(section), &rest);
    if (wish->accel != 0 && rest != 0) {
        return false;
    }
    *place = (struct path_place){.section = path->origin.section, .accel = wish->accel, .entry = path->origin.entry};
    if (wish->accel != 0) {
        place->entry.place = path_wide_multiply(PATH_GRAINS_PER_ACCEL * wish->accel, step);
    }
    return true;
}

bool path_find(struct path *path, const struct path_wish *wish, struct path_place *place)
{
    if (path_is_laid(path) && path->laid == path->origin.section) {
        return false;
    }
    place->section = section_at(path, wish->tick);
    place->accel = wish->accel;
    struct look look = {.course = path_lay_course(path, place->section), .tick = wish->tick};
    if (is_due(path->origin.entry.time, wish->tick) &&
        (find_before(path, wish, place) || find_origin(path, wish, place))) {
        return true;
    }
    if (look.course->legs == 0) {
        return false;
    }
    bool slow = path->start_speed <= EARLY_SPEED;
    look.early_tick = slow ? wish->tick - wish->early_ticks : TICK_NEVER;
    look.leg = leg_at(look.course, wish->tick);
    return find_in(&look, wish->patience_ticks, path_lay_grains(path, place), &place->entry) &&
           pass_border(path, place);
}

/* Whether section a comes before section b. */
static bool is_before(const struct path *path, uint32_t a, uint32_t b)
{
    return a - path->first < b - path->first;
}

/* Whether all pulses of an axis before a place, `there` of which are in its section, have been handed over. */
static bool is_handed_over(const struct path *path, const struct path_place *place, unsigned axis, uint32_t there)
{
    const struct path_cursor *cursor = &path->axis[axis];
    uint32_t made = cursor->pulse - 1U;
    if (is_before(path, place->section, cursor->section)) {
        return true;
    }
    for (uint32_t i = cursor->section; is_before(path, i, place->section); i++) {
        if (made < path_section_steps(path_section_of(path, i), axis)) {
            return false;
        }
        made = 0;
    }
    return made >= there;
}

/* Pulses of an axis that have been handed over and lie after a place. */
static uint64_t count_void(const struct path *path, const struct path_place *place, unsigned axis, uint32_t there)
{
    const struct path_cursor *cursor = &path->axis[axis];
    if (is_before(path, cursor->section, place->section)) {
        return 0;
    }
    uint64_t count = cursor->pulse - 1U;
    for (uint32_t i = place->section; i != cursor->section; i++) {
        count += path_section_steps(path_section_of(path, i), axis);
    }
    return count - there;
}

bool path_can_rest(const struct path *path, const struct path_place *place)
{
    uint64_t steps = 0;
    uint64_t rest = 0;
    uint32_t other = 0; /* vectors that count another length */
    uint32_t accel = 0; /* the most with which a vector brakes */
    uint32_t end = path->start_speed == 0 ? path->end : path->chain;
    for (uint32_t i = place->section; i != end; i++) {
        const struct path_section *section = path_section_of(path, i);
        steps += section->length;
        other += section->plain ? 0U : 1U;
        accel = section->vector.accel > accel ? section->vector.accel : accel;
    }
    uint64_t step = wide_divide(place->entry.place, path_lay_grains(path, place), &rest);
    steps -= step;
    struct wide gain = path_wide_multiply(PATH_GRAINS_PER_ACCEL / 2U * place->accel, steps - (rest != 0 ? 1U : 0U));
    gain = path_wide_add(gain, (struct wide){.low = path_look_start2(path)});
    bool slow = other == 0U || place->accel >= accel;
    return slow && path_wide_is_at_least(gain, (struct wide){.low = place->entry.speed2});
}

/* An axis that turns must be slower at the border if it speeds up faster after it. */
static void set_accel(const struct path *path, const struct path_place *place)
{
    path_section_set_accel(path_section_of(path, place->section), place->accel);
    for (uint32_t i = place->section + 1U; i != path->end; i++) {
        struct path_section *section = path_section_of(path, i);
        path_section_set_accel(section, place->accel);
        path_section_mind_turns(section, path_section_of(path, i - 1U), path->turn_us);
    }
}

bool path_back(const struct path *path, const struct path_place *place, uint64_t back[PATH_AXES])
{
    uint32_t there[PATH_AXES];
    path_lay_pulses(path, place, there);
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        if (!is_handed_over(path, place, axis, there[axis])) {
            return false;
        }
    }
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        back[axis] = count_void(path, place, axis, there[axis]);
    }
    return true;
}

/* How the path goes up to a place after its origin. */
BASE_APART static void keep_before(struct path *path, const struct path_place *place)
{
    const struct path_kept *kept = &path->kept[place->section % PATH_KEPT];
    bool later =
        place->section != path->origin.section || !path_wide_is_at_least(path->origin.entry.time, place->entry.time);
    if (later) {
        *path->before = *kept;
        path->before->valid = kept->valid && kept->section == place->section;
    }
}

static void plan_from(struct path *path, const struct path_place *place, bool stopping)
{
    if (path->before != NULL) {
        keep_before(path, place);
    }
    if (place->accel != 0) {
        set_accel(path, place);
    }
    path->stopping = stopping;
    path_lay_begin(path, place);
}

void path_change(struct path *path, const struct path_place *place)
{
    plan_from(path, place, false);
}

void path_stop(struct path *path, const struct path_place *place)
{
    plan_from(path, place, true);
}
