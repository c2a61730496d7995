/*
 * The contract of look_backward_again in path_look.c, proved with path_look_again.acsl.
 */
#ifndef LOOK_AGAIN_H
#define LOOK_AGAIN_H

#include "look_rings.h"

/*@ predicate looked_to(struct path *path, integer last) =
        is_path(path) && 0 <= last < path->size &&
        (\forall integer k; 0 <= k <= last ==> section_fits(known_at(path, k))) &&
        (\forall integer k; 0 <= k < last ==> is_capped(known_at(path, k), known_at(path, k + 1)));
*/

/*@ requires looked_to(path, ahead(path->laid, from));
    requires \forall integer k; 0 <= k <= ahead(path->laid, from) ==> known_at(path, k)->exit2 <= 0x1000000000000001;
    requires \forall integer k; 1 <= k < ahead(path->laid, from) - 1 ==>
        is_backed(known_at(path, k), known_at(path, k + 1));
    assigns path->ring[0 .. path->size - 1].exit2;
    ensures \forall integer k; 0 <= k <= ahead(path->laid, from) ==> known_at(path, k)->exit2 <= 0x1000000000000001;
    ensures ahead(path->laid, \result) <= ahead(path->laid, from);
    ensures \forall integer k; 1 <= k < ahead(path->laid, from) ==>
        is_backed(known_at(path, k), known_at(path, k + 1));
    ensures \forall integer k; 0 <= k < ahead(path->laid, \result) ==>
        known_at(path, k)->exit2 == \old(known_at(path, \at(k, Here))->exit2);
    ensures \forall integer k; ahead(path->laid, from) <= k < path->size ==>
        known_at(path, k)->exit2 == \old(known_at(path, \at(k, Here))->exit2);
*/
static uint32_t look_backward_again(const struct path *path, uint32_t from);

#endif
