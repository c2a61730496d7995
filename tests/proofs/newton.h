/*
 * Newton's rule for the root of a word, with quotients rounded down.
 */
#ifndef NEWTON_H
#define NEWTON_H

#include "squares.h"

/* One step, from the root r to the next: their sum is halved. The next is never too low. */
/*@ predicate not_low(integer v, integer root) = v < square(root + 1);
    predicate step(integer v, integer r, integer next) =
        0 <= v && 1 <= r && 1 <= next && 2 * (next * r) <= square(r) + v && not_low(v, next);
    lemma large_ordered: \forall integer root; 0 <= root < 0x8000 ==> ordered(root + 1, 0x8000);
    lemma large: \forall integer v, root; 0x40000000 <= v && 0 <= root && not_low(v, root) ==> 0x8000 <= root;

    predicate halved(integer v, integer r, integer quotient, integer rest, integer next) =
        0x40000000 <= v && 1 <= r && split(v, r, quotient, rest) && 2 * next <= r + quotient <= 2 * next + 1;
    lemma halved_ordered: \forall integer v, r, quotient, rest, next; halved(v, r, quotient, rest, next) ==>
        ordered(r + (quotient + 1), 2 * (next + 1));
    lemma halved_sum: \forall integer v, r, quotient, rest, next; halved(v, r, quotient, rest, next) ==>
        square(r + (quotient + 1)) <= square(2 * (next + 1));
    lemma halved_parts: \forall integer v, r, quotient, rest, next; halved(v, r, quotient, rest, next) ==>
        parts(r, quotient + 1, r + (quotient + 1));
    lemma halved_squares: \forall integer v, r, quotient, rest, next; halved(v, r, quotient, rest, next) ==>
        4 * (r * (quotient + 1)) <= square(r + (quotient + 1));
    lemma halved_product: \forall integer v, r, quotient, rest, next; halved(v, r, quotient, rest, next) ==>
        4 * (r * (quotient + 1)) <= 4 * square(next + 1);
    lemma halved_more: \forall integer v, r, quotient, rest, next; halved(v, r, quotient, rest, next) ==>
        not_low(v, next);
    lemma halved_by: \forall integer v, r, quotient, rest, next; halved(v, r, quotient, rest, next) ==>
        ordered_by(2 * next, r + quotient, r);
    lemma halved_times: \forall integer v, r, quotient, rest, next; halved(v, r, quotient, rest, next) ==>
        2 * next * r <= (r + quotient) * r;
    lemma halved_less: \forall integer v, r, quotient, rest, next; halved(v, r, quotient, rest, next) ==>
        2 * (next * r) <= square(r) + v;
    lemma halved_positive: \forall integer v, r, quotient, rest, next; halved(v, r, quotient, rest, next) ==>
        0 <= next;
    lemma halved_large: \forall integer v, r, quotient, rest, next; halved(v, r, quotient, rest, next) ==>
        0x8000 <= next;
    lemma halved_step: \forall integer v, r, quotient, rest, next; halved(v, r, quotient, rest, next) ==>
        step(v, r, next);
*/

/* The error is the square of the root less v: a step makes of it at most the square of its half, divided by r^2. */
/*@ predicate product(integer factor, integer x, integer most) = 4 * (factor * x) <= most;
    lemma step_ordered: \forall integer v, r, next; step(v, r, next) ==> ordered(2 * (next * r), square(r) + v);
    lemma step_squares: \forall integer v, r, next; step(v, r, next) ==>
        square(2 * (next * r)) <= square(square(r) + v);
    lemma product_less: \forall integer a, b, v; 4 * (square(b) * (square(a) - v)) ==
        square(2 * (a * b)) - 4 * (square(b) * v);
    lemma step_error: \forall integer v, r, next; step(v, r, next) ==>
        product(square(r), square(next) - v, square(square(r) - v));

    predicate reduced(integer error, integer less) = 0 <= less && square(error) <= 0x100000000 * less;
    lemma reduced_first: reduced(0x8000000, 0x400000);
    lemma reduced_second: reduced(0x400000, 0x1000);
    lemma reduced: \forall integer factor, x, error, less; 0x40000000 <= factor && product(factor, x, square(error)) &&
        reduced(error, less) ==> x <= less;

    predicate near(integer v, integer r, integer error) = 0x8000 <= r < 0x20000 && within(square(r) - v, error);
    lemma near_product: \forall integer v, r, next, error; step(v, r, next) && near(v, r, error) ==>
        product(square(r), square(next) - v, square(error));
    lemma near_factor: \forall integer v, r, error; near(v, r, error) ==> 0x40000000 <= square(r);
    lemma near_next: \forall integer v, r, next, error, less; step(v, r, next) && near(v, r, error) &&
        reduced(error, less) ==> square(next) - v <= less;
    lemma near_low: \forall integer v, root; 0 <= root < 0x20000 && not_low(v, root) ==> -0x40000 <= square(root) - v;
    lemma near_second: \forall integer v, r, next; step(v, r, next) && near(v, r, 0x8000000) &&
        0x8000 <= next < 0x20000 ==> near(v, next, 0x400000);
    lemma near_third: \forall integer v, r, next; step(v, r, next) && near(v, r, 0x400000) &&
        0x8000 <= next < 0x20000 ==> square(next) - v <= 0x1000;
    lemma near_last: \forall integer v, root; 0x8000 <= root && square(root) - v <= 0x1000 && not_low(v, root) ==>
        square(root - 1) <= v;
*/

/* The straight line: its error is at most 23170 times the root, so that of the first step at most (23170 / 2)^2. */
/*@ predicate line(integer v, integer root, integer rest) =
        0x40000000 <= v < 0x100000000 && v == (root - 24576) * 131072 + rest && 0 <= rest < 131072;
    lemma line_range: \forall integer v, root, rest; line(v, root, rest) ==> 0x8000 <= root <= 57343;
    lemma line_error: \forall integer v, root, rest; line(v, root, rest) ==>
        square(root) - v == (root - 32768) * (root - 98304) - rest;
    lemma line_opposite: \forall integer v, root, rest; line(v, root, rest) ==>
        opposite(root - 32768, root - 98304);
    lemma line_most: \forall integer v, root, rest; line(v, root, rest) ==> (root - 32768) * (root - 98304) <= 0;
    lemma line_square: \forall integer root; (root - 32768) * (root - 98304) + 23170 * root ==
        square(root - 53951) + 310515071;
    lemma line_least: \forall integer root; -23170 * root + 131072 <= (root - 32768) * (root - 98304);
    lemma line_within: \forall integer v, root, rest; line(v, root, rest) ==> within(square(root) - v, 23170 * root);
    lemma line_factor: \forall integer x; square(23170 * x) == 536848900 * square(x);
    lemma line_product: \forall integer v, root, rest, next; line(v, root, rest) && step(v, root, next) ==>
        product(square(root), square(next) - v, square(23170 * root));
    lemma line_cancelled: \forall integer v, root, rest, next; line(v, root, rest) && step(v, root, next) ==>
        cancelled(square(root), square(next) - v, 134212225);
    lemma line_next: \forall integer v, root, rest, next; line(v, root, rest) && step(v, root, next) &&
        0x8000 <= next < 0x20000 ==> near(v, next, 0x8000000);
*/

/* What the quotient says of a root. */
/*@ predicate quotient(integer v, integer root, integer quotient, integer rest) =
        0 <= v < 0x100000000 && 0x8000 <= root && split(v, root, quotient, rest);
    lemma quotient_ordered: \forall integer v, root, quotient, rest; quotient(v, root, quotient, rest) ==>
        ordered_by(0x8000, root, quotient);
    lemma quotient_most: \forall integer v, root, quotient, rest; quotient(v, root, quotient, rest) ==>
        quotient <= 0x1FFFF;
    predicate in_word(integer v, integer root) = square(root) <= v < 0x100000000;
    lemma in_word_ordered: \forall integer root; 0x10000 <= root ==> ordered(0x10000, root);
    lemma in_word: \forall integer v, root; in_word(v, root) ==> root <= 0xFFFF;
*/
#endif
