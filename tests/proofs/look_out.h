/*
 * The contract of look_out in path_look.c, proved with path_look.acsl.
 */
#ifndef LOOK_OUT_H
#define LOOK_OUT_H

#include "looks.h"

/*@ requires is_path(path) && begins_in(path, section_at(path, path->laid)) && \valid(path);
    requires path->next.speed2 <= 0x1000000000000000 && path->origin.entry.speed2 <= 0x1000000000000000;
    requires section_at(path, path->laid)->exit2 <= 0x1000000000000001;
    assigns path->next.speed2, path->too_fast, section_at(path, path->laid)->exit2;
    ensures path->next.speed2 <= 0x1000000000000000;
    ensures section_at(path, path->laid)->exit2 <= 0x1000000000000001;
    ensures !path->too_fast ==> section_at(path, path->laid)->exit2 <= \old(section_at(path, path->laid)->exit2);
*/
static void look_out(struct path *path);

#endif
