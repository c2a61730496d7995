/*
 * The contract of profile_of in path_course.c, proved with path_course.acsl.
 */
#ifndef PROFILED_H
#define PROFILED_H

#include "courses.h"

/*@ requires \valid_read(course) && \valid_read(entry) && \valid_read(goal);
    requires value(entry->place) <= value(course->end);
    requires goal_fits(entry, goal, value(course->end) - value(entry->place));
    assigns \nothing;
    ensures \result.enter == 2 * entry->speed2 && \result.exit == 2 * goal->exit_speed2;
    ensures \result.turn <= greater(2 * entry->speed2, limit_of(goal));
    ensures goal->rests ==> \result.turn == lesser(2 * entry->speed2, 2 * goal->exit_speed2);
    ensures !goal->rests ==> \result.cruise <= limit_of(goal) && is_profile(\result.enter, \result.turn,
        \result.cruise, \result.exit, value(course->end) - value(entry->place));
    ensures \result.turn <= twice_speed2_most;
*/
static struct profile profile_of(const struct path_course *course, const struct path_entry *entry,
                                 const struct path_goal *goal);

#endif
