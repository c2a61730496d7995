/*
 * Quotients by 2 or more. The lemma is of whole numbers only.
 */
#ifndef COURSE_HALVES_H
#define COURSE_HALVES_H

#include "course_quotients.h"

/*@ predicate twice_quotient(integer x, integer divisor, integer quotient) =
        quotient_of(x, divisor, quotient) && 2 <= divisor && 0 <= quotient;
    lemma twice_quotient: \forall integer x, divisor, quotient; twice_quotient(x, divisor, quotient) ==>
        ordered_by(2, divisor, quotient) && 2 * quotient <= x;
*/

#endif
