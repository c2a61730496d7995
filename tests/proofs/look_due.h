/*
 * The contract of path_look_again in path_look.h, proved with path_look_due.acsl.
 */
#ifndef LOOK_DUE_H
#define LOOK_DUE_H

#include "look_plans.h"

/*@ requires \valid(path) && has_looked(path) && !path->stopping;
    assigns path->looked, path->next.speed2, path->too_fast, path->ring[0 .. path->size - 1].exit2,
        path->ring[0 .. path->size - 1].cap2;
    ensures path->looked == path->known && has_looked(path);
*/
uint32_t path_look_again(struct path *path);

#endif
