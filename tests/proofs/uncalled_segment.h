/*
 * Segments of a path, which are not asked for in what is proved.
 */
#ifndef UNCALLED_SEGMENT_H
#define UNCALLED_SEGMENT_H

#include "path_segment.h"

/*@ requires \false;
    assigns \nothing;
*/
struct step_segment path_segment_lay(const struct path_course *course, const struct path_leg *leg,
                                     const struct path_stretch *stretch, const struct path_pulse *at);

#endif
