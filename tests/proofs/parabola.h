/*
 * What t ticks at a constant acceleration make of what is missing to a pulse and of the slope: a parabola, along which
 * slope^2 - 4*accel*way stays as it is. Whole numbers, in a header of their own: the provers multiply out badly where
 * they know of more.
 */
#ifndef PARABOLA_H
#define PARABOLA_H

/*@ predicate is_gone(integer x, integer s, integer a, integer t, integer r2, integer s2) =
        r2 == x + t * s + (a * t) * t && s2 == s + 2 * (a * t);
    logic integer bend(integer x, integer s, integer a) = s * s - 4 * a * x;
    lemma gone_parabola: \forall integer x, s, a, t;
        bend(x + t * s + (a * t) * t, s + 2 * (a * t), a) == bend(x, s, a);
    lemma gone_bend: \forall integer x, s, a, t, r2, s2; is_gone(x, s, a, t, r2, s2) ==>
        bend(r2, s2, a) == bend(x + t * s + (a * t) * t, s + 2 * (a * t), a);
    lemma gone_same: \forall integer x, s, a, t, r2, s2; is_gone(x, s, a, t, r2, s2) ==>
        bend(r2, s2, a) == bend(x, s, a);
*/

#endif
