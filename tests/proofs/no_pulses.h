/*
 * Contracts of path_lay.h for what asks for no grains and pulses.
 */
#ifndef NO_PULSES_H
#define NO_PULSES_H

#include "path_lay.h"

/*@ requires \false;
    assigns \nothing;
*/
bool path_is_laid(const struct path *path);

/*@ requires \false;
    assigns \nothing;
*/
uint64_t path_lay_grains(const struct path *path, const struct path_place *place);

/*@ requires \false;
    assigns \nothing;
*/
void path_lay_pulses(const struct path *path, const struct path_place *place, uint32_t pulses[PATH_AXES]);

#endif
