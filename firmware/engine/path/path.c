#include "path.h"

#include <stddef.h>

#include "path_lay.h"
#include "path_look.h"
#include "path_root.h"
#include "path_segment.h"

void path_init(struct path *path, struct path_section *ring, uint32_t size, uint32_t turn_us)
{
    *path = (struct path){.ring = ring, .size = size, .turn_us = turn_us};
}

void path_set_start_speed(struct path *path, uint32_t start_speed)
{
    path->start_speed = start_speed;
}

void path_set_before(struct path *path, struct path_kept *before)
{
    path->before = before;
    if (before != NULL) {
        before->valid = false;
    }
}

bool path_is_laid(const struct path *path)
{
    return path->laid == path->known;
}

/* The path goes on to its last section, unless all before it has been laid. */
static void join(struct path *path)
{
    if (!path->stopping && !path_is_laid(path)) {
        path->known = path->end;
    }
    path->chain = path->end;
}

bool path_add(struct path *path, const struct path_vector *vector)
{
    if (path->end - path->first == path->size) {
        return false;
    }
    struct path_section *section = path_section_of(path, path->end);
    path_section_take(section, vector);
    if (path->end != path->first) {
        path_section_mind_turns(section, path_section_of(path, path->end - 1U), path->turn_us);
    }
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        path->axes |= (uint8_t)(vector->steps[axis] != 0 ? 1U << axis : 0U);
    }
    bool waits = path->start_speed != 0 && !(vector->straight && path->chain == path->end);
    path->end++;
    if (!waits) {
        join(path);
    }
    return true;
}

uint32_t path_speed_at(struct path *path, uint32_t section, uint32_t step)
{
    if (section - path->first >= path->laid - path->first) {
        return 0;
    }
    const struct path_section *entered = path_section_of(path, section);
    struct wide place = path_wide_multiply(path_section_grains_per_step(entered), step);
    const struct path_kept *before = section == path->origin.section ? path_lay_before(path) : NULL;
    bool past = before != NULL && path_wide_is_at_least(path->origin.entry.place, place);
    const struct path_course *course = past ? &before->course : path_lay_course(path, section);
    uint64_t speed2 = course->legs == 0 ? entered->enter2 : path_course_step(course, step).speed2;
    return (uint32_t)path_root((struct wide){.low = speed2});
}

bool path_lags(struct path *path)
{
    if (path->stopping || path->start_speed != 0) {
        return false;
    }
    if (path_is_laid(path)) {
        return path->known != path->end;
    }
    return path->held_back && path_look_is_more(path, path_section_of(path, path->laid - 1U)->exit2);
}

bool path_start(struct path *path, uint64_t start_tick)
{
    if (path->rest.section == path->end) {
        return false;
    }
    struct path_place place = path->rest;
    place.entry.time = (struct wide){.high = start_tick};
    path->stopping = false;
    path->chain = path->end;
    path_section_of(path, place.section)->turning = 0;
    path_set_before(path, path->before);
    path_lay_begin(path, &place);
    return true;
}

/* Whether there is a section that has been laid, or now is; not one that begins at `until_tick` or later. */
static bool reach(struct path *path, uint32_t section, uint64_t until_tick)
{
    if (section != path->laid) {
        return true;
    }
    if (path_is_laid(path) || path->next.time.high >= until_tick) {
        return false;
    }
    path_lay_next(path);
    return true;
}

static void enter_section(struct path_cursor *cursor)
{
    cursor->section++;
    cursor->pulse = 1;
    cursor->leg = 0;
    cursor->entered = false;
}

/* Puts the cursor on the leg with its next pulse; false if there is none in its section. */
static bool seek_leg(struct path_cursor *cursor, const struct path_course *course, uint32_t steps)
{
    for (; cursor->leg < course->legs; cursor->leg++) {
        if (!cursor->entered) {
            cursor->last = path_course_last_pulse(course, course->leg[cursor->leg].end, steps);
            cursor->entered = true;
        }
        if (cursor->pulse <= cursor->last) {
            return true;
        }
        cursor->entered = false;
    }
    return false;
}

/* Puts the cursor of an axis on its next pulse and returns its course; NULL if there is none so far. */
static const struct path_course *seek(struct path *path, unsigned axis, uint64_t until_tick)
{
    struct path_cursor *cursor = &path->axis[axis];
    while (reach(path, cursor->section, until_tick)) {
        uint32_t steps = path_section_steps(path_section_of(path, cursor->section), axis);
        const struct path_course *course = path_lay_course(path, cursor->section);
        if (seek_leg(cursor, course, steps)) {
            return course;
        }
        if (cursor->section + 1U == path->known) {
            break;
        }
        enter_section(cursor);
    }
    return NULL;
}

/* Whether the next pulse is known to come at a tick or later. */
static bool cursor_is_late(const struct path_cursor *cursor, uint64_t until_tick)
{
    uint64_t tick = cursor->found ? path_segment_tick(&cursor->at) : 0U;
    return tick >= until_tick;
}

static void hand_over(struct path_cursor *cursor, const struct path_segment *segment)
{
    cursor->pulse += segment->segment.steps;
    cursor->found = false;
}

bool path_next(struct path *path, unsigned axis, uint64_t until_tick, struct path_segment *segment)
{
    struct path_cursor *cursor = &path->axis[axis];
    const struct path_course *course = cursor_is_late(cursor, until_tick) ? NULL : seek(path, axis, until_tick);
    if (course == NULL) {
        return false;
    }
    const struct path_section *section = path_section_of(path, cursor->section);
    const struct path_leg *leg = &course->leg[cursor->leg];
    const struct path_stretch stretch = {
        .steps = path_section_steps(section, axis), .pulse = cursor->pulse, .last = cursor->last};
    if (!cursor->found) {
        cursor->at = path_course_pulse(course, leg, stretch.steps, stretch.pulse);
        cursor->found = true;
    }
    if (cursor_is_late(cursor, until_tick)) {
        return false;
    }
    segment->tick = path_segment_tick(&cursor->at);
    segment->segment = path_segment_lay(course, leg, &stretch, &cursor->at);
    segment->backward = section->vector.steps[axis] < 0;
    hand_over(cursor, segment);
    return true;
}

/* An axis that rests may stand in one of them, as it has not been asked for since; another vector may take its place.
 */
void path_drop(struct path *path, uint32_t section)
{
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        struct path_cursor *cursor = &path->axis[axis];
        while (cursor->section - path->first < section - path->first &&
               cursor->pulse > path_section_steps(path_section_of(path, cursor->section), axis)) {
            enter_section(cursor);
        }
    }
    path->first = section;
}
