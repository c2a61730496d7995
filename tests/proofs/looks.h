/*
 * A path's ring of sections, and contracts of path_look.h, proved with path_look.acsl.
 */
#ifndef LOOKS_H
#define LOOKS_H

#include "path_vectors.h"
#include "rings.h"

#include "path.h"

/*@ predicate is_path(struct path *path) =
        \valid_read(path) && is_ring_size(path->size) && path->start_speed <= PATH_SPEED_MAX &&
        \valid(path->ring + (0 .. path->size - 1)) && \separated(path, path->ring + (0 .. path->size - 1));
    logic struct path_section *section_at(struct path *path, integer count) = path->ring + count % path->size;
    predicate section_fits(struct path_section *s) =
        vector_fits(s) && s->speed2 <= 0x1000000000000000 && s->gain2 <= 0x1000000000000000;
    logic integer own_limit(struct path_section *s) = square(s->vector.speed);
    logic integer end_of(struct path_section *s) = 2048 * s->vector.accel * s->length;
    logic integer lower_of(integer a, integer b) = a < b ? a : b;
    predicate begins_in(struct path *path, struct path_section *s) =
        section_fits(s) && value(path->next.place) <= end_of(s);
*/

/*@ requires is_path(path);
    assigns \nothing;
    ensures \result == section_at(path, section);
    ensures 0 <= section % path->size < path->size;
*/
static inline struct path_section *path_section_of(const struct path *path, uint32_t section);

/*@ requires \valid_read(path);
    assigns \nothing;
    ensures \result <==> !path->stopping && section == path->origin.section;
*/
static inline bool path_look_jumps(const struct path *path, uint32_t section);

/*@ requires \valid_read(path) && path->start_speed <= PATH_SPEED_MAX;
    assigns \nothing;
    ensures \result == square(path->start_speed) && \result <= 0x100000000000000;
*/
static inline uint64_t path_look_start2(const struct path *path);

/*@ requires is_path(path) && begins_in(path, section_at(path, path->laid));
    assigns \nothing;
    ensures \result ==
        lower_of((end_of(section_at(path, path->laid)) - value(path->next.place)) / 2, 0x1000000000000000);
    ensures \result <= 0x1000000000000000;
*/
uint64_t path_look_gain(const struct path *path);

/*@ requires is_path(path) && \valid_read(section) && section_fits(section) && enter2 <= 0x2000000000000000;
    assigns \nothing;
    ensures \result <= enter2 + section->gain2;
    ensures \result <= enter2 || \result <= section->exit2;
    ensures enter2 <= section->gain2 ==> \result <= section->exit2;
    ensures !path->stopping ==> enter2 <= \result + section->gain2;
    ensures !path->stopping && enter2 <= section->exit2 + section->gain2 ==> \result <= section->exit2;
*/
uint64_t path_look_exit2(const struct path *path, const struct path_section *section, uint64_t enter2);

/*@ requires is_path(path) && section_fits(section_at(path, section)) && enter2 <= 0x2000000000000000;
    assigns \nothing;
    ensures \result <= section_at(path, section)->cap2;
    ensures \result <= enter2 + 2 * section_at(path, section)->gain2;
*/
uint64_t path_look_brakeable(const struct path *path, uint32_t section, uint64_t enter2);

#endif
