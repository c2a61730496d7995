/*
 * Places of a vector in steps of an axis: divided twice, rounded down both times. The lemmas are of whole numbers only.
 */
#ifndef COURSE_WAYS_H
#define COURSE_WAYS_H

#include "course_quotients.h"

/*@ predicate two_quotients(integer x, integer grains, integer length, integer way, integer pulse) =
        quotient_of(x, grains, way) && quotient_of(way, length, pulse);
    lemma two_least: \forall integer x, grains, length, way, pulse; two_quotients(x, grains, length, way, pulse) ==>
        ordered_by(pulse * length, way, grains) && (pulse * length) * grains <= x;
    lemma two_above: \forall integer x, grains, length, way, pulse; two_quotients(x, grains, length, way, pulse) ==>
        ordered_by(way + 1, pulse * length + length, grains) && x < (pulse * length + length) * grains;
    lemma two_is: \forall integer x, grains, length, way, pulse; two_quotients(x, grains, length, way, pulse) ==>
        quotient_of(x, grains * length, pulse);
    predicate times_quotient(integer x, integer grains, integer quotient, integer length) =
        quotient_of(x, grains, quotient) && 1 <= length;
    lemma times_by: \forall integer x, grains, quotient, length; times_quotient(x, grains, quotient, length) ==>
        ordered_by(quotient * grains, x, length) && ordered_by(x + 1, quotient * grains + grains, length);
    lemma times_parts: \forall integer x, grains, quotient, length; times_quotient(x, grains, quotient, length) ==>
        quotient * (grains * length) <= x * length < quotient * (grains * length) + grains * length;
    lemma times_quotient: \forall integer x, grains, quotient, length; times_quotient(x, grains, quotient, length) ==>
        quotient_of(x * length, grains * length, quotient);
    predicate whole_of(integer x, integer way, integer steps) = x == way && 1 <= way && 0 <= steps;
    lemma whole_of: \forall integer x, way, steps; whole_of(x, way, steps) ==> quotient_of(x * steps, way, steps);
*/

/*@ predicate way_fits(integer place, integer steps, integer grains, integer length) =
        2048 <= grains <= 0x20000000000 && 1 <= length <= 0x7FFFFFFF && 0 <= steps <= length &&
        0 <= place <= grains * length;
    lemma way_length: \forall integer place, steps, grains, length; way_fits(place, steps, grains, length) ==>
        ordered_by(length, 0x7FFFFFFF, grains) && place <= 0x7FFFFFFF * grains;
    lemma way_steps: \forall integer place, steps, grains, length; way_fits(place, steps, grains, length) ==>
        ordered_by(steps, 0x7FFFFFFF, place) && 0 <= place * steps <= place * 0x7FFFFFFF;
    lemma way_fits: \forall integer place, steps, grains, length; way_fits(place, steps, grains, length) ==>
        place * steps <= grains * 0x3FFFFFFF00000001;
    predicate fits_wide(integer x) = 0 <= x < 0x100000000000000000000000000000000;
    lemma fits_wide: \forall integer x; fits_wide(x) ==> x % 0x100000000000000000000000000000000 == x;
    lemma way_wide: \forall integer place, steps, grains, length; way_fits(place, steps, grains, length) ==>
        fits_wide(place * steps);
    lemma way_all: \forall integer place, steps, grains, length; way_fits(place, steps, grains, length) ==>
        ordered_by(place, grains * length, steps) && place * steps <= (grains * length) * steps;
*/

#endif
