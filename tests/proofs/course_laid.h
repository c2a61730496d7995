/*
 * The contract of path_course_lay in path_course.h, proved with path_course_lay.acsl.
 */
#ifndef COURSE_LAID_H
#define COURSE_LAID_H

#include "course_legs.h"
#include "course_speeds.h"

/* What a leg has besides what is asked of it, and where the legs of a course begin and end. */
/*@ predicate leg_laid(struct path_leg *l) =
        -PATH_ACCEL_MAX <= l->accel <= PATH_ACCEL_MAX && l->slope.high <= 0x70000000000000 &&
        l->time.high <= 0x8000000000000000 && l->twice_speed2 <= twice_speed2_most;
    predicate legs_laid(struct path_course *c) =
        (1 <= c->legs ==> leg_laid(&c->leg[0])) && (2 <= c->legs ==> leg_laid(&c->leg[1])) &&
        (3 <= c->legs ==> leg_laid(&c->leg[2]));
    predicate legs_from(struct path_course *c, struct path_entry *e) =
        c->legs == 0 ? value(c->end) == value(e->place) && value(c->end_time) == value(e->time) :
            value(c->leg[0].place) == value(e->place) && value(c->leg[0].time) == value(e->time);
    predicate legs_until_end(struct path_course *c) =
        (c->legs == 1 ==> value(c->leg[0].end) == value(c->end)) &&
        (c->legs == 2 ==> value(c->leg[1].end) == value(c->end)) &&
        (c->legs == 3 ==> value(c->leg[2].end) == value(c->end));
    predicate as_section(struct path_course *c, struct path_section *s) =
        c->length == s->length && c->grains_per_step == 2048 * s->vector.accel;
    logic integer section_way(struct path_section *s) = 2048 * s->vector.accel * s->length;
*/

/*@ requires \valid(course) && \valid_read(section) && \valid_read(entry) && \valid_read(goal) && speeds_fit(speeds);
    requires \separated(course, section, entry, goal, speeds);
    requires vector_fits(section) && value(entry->place) <= section_way(section);
    requires entry->time.high <= 0x4000000000000000;
    requires goal_fits(entry, goal, section_way(section) - value(entry->place));
    assigns *course, *speeds;
    ensures speeds_fit(speeds);
    ensures as_section(course, section);
    ensures legs_asked(course) && legs_laid(course) && legs_from(course, entry) && legs_until_end(course);
    ensures value(entry->place) <= value(course->end) <= section_way(section);
    ensures !goal->rests ==> value(course->end) == section_way(section);
    ensures value(entry->time) <= value(course->end_time) && course->end_time.high <= 0x8038000000000001;
*/
void path_course_lay(struct path_course *course, const struct path_section *section, const struct path_entry *entry,
                     const struct path_goal *goal, struct path_speeds *speeds);

#endif
