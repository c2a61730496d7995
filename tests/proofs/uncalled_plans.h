/*
 * What laying asks for to plan a path, and is not asked in what is proved.
 */
#ifndef UNCALLED_PLANS_H
#define UNCALLED_PLANS_H

#include "path_look.h"

/*@ requires \false;
    assigns \nothing;
*/
bool path_is_laid(const struct path *path);

/*@ requires \false;
    assigns \nothing;
*/
void path_look(struct path *path);

/*@ requires \false;
    assigns \nothing;
*/
void path_look_if_due(struct path *path);

#endif
