/*
 * The rule of the pieces of a path (path_segment.h), in whole numbers.
 *
 * An axis' exact way has whole coefficients over a common denominator d: (place + slope*t + accel*t^2) / d quanta after
 * t ticks. What is laid has whole coefficients, each rounded to the nearest.
 */
#ifndef PIECES_H
#define PIECES_H

#include "squares.h"
#include "path_roots.h"

/* A rounded number, and what its error makes of the way after t ticks. */
/*@ predicate rounded(integer laid, integer exact, integer d) = 1 <= d && -d <= 2 * (laid * d - exact) <= d;
    predicate scaled_error(integer laid, integer exact, integer d, integer factor) =
        rounded(laid, exact, d) && 0 <= factor;
    lemma scaled_error_by: \forall integer laid, exact, d, factor; scaled_error(laid, exact, d, factor) ==>
        ordered_by(-d, 2 * (laid * d - exact), factor) && ordered_by(2 * (laid * d - exact), d, factor);
    lemma scaled_error_range: \forall integer laid, exact, d, factor; scaled_error(laid, exact, d, factor) ==>
        -d * factor <= 2 * (laid * d - exact) * factor <= d * factor;
    lemma scaled_error: \forall integer laid, exact, d, factor; scaled_error(laid, exact, d, factor) ==>
        -1 * (d * factor) <= 2 * ((laid * factor) * d - exact * factor) <= d * factor;

    predicate laid_piece(integer place, integer slope, integer accel, integer exact_place, integer exact_slope,
                         integer exact_accel, integer d, integer t) =
        rounded(place, exact_place, d) && scaled_error(slope, exact_slope, d, t) &&
        scaled_error(accel, exact_accel, d, t * t);
    logic integer way_after(integer place, integer slope, integer accel, integer t) =
        place + slope * t + accel * (t * t);
    logic integer twice_off(integer way, integer exact_way, integer d) = 2 * (way * d - exact_way);

    predicate is_off(integer twice, integer most) = -most <= twice <= most;

    logic integer twice_sum(integer place, integer slope, integer accel, integer exact_place, integer exact_slope,
                            integer exact_accel, integer d, integer t) =
        2 * (place * d - exact_place) + 2 * ((slope * t) * d - exact_slope * t) +
        2 * ((accel * (t * t)) * d - exact_accel * (t * t));
    logic integer twice_piece(integer place, integer slope, integer accel, integer exact_place, integer exact_slope,
                              integer exact_accel, integer d, integer t) =
        twice_off(way_after(place, slope, accel, t), way_after(exact_place, exact_slope, exact_accel, t), d);
    lemma piece_sum: \forall integer place, slope, accel, exact_place, exact_slope, exact_accel, d, t;
        twice_piece(place, slope, accel, exact_place, exact_slope, exact_accel, d, t) ==
        twice_sum(place, slope, accel, exact_place, exact_slope, exact_accel, d, t);
    lemma piece_sum_off: \forall integer place, slope, accel, exact_place, exact_slope, exact_accel, d, t;
        laid_piece(place, slope, accel, exact_place, exact_slope, exact_accel, d, t) ==>
        is_off(twice_sum(place, slope, accel, exact_place, exact_slope, exact_accel, d, t), d + d * t + d * (t * t));
    lemma piece_error: \forall integer place, slope, accel, exact_place, exact_slope, exact_accel, d, t;
        laid_piece(place, slope, accel, exact_place, exact_slope, exact_accel, d, t) ==>
        is_off(twice_piece(place, slope, accel, exact_place, exact_slope, exact_accel, d, t),
            d + d * t + d * (t * t));

    predicate same_accel(integer accel, integer exact_accel, integer d, integer factor) = exact_accel == accel * d;
    lemma same_accel: \forall integer accel, exact_accel, d, factor; same_accel(accel, exact_accel, d, factor) ==>
        exact_accel * factor == (accel * factor) * d;
    predicate laid_exact(integer place, integer slope, integer accel, integer exact_place, integer exact_slope,
                         integer exact_accel, integer d, integer t) =
        rounded(place, exact_place, d) && scaled_error(slope, exact_slope, d, t) &&
        same_accel(accel, exact_accel, d, t * t);
    lemma exact_part: \forall integer place, slope, accel, exact_place, exact_slope, exact_accel, d, t;
        laid_exact(place, slope, accel, exact_place, exact_slope, exact_accel, d, t) ==>
        2 * ((accel * (t * t)) * d - exact_accel * (t * t)) == 0;
    lemma exact_sum: \forall integer place, slope, accel, exact_place, exact_slope, exact_accel, d, t;
        laid_exact(place, slope, accel, exact_place, exact_slope, exact_accel, d, t) ==>
        twice_sum(place, slope, accel, exact_place, exact_slope, exact_accel, d, t) ==
        2 * (place * d - exact_place) + 2 * ((slope * t) * d - exact_slope * t);
    lemma exact_error: \forall integer place, slope, accel, exact_place, exact_slope, exact_accel, d, t;
        laid_exact(place, slope, accel, exact_place, exact_slope, exact_accel, d, t) ==>
        is_off(twice_piece(place, slope, accel, exact_place, exact_slope, exact_accel, d, t), d + d * t);
*/

/* How long a piece may last: `size` is that of the acceleration; while it brakes, the slope counts that is left. */
/*@ predicate is_short(integer slope, integer t) = 0 <= t && t * t + t + 1 <= slope / 4;
    predicate is_short_exact(integer slope, integer t) = 0 <= t && t + 1 <= slope / 4;
    predicate leaves_slope(integer slope, integer size, integer t) = 0 <= t && 0 <= size && 8 * (size * t) <= 3 * slope;
    lemma slope_left: \forall integer slope, size, t; leaves_slope(slope, size, t) ==>
        slope <= 4 * (slope - 2 * (size * t));
    predicate leaves_before(integer slope, integer size, integer t, integer before) =
        leaves_slope(slope, size, t) && 0 <= before <= t;
    lemma leaves_by: \forall integer slope, size, t, before; leaves_before(slope, size, t, before) ==>
        ordered_by(before, t, size);
    lemma leaves_product: \forall integer slope, size, t, before; leaves_before(slope, size, t, before) ==>
        before * size <= t * size;
    lemma leaves_before: \forall integer slope, size, t, before; leaves_before(slope, size, t, before) ==>
        leaves_slope(slope, size, before);
    lemma short_before: \forall integer slope, t, before; is_short(slope, t) && 0 <= before <= t ==>
        is_short(slope, before);

    predicate piece_of(integer slope, integer accel, integer exact, integer t) =
        (0 <= accel ==> (exact != 0 ? is_short_exact(slope, t) : is_short(slope, t))) &&
        (accel < 0 ==> (exact != 0 ? is_short_exact(slope / 4, t) : is_short(slope / 4, t))) &&
        (accel < 0 ==> leaves_slope(slope, -accel, t));

    predicate moves_little(integer twice, integer slope, integer d) = -(slope * d) <= 4 * twice <= slope * d;
    predicate short_by(integer slope, integer t, integer d) = is_short(slope, t) && 1 <= d;
    predicate short_exact_by(integer slope, integer t, integer d) = is_short_exact(slope, t) && 1 <= d;
    lemma short_ordered: \forall integer slope, t, d; short_by(slope, t, d) ==>
        ordered_by(4 * (t * t + t + 1), slope, d);
    lemma short_product: \forall integer slope, t, d; short_by(slope, t, d) ==>
        4 * (t * t + t + 1) * d <= slope * d;
    lemma short_by: \forall integer slope, t, d; short_by(slope, t, d) ==>
        4 * (d + d * t + d * (t * t)) <= slope * d;
    lemma short_exact_ordered: \forall integer slope, t, d; short_exact_by(slope, t, d) ==>
        ordered_by(4 * (t + 1), slope, d);
    lemma short_exact_product: \forall integer slope, t, d; short_exact_by(slope, t, d) ==>
        4 * (t + 1) * d <= slope * d;
    lemma short_exact_by: \forall integer slope, t, d; short_exact_by(slope, t, d) ==>
        4 * (d + d * t) <= slope * d;
    lemma off_little: \forall integer twice, slope, t, d; short_by(slope, t, d) &&
        is_off(twice, d + d * t + d * (t * t)) ==> moves_little(twice, slope, d);
    lemma off_little_exact: \forall integer twice, slope, t, d; short_exact_by(slope, t, d) &&
        is_off(twice, d + d * t) ==> moves_little(twice, slope, d);
    lemma piece_moves_little: \forall integer place, slope, accel, exact_place, exact_slope, exact_accel, d, t, least;
        laid_piece(place, slope, accel, exact_place, exact_slope, exact_accel, d, t) && short_by(least, t, d) ==>
        moves_little(twice_piece(place, slope, accel, exact_place, exact_slope, exact_accel, d, t), least, d);
    lemma exact_moves_little: \forall integer place, slope, accel, exact_place, exact_slope, exact_accel, d, t, least;
        laid_exact(place, slope, accel, exact_place, exact_slope, exact_accel, d, t) && short_exact_by(least, t, d) ==>
        moves_little(twice_piece(place, slope, accel, exact_place, exact_slope, exact_accel, d, t), least, d);
*/

/* The nearest root, less one, squared and with itself, is what is below the value. */
/*@ lemma root_is_short: \forall integer least, root; nearest_below(least, root) ==>
        (root - 1) * (root - 1) + (root - 1) + 1 <= least;
    lemma root_is_short_of: \forall integer slope, root; nearest_below(slope / 4, root) ==> is_short(slope, root - 1);
*/

/* A power of 2 whose square is a 32nd of one above the slope, or whose product with an acceleration is. */
/*@ predicate power_below(integer slope, integer p, integer most) =
        1 <= p && most <= 2 * slope && 32 * (p * p) <= most;
    lemma power_square: \forall integer p; (p - 1) * (p - 1) + (p - 1) + 1 == p * p - p + 1;
    lemma power_is_short: \forall integer slope, p, most; power_below(slope, p, most) && 0 <= slope ==>
        (p - 1) * (p - 1) + (p - 1) + 1 <= slope / 4 / 4;
    predicate power_leaves(integer slope, integer size, integer p, integer above, integer most) =
        1 <= p && 0 <= size <= above && 8 * (above * p) <= most && most <= 2 * slope;
    lemma power_leaves_by: \forall integer slope, size, p, above, most; power_leaves(slope, size, p, above, most) ==>
        0 <= size * (p - 1) <= above * p;
    lemma power_leaves: \forall integer slope, size, p, above, most; power_leaves(slope, size, p, above, most) ==>
        leaves_slope(slope, size, p - 1);
*/
#endif
