/*
 * The sections of a path's ring from that of a place on.
 */
#ifndef CHANGE_SECTIONS_H
#define CHANGE_SECTIONS_H

#include "looks.h"

/*@ logic integer sections_from(integer from, integer to) = from <= to ? to - from : to - from + 0x100000000;
    logic struct path_section *next_at(struct path *path, integer from, integer k) = section_at(path, from + k);
    lemma next_count: \forall integer from, to; 0 <= from < 0x100000000 && 0 <= to < 0x100000000 ==>
        to == wrapped(from + sections_from(from, to));
    lemma next_at: \forall struct path *path, integer from, to; is_path(path) && 0 <= from < 0x100000000 &&
        0 <= to < 0x100000000 ==> section_at(path, to) == next_at(path, from, sections_from(from, to));
    predicate fit_from(struct path *path, integer from, integer sections) =
        1 <= sections <= path->size && \forall integer k; 0 <= k < sections ==> section_fits(next_at(path, from, k));
    logic integer plan_end(struct path *path) = path->start_speed == 0 ? path->end : path->chain;
*/

#endif
