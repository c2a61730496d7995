/*
 * Contracts of an acceleration that is set and of a border where axes turn, in path_vector.h: proved with
 * path_vector.acsl and path_vector_turns.acsl.
 */
#ifndef SECTION_ACCELS_H
#define SECTION_ACCELS_H

#include "path_vectors.h"

/*@ requires \valid(section) && vector_fits(section) && 1 <= accel <= PATH_ACCEL_MAX;
    assigns section->vector.accel, section->gain2;
    ensures section->vector.accel == accel && vector_fits(section) && section->gain2 <= 0x1000000000000000;
*/
void path_section_set_accel(struct path_section *section, uint32_t accel);

/*@ requires \valid(section) && \valid_read(before) && \separated(section, before) && vector_fits(section);
    requires 1 <= turn_us <= PATH_TURN_US_MAX;
    requires \forall integer axis; 0 <= axis < PATH_AXES ==>
        -section->length <= section->vector.steps[axis] <= section->length;
    assigns section->border2, section->turning;
    ensures section->border2 <= square(section->vector.border_speed);
    ensures section->turning <= section->length;
    ensures vector_fits(section);
*/
void path_section_mind_turns(struct path_section *section, const struct path_section *before, uint32_t turn_us);

#endif
