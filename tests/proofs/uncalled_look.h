/*
 * A part of look-ahead that is not asked in what is proved.
 */
#ifndef UNCALLED_LOOK_H
#define UNCALLED_LOOK_H

#include "path_look.h"

/*@ requires \false;
    assigns \nothing;
*/
bool path_look_is_more(struct path *path, uint64_t enter2);

#endif
