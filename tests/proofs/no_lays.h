/*
 * Contracts of path_lay.h for what lays nothing.
 */
#ifndef NO_LAYS_H
#define NO_LAYS_H

#include "path_lay.h"

/*@ requires \false;
    assigns \nothing;
*/
void path_lay_begin(struct path *path, const struct path_place *place);

/*@ requires \false;
    assigns \nothing;
*/
void path_lay_next(struct path *path);

/*@ requires \false;
    assigns \nothing;
*/
const struct path_course *path_lay_anew(struct path *path, uint32_t count);

/*@ requires \false;
    assigns \nothing;
*/
static inline const struct path_course *path_lay_course(struct path *path, uint32_t count);

#endif
