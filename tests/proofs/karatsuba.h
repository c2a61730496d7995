/*
 * Karatsuba's root: two digits more, to the base b, of a root that is known.
 */
#ifndef KARATSUBA_H
#define KARATSUBA_H

#include "squares.h"

/* The root s of the high half, what the high half is more than its square, and the two digits that follow. */
/*@ predicate halves(integer b, integer s, integer rest, integer next, integer last) =
        b <= 2 * s && s < b && 0 <= rest <= 2 * s && 0 <= next < b && 0 <= last < b;
    predicate digit(integer b, integer s, integer rest, integer next, integer digit, integer left) =
        rest * b + next == digit * (2 * s) + left && 0 <= digit && 0 <= left < 2 * s;
    logic integer whole(integer b, integer s, integer rest, integer next, integer last) =
        (square(s) + rest) * square(b) + next * b + last;

    lemma digit_most: \forall integer b, s, rest, next, last, digit, left; halves(b, s, rest, next, last) &&
        digit(b, s, rest, next, digit, left) ==> digit * (2 * s) < (b + 1) * (2 * s);
    lemma digit_fits: \forall integer b, s, rest, next, last, digit, left; halves(b, s, rest, next, last) &&
        digit(b, s, rest, next, digit, left) ==> digit <= b;
    lemma whole_parts: \forall integer b, s, rest, next, last; whole(b, s, rest, next, last) ==
        square(s) * square(b) + (rest * b + next) * b + last;
    lemma square_parts: \forall integer b, s, digit; square(s * b + digit) ==
        square(s) * square(b) + digit * (2 * s) * b + square(digit);
    lemma whole_digit: \forall integer b, s, rest, next, last, digit, left; digit(b, s, rest, next, digit, left) ==>
        (rest * b + next) * b == digit * (2 * s) * b + left * b;
    lemma whole_is: \forall integer b, s, rest, next, last, digit, left; digit(b, s, rest, next, digit, left) ==>
        whole(b, s, rest, next, last) == square(s * b + digit) + left * b + last - square(digit);

    predicate found(integer b, integer s, integer rest, integer next, integer last, integer digit, integer left) =
        halves(b, s, rest, next, last) && digit(b, s, rest, next, digit, left) && digit <= b;
    lemma found: \forall integer b, s, rest, next, last, digit, left; halves(b, s, rest, next, last) &&
        digit(b, s, rest, next, digit, left) ==> found(b, s, rest, next, last, digit, left);
    lemma base_by: \forall integer b, s, rest, next, last; halves(b, s, rest, next, last) ==> ordered_by(b, 2 * s, b);
    lemma base_square: \forall integer b, s, rest, next, last; halves(b, s, rest, next, last) ==>
        square(b) <= 2 * (s * b);
    lemma digit_ordered: \forall integer b, s, rest, next, last, digit, left;
        found(b, s, rest, next, last, digit, left) ==> ordered(digit, b);
    lemma digit_square: \forall integer b, s, rest, next, last, digit, left;
        found(b, s, rest, next, last, digit, left) ==> square(digit) <= 2 * (s * b);
    lemma left_by: \forall integer b, s, rest, next, last, digit, left;
        found(b, s, rest, next, last, digit, left) ==> ordered_by(left + 1, 2 * s, b);
    lemma left_product: \forall integer b, s, rest, next, last, digit, left;
        found(b, s, rest, next, last, digit, left) ==> (left + 1) * b <= 2 * s * b;
    lemma left_from: \forall integer b, s, rest, next, last, digit, left;
        found(b, s, rest, next, last, digit, left) ==> ordered_by(0, left, b);
    lemma left_least: \forall integer b, s, rest, next, last, digit, left;
        found(b, s, rest, next, last, digit, left) ==> 0 <= left * b;
    lemma left_most: \forall integer b, s, rest, next, last, digit, left;
        found(b, s, rest, next, last, digit, left) ==> 0 <= left * b + last < 2 * (s * b);
    lemma square_next: \forall integer x; square(x + 1) == square(x) + 2 * x + 1;
    lemma square_before: \forall integer x; square(x - 1) == square(x) - 2 * x + 1;
    lemma found_whole: \forall integer b, s, rest, next, last, digit, left;
        found(b, s, rest, next, last, digit, left) ==>
        whole(b, s, rest, next, last) == square(s * b + digit) + (left * b + last) - square(digit);
    lemma root_enough: \forall integer b, s, rest, next, last, digit, left;
        found(b, s, rest, next, last, digit, left) && square(digit) <= left * b + last ==>
        root_found(whole(b, s, rest, next, last), s * b + digit);
    lemma digit_positive: \forall integer b, s, rest, next, last, digit, left;
        found(b, s, rest, next, last, digit, left) && left * b + last < square(digit) ==> 1 <= digit;
    lemma root_less: \forall integer b, s, rest, next, last, digit, left;
        found(b, s, rest, next, last, digit, left) && left * b + last < square(digit) ==>
        root_found(whole(b, s, rest, next, last), s * b + digit - 1);
*/

/* The digit is found with half of both operands. */
/*@ lemma digit_halved: \forall integer x, s, digit, left; 0 <= x && split(x / 2, s, digit, left) ==>
        x == digit * (2 * s) + (2 * left + x % 2);
    lemma word_parts: \forall integer v; 0 <= v ==>
        v == v / 0x100000000 * 0x100000000 + v / 0x10000 % 0x10000 * 0x10000 + v % 0x10000;
    lemma word_square: square(0x10000) == 0x100000000;
    lemma whole_word: \forall integer v, s, rest; 0 <= v && square(s) + rest == v / 0x100000000 ==>
        whole(0x10000, s, rest, v / 0x10000 % 0x10000, v % 0x10000) == v;
    lemma whole_words: \forall integer high, low, s, rest; 0 <= low && square(s) + rest == high ==>
        whole(0x100000000, s, rest, low / 0x100000000, low % 0x100000000) == high * 0x10000000000000000 + low;
*/
#endif
