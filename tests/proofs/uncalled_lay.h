/*
 * Parts of laying that are not asked in what is proved.
 */
#ifndef UNCALLED_LAY_H
#define UNCALLED_LAY_H

#include "path_lay.h"

/*@ requires \false;
    assigns \nothing;
*/
void path_lay_begin(struct path *path, const struct path_place *place);

/*@ requires \false;
    assigns \nothing;
*/
void path_lay_next(struct path *path);

#endif
