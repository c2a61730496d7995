#include "path_lay.h"

#include "path_fixed.h"
#include "path_look.h"

uint64_t path_lay_grains(const struct path *path, const struct path_place *place)
{
    uint64_t own = path_section_grains_per_step(path_section_of(path, place->section));
    return place->accel != 0 ? PATH_GRAINS_PER_ACCEL * place->accel : own;
}

/* Pulses of an axis up to a place between two steps. Rounding down twice is rounding down once. */
static uint32_t pulses_between(struct wide place, uint32_t steps, const struct path_divisor *grains, uint32_t length)
{
    uint64_t rest = 0;
    return (uint32_t)(path_divide(path_wide_times(place, steps), grains, &rest) / length);
}

/* Pulses of an axis up to a whole step of the longest one; mostly by the processor's own division. */
static uint32_t pulses_at(uint64_t step, uint32_t steps, uint32_t length)
{
    uint64_t way = step * steps;
    return way <= UINT32_MAX ? (uint32_t)way / length : (uint32_t)(way / length);
}

void path_lay_pulses(const struct path *path, const struct path_place *place, uint32_t pulses[PATH_AXES])
{
    uint64_t rest = 0;
    const struct path_section *section = path_section_of(path, place->section);
    const struct path_divisor grains = path_divisor_of(path_lay_grains(path, place));
    uint64_t step = path_divide(place->entry.place, &grains, &rest);
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        uint32_t steps = path_section_steps(section, axis);
        bool whole = rest == 0 || steps == 0;
        pulses[axis] = whole ? pulses_at(step, steps, section->length)
                             : pulses_between(place->entry.place, steps, &grains, section->length);
    }
}

void path_lay_begin(struct path *path, const struct path_place *place)
{
    uint32_t pulses[PATH_AXES];
    path_lay_pulses(path, place, pulses);
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        struct path_cursor *cursor = &path->axis[axis];
        cursor->section = place->section;
        cursor->pulse = pulses[axis] + 1U;
        cursor->leg = 0;
        cursor->entered = false;
        cursor->found = false;
    }
    for (unsigned i = 0; i < PATH_KEPT; i++) {
        path->kept[i].valid = false;
    }
    path->origin = *place;
    path->next = place->entry;
    path->laid = place->section;
    path->known = path->start_speed == 0 ? path->end : path->chain;
    path_look(path);
}

static bool rests_in(const struct path *path, const struct path_section *section)
{
    return path->stopping && section->exit2 == 0;
}

const struct path_course *path_lay_anew(struct path *path, uint32_t count)
{
    struct path_kept *kept = &path->kept[count % PATH_KEPT];
    const struct path_section *section = path_section_of(path, count);
    struct path_entry entry = {.time = section->entered, .speed2 = section->enter2};
    if (count == path->origin.section) {
        entry.place = path->origin.entry.place;
    }
    const struct path_goal goal = {
        .exit_speed2 = section->leave2,
        .speed = path->stopping ? 0 : section->vector.speed,
        .start_speed = path_look_jumps(path, count) ? path->start_speed : 0,
        .rests = rests_in(path, section),
    };
    kept->section = count;
    kept->valid = true;
    path_course_lay(&kept->course, section, &entry, &goal, &path->speeds);
    return &kept->course;
}

static void come_to_rest(struct path *path, uint32_t section, const struct path_course *course)
{
    bool inside = !path_wide_is_at_least(course->end, path_section_end(path_section_of(path, section)));
    path->known = path->laid;
    path->looked = path->known;
    path->rest = (struct path_place){
        .section = inside ? section : section + 1U,
        .entry = {.time = course->end_time, .place = inside ? course->end : (struct wide){0}},
    };
}

static uint64_t leave2_of(const struct path *path, const struct path_section *section)
{
    if (rests_in(path, section)) {
        return path_look_start2(path);
    }
    return path->too_fast ? section->enter2 - path_look_gain(path) : path_section_from_border2(section, section->exit2);
}

void path_lay_next(struct path *path)
{
    uint32_t count = path->laid;
    struct path_section *section = path_section_of(path, count);
    path_look_if_due(path);
    if (count != path->origin.section) {
        section->exit2 = path_look_exit2(path, section, path->border2);
    }
    section->entered = path->next.time;
    section->enter2 = path->next.speed2;
    section->leave2 = leave2_of(path, section);
    path->too_fast = false;
    const struct path_course *course = path_lay_anew(path, count);
    path->laid++;
    if (path_is_laid(path) || rests_in(path, section)) {
        come_to_rest(path, count, course);
        return;
    }
    const struct path_section *after = path_section_of(path, path->laid);
    path->held_back = section->exit2 == path_look_brakeable(path, path->laid, section->exit2);
    path->next.time = course->end_time;
    path->next.place = (struct wide){0};
    path->next.speed2 = path_section_from_border2(after, section->exit2);
    path->border2 = section->exit2;
}
