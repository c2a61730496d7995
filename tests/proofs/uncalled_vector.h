/*
 * What reads a vector, and is not asked in what is proved.
 */
#ifndef UNCALLED_VECTOR_H
#define UNCALLED_VECTOR_H

#include "path_vector.h"

/*@ requires \false;
    assigns \nothing;
*/
void path_section_take(struct path_section *section, const struct path_vector *vector);

/*@ requires \false;
    assigns \nothing;
*/
void path_section_mind_turns(struct path_section *section, const struct path_section *before, uint32_t turn_us);

#endif
