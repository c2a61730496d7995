/*
 * Contracts of path_vector.h for what changes no section.
 */
#ifndef NO_TURNS_H
#define NO_TURNS_H

#include "path_vector.h"

/*@ requires \false;
    assigns \nothing;
*/
void path_section_set_accel(struct path_section *section, uint32_t accel);

/*@ requires \false;
    assigns \nothing;
*/
void path_section_mind_turns(struct path_section *section, const struct path_section *before, uint32_t turn_us);

#endif
