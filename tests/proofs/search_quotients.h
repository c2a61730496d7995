/*
 * The quotient of the search for a pulse, and how far off it is. Whole numbers only.
 */
#ifndef SEARCH_QUOTIENTS_H
#define SEARCH_QUOTIENTS_H

#include "search_guesses.h"

/* How near q is to r / s: always; at a steeper slope; within a few ticks. */
/*@ predicate is_quotient(integer q, integer r, integer s) =
        1 <= q && 8 * (q * s - r) <= 4 * s + r && 8 * (r - q * s) <= 4 * s + r &&
        (0x400000000 <= s ==> 14 * (q * s - r) <= 7 * s + r && 14 * (r - q * s) <= 7 * s + r) &&
        (r <= 4 * s ==> 128 * (q * s - r) <= 65 * s && 128 * (r - q * s) <= 65 * s);
*/
/* distance / slope from their highest bits: both divided by a power of 2, unit. */
/*@ predicate is_short(integer distance, integer slope, integer unit, integer high, integer low, integer divisor) =
        1 <= unit <= 0x40000000 && high * unit <= distance < (high + 1) * unit &&
        low * unit <= slope < (low + 1) * unit && low <= divisor <= low + 1 &&
        (0x40000000 <= high || 0x40000000 <= low) &&
        0 <= high && 0 <= low && 0x280000000 <= slope && slope <= 2 * distance &&
        distance < 0x2000000000000000;
    lemma short_unit: \forall integer distance, slope, unit, high, low, divisor;
        is_short(distance, slope, unit, high, low, divisor) ==> 0x20000000 * unit <= distance;
    lemma short_divisor: \forall integer distance, slope, unit, high, low, divisor;
        is_short(distance, slope, unit, high, low, divisor) ==> 10 <= divisor;
    lemma short_divisor_steep: \forall integer distance, slope, unit, high, low, divisor;
        is_short(distance, slope, unit, high, low, divisor) && 0x400000000 <= slope ==> 16 <= divisor;
    lemma short_divisor_unit: \forall integer distance, slope, unit, high, low, divisor;
        is_short(distance, slope, unit, high, low, divisor) ==>
            slope - unit <= divisor * unit <= slope + unit;
    predicate is_rounded(integer x, integer y, integer q) = 0 <= q && 1 <= y && 2 * (q * y - x) <= y &&
        2 * (x - q * y) <= y;
    lemma rounded: \forall integer x, y; 0 <= x && 1 <= y ==> is_rounded(x, y, (x + y / 2) / y);
    predicate is_cut(integer distance, integer slope, integer unit, integer high, integer low, integer divisor,
        integer q) = is_short(distance, slope, unit, high, low, divisor) && is_rounded(high, divisor, q);
    lemma cut_most: \forall integer distance, slope, unit, high, low, divisor, q;
        is_cut(distance, slope, unit, high, low, divisor, q) ==>
            2 * (q * (divisor * unit)) <= 2 * (high * unit) + divisor * unit;
    lemma cut_least_scaled: \forall integer distance, slope, unit, high, low, divisor, q;
        is_cut(distance, slope, unit, high, low, divisor, q) ==>
            is_less_scaled(2 * (high - q * divisor), divisor, unit);
    lemma cut_least: \forall integer distance, slope, unit, high, low, divisor, q;
        is_cut(distance, slope, unit, high, low, divisor, q) ==>
            2 * (high * unit) <= 2 * (q * (divisor * unit)) + divisor * unit;
    lemma cut_more_scaled: \forall integer distance, slope, unit, high, low, divisor, q;
        is_cut(distance, slope, unit, high, low, divisor, q) ==>
            is_less_scaled(slope, divisor * unit + unit, q);
    lemma cut_more: \forall integer distance, slope, unit, high, low, divisor, q;
        is_cut(distance, slope, unit, high, low, divisor, q) ==> q * slope <= q * (divisor * unit) + q * unit;
    lemma cut_less: \forall integer distance, slope, unit, high, low, divisor, q;
        is_cut(distance, slope, unit, high, low, divisor, q) ==> q * (divisor * unit) <= q * slope + q * unit;
    lemma cut_above: \forall integer distance, slope, unit, high, low, divisor, q;
        is_cut(distance, slope, unit, high, low, divisor, q) ==>
            2 * (q * slope - distance) <= slope + unit + 2 * (q * unit);
    lemma cut_below: \forall integer distance, slope, unit, high, low, divisor, q;
        is_cut(distance, slope, unit, high, low, divisor, q) ==>
            2 * (distance - q * slope) <= slope + 3 * unit + 2 * (q * unit);
*/
/*@ predicate is_fraction(integer distance, integer unit, integer divisor, integer part) =
        1 <= unit && 0 <= distance && 0 <= part && 2 * (part * divisor) <= 2 * distance + divisor * unit;
    lemma fraction: \forall integer distance, slope, unit, high, low, divisor, q;
        is_cut(distance, slope, unit, high, low, divisor, q) ==> is_fraction(distance, unit, divisor, q * unit);
    lemma fraction_10_scaled: \forall integer unit, divisor, part; 10 <= divisor && 0 <= 2 * part - unit ==>
        is_less_scaled(10, divisor, 2 * part - unit);
    lemma fraction_10_less: \forall integer distance, unit, divisor, part;
        is_fraction(distance, unit, divisor, part) && 10 <= divisor && 0 <= 2 * part - unit ==>
            10 * (2 * part - unit) <= 2 * distance;
    lemma fraction_10: \forall integer distance, unit, divisor, part; is_fraction(distance, unit, divisor, part) &&
        10 <= divisor ==> 20 * part <= 2 * distance + 10 * unit;
    lemma fraction_16: \forall integer distance, unit, divisor, part; is_fraction(distance, unit, divisor, part) &&
        16 <= divisor ==> 32 * part <= 2 * distance + 16 * unit;
    lemma fraction_500: \forall integer distance, unit, divisor, part; is_fraction(distance, unit, divisor, part) &&
        0x10000 <= divisor ==> 0x20000 * part <= 2 * distance + 0x10000 * unit;
    lemma short_close: \forall integer distance, slope, unit, high, low, divisor;
        is_short(distance, slope, unit, high, low, divisor) && distance <= 4 * slope ==> 0x10000 <= divisor;
    lemma cut_quotient: \forall integer distance, slope, unit, high, low, divisor, q;
        is_cut(distance, slope, unit, high, low, divisor, q) && 1 <= q ==> is_quotient(q, distance, slope);
    lemma cut_none: \forall integer distance, slope, unit, high, low, divisor;
        is_cut(distance, slope, unit, high, low, divisor, 0) ==> is_quotient(1, distance, slope);
    lemma quotient_scaled: \forall integer distance, slope, q; is_quotient(q, distance, slope) &&
        distance < 0x2000000000000000 && slope <= 2 * distance && 0x280000000 <= slope ==>
            0x280000000 * q <= q * slope;
    lemma quotient_fits: \forall integer distance, slope, q; is_quotient(q, distance, slope) &&
        distance < 0x2000000000000000 && slope <= 2 * distance && 0x280000000 <= slope ==> q <= 0x7FFFFFFF;
*/
#endif
