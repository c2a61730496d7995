/*
 * The root of a value that is shifted up by an even number of bits, and back by half of them; p is 2 to the half.
 */
#ifndef ROOT_SCALED_H
#define ROOT_SCALED_H

#include "squares.h"

/*@ predicate unscaled(integer v, integer p, integer high, integer root, integer rest) =
        0 <= v && 1 <= p && 0 <= high && root_found(square(p) * v, high) && split(high, p, root, rest);
    lemma product_square: \forall integer a, b; square(a * b) == square(b) * square(a);
    lemma unscaled_ordered: \forall integer v, p, high, root, rest; unscaled(v, p, high, root, rest) ==>
        0 <= root * p <= high;
    lemma unscaled_square: \forall integer v, p, high, root, rest; unscaled(v, p, high, root, rest) ==>
        ordered(root * p, high) && square(root * p) <= square(high);
    lemma unscaled_positive: \forall integer v, p, high, root, rest; unscaled(v, p, high, root, rest) ==>
        ordered(1, p) && 1 <= square(p);
    lemma unscaled_product: \forall integer v, p, high, root, rest; unscaled(v, p, high, root, rest) ==>
        square(p) * square(root) == square(root * p);
    lemma unscaled_low: \forall integer v, p, high, root, rest; unscaled(v, p, high, root, rest) ==>
        square(p) * square(root) <= square(p) * v;
    lemma unscaled_cancelled: \forall integer v, p, high, root, rest; unscaled(v, p, high, root, rest) ==>
        cancelled(square(p), square(root), v);
    lemma unscaled_least: \forall integer v, p, high, root, rest; unscaled(v, p, high, root, rest) ==>
        square(root) <= v;
    lemma unscaled_above: \forall integer v, p, high, root, rest; unscaled(v, p, high, root, rest) ==>
        ordered(high + 1, (root + 1) * p);
    lemma unscaled_next: \forall integer v, p, high, root, rest; unscaled(v, p, high, root, rest) ==>
        square(p) * v < square(p) * square(root + 1);
    lemma unscaled_other: \forall integer v, p, high, root, rest; unscaled(v, p, high, root, rest) &&
        square(root + 1) <= v ==> ordered_by(square(root + 1), v, square(p));
    lemma unscaled_most: \forall integer v, p, high, root, rest; unscaled(v, p, high, root, rest) ==>
        v < square(root + 1);
    lemma unscaled: \forall integer v, p, high, root, rest; unscaled(v, p, high, root, rest) ==>
        root_found(v, root);

    predicate scaled(integer v, integer up, integer x) = x == v * up;
    lemma scaled_found: \forall integer v, up, x, high; scaled(v, up, x) && root_found(x, high) ==>
        root_found(up * v, high);
    predicate scaled_root(integer v, integer p, integer x, integer high) =
        0 <= v && 1 <= p && 0 <= high && scaled(v, square(p), x) && root_found(x, high);
    lemma scaled_parts: \forall integer v, p, x, high, root, rest; scaled_root(v, p, x, high) &&
        split(high, p, root, rest) ==> unscaled(v, p, high, root, rest);
    lemma scaled_back: \forall integer v, p, x, high, root, rest; scaled_root(v, p, x, high) &&
        split(high, p, root, rest) ==> root_found(v, root);

    predicate beyond(integer v, integer root, integer limit) =
        0 <= limit && 0 <= root && v < square(limit) && square(root) <= v;
    lemma beyond_ordered: \forall integer v, root, limit; beyond(v, root, limit) && limit <= root ==>
        ordered(limit, root);
    lemma beyond: \forall integer v, root, limit; beyond(v, root, limit) ==> root < limit;

    predicate nearest(integer v, integer root) = root * root - root <= v <= root * root + root;
    lemma nearest: \forall integer v, root; root_found(v, root) && v - square(root) <= root ==> nearest(v, root);
    lemma nearest_next: \forall integer v, root; root_found(v, root) && root < v - square(root) ==>
        nearest(v, root + 1);
    lemma rest_most: \forall integer v, root; root_found(v, root) ==> 0 <= v - square(root) <= 2 * root;
*/

/* How far a value of two words can be shifted: up * down is one word. */
/*@ predicate room(integer high, integer low, integer up, integer down) =
        1 <= up && 1 <= down && up * down == 0x10000000000000000 && 0 <= high && 0 <= low < 0x10000000000000000 &&
        0x8000000000000000 <= high * up < 0x10000000000000000;
    lemma room_other: \forall integer high, low, up, down; room(high, low, up, down) && down <= high ==>
        ordered_by(down, high, up);
    lemma room_high: \forall integer high, low, up, down; room(high, low, up, down) ==> high + 1 <= down;
    lemma room_by: \forall integer high, low, up, down; room(high, low, up, down) ==> ordered_by(high + 1, down, up);
    lemma room_next: \forall integer high, low, up, down; room(high, low, up, down) ==>
        (high + 1) * up <= 0x10000000000000000;
    lemma room_low: \forall integer high, low, up, down; room(high, low, up, down) ==>
        0 <= low * up <= 0x10000000000000000 * up - up;
    lemma room_sum: \forall integer high, low, up, down; room(high, low, up, down) ==>
        (high * 0x10000000000000000 + low) * up == 0x10000000000000000 * (high * up) + low * up;
    predicate large(integer v, integer up) =
        0 <= v && 0x80000000000000000000000000000000 <= v * up < 0x100000000000000000000000000000000;
    lemma large: \forall integer high, low, up, down; room(high, low, up, down) ==>
        large(high * 0x10000000000000000 + low, up);
    predicate even(integer up, integer even_up) = 1 <= even_up && (up == even_up || up == 2 * even_up);
    predicate large_even(integer v, integer up) =
        0x40000000000000000000000000000000 <= v * up < 0x100000000000000000000000000000000;
    lemma large_even: \forall integer v, up, even_up; large(v, up) && even(up, even_up) ==> large_even(v, even_up);
*/
#endif
