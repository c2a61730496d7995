/*
 * What a change asks of the sections that have been laid: contracts of path.h and path_lay.h, and that of section_at in
 * path_change.c, proved with path_change_section.acsl. A path has not gone through all counts since its origin.
 */
#ifndef CHANGE_LAYS_H
#define CHANGE_LAYS_H

#include "change_sections.h"
#include "path_lay.h"

/*@ predicate in_turn(struct path *path) = is_path(path) &&
        sections_from(path->origin.section, path->laid) + sections_from(path->laid, path->known) < 0x100000000;
    predicate has_begun(struct path *path) = path->laid != path->known || path->laid != path->origin.section;
    predicate as_planned{A,B}(struct path *path) =
        \at(path->ring, A) == \at(path->ring, B) && \at(path->size, A) == \at(path->size, B) &&
        \at(path->start_speed, A) == \at(path->start_speed, B) &&
        \at(path->origin.section, A) == \at(path->origin.section, B) &&
        \at(path->origin.entry.time.high, A) == \at(path->origin.entry.time.high, B) &&
        \at(path->origin.entry.time.low, A) == \at(path->origin.entry.time.low, B) &&
        \at(path->origin.entry.place.high, A) == \at(path->origin.entry.place.high, B) &&
        \at(path->origin.entry.place.low, A) == \at(path->origin.entry.place.low, B) &&
        \at(path->origin.entry.speed2, A) == \at(path->origin.entry.speed2, B);
    predicate is_laid(struct path *path, integer section) = sections_from(path->origin.section, section) <
        sections_from(path->origin.section, path->laid);
*/

/*@ requires \valid_read(path);
    assigns \nothing;
    ensures \result <==> path->laid == path->known;
*/
bool path_is_laid(const struct path *path);

/*@ requires \valid(path) && in_turn(path) && path->laid != path->known;
    assigns *path, path->ring[0 .. path->size - 1];
    ensures in_turn(path) && as_planned{Pre,Post}(path);
    ensures path->laid == wrapped(\old(path->laid) + 1);
    ensures sections_from(path->laid, path->known) < \old(sections_from(path->laid, path->known));
*/
void path_lay_next(struct path *path);

/*@ requires \valid(path) && in_turn(path) && has_begun(path);
    assigns *path, path->ring[0 .. path->size - 1];
    ensures in_turn(path) && has_begun(path) && as_planned{Pre,Post}(path);
    ensures is_laid(path, \result);
    ensures \result != path->origin.section ==> section_at(path, \result)->entered.high < tick;
*/
static uint32_t section_at(struct path *path, uint64_t tick);

#endif
