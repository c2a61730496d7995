/*
 * The way of a course as the product of what it is known to be.
 */
#ifndef COURSE_PRODUCTS_H
#define COURSE_PRODUCTS_H

#include "courses.h"

/*@ predicate course_of(struct path_course *c, integer grains, integer length) =
        c->grains_per_step == grains && c->length == length;
    lemma course_of: \forall struct path_course *c, integer grains, length; course_of(c, grains, length) ==>
        course_way(c) == grains * length;
*/

#endif
