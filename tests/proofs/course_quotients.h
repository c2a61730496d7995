/*
 * Quotients rounded down: their order is that of what is divided. The lemmas are of whole numbers only.
 */
#ifndef COURSE_QUOTIENTS_H
#define COURSE_QUOTIENTS_H

#include "squares.h"

/*@ predicate quotient_of(integer x, integer divisor, integer quotient) =
        1 <= divisor && quotient * divisor <= x < quotient * divisor + divisor;
    predicate quotient_most(integer x, integer divisor, integer quotient, integer most) =
        quotient_of(x, divisor, quotient) && x <= divisor * most;
    lemma quotient_most: \forall integer x, divisor, quotient, most; quotient_most(x, divisor, quotient, most) ==>
        cancelled(divisor, quotient, most) && quotient <= most;
    predicate quotient_least(integer x, integer divisor, integer quotient, integer least) =
        quotient_of(x, divisor, quotient) && least * divisor <= x;
    lemma quotient_by: \forall integer x, divisor, quotient, least; quotient_least(x, divisor, quotient, least) &&
        quotient + 1 <= least ==> ordered_by(quotient + 1, least, divisor);
    lemma quotient_least: \forall integer x, divisor, quotient, least;
        quotient_least(x, divisor, quotient, least) ==> least <= quotient;
*/

#endif
