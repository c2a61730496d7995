/*
 * Shifts of two words, modulo 2^128. The lemmas are of whole numbers only: what numbers.h says of shifts would confuse
 * the provers.
 */
#ifndef SHIFTED_H
#define SHIFTED_H

/* A shift by n bits: up = 2^n, down = 2^(64 - n). What high * up is more than a word is lost. */
/*@ predicate split(integer x, integer y, integer quotient, integer rest) =
        x == quotient * y + rest && 0 <= quotient && 0 <= rest < y;
    lemma split: \forall integer x, y; 0 <= x && 1 <= y ==> split(x, y, x / y, x % y);
    predicate opposite_powers(integer up, integer down) = 1 <= up && 1 <= down && up * down == 0x10000000000000000;
    predicate moved(integer x, integer up, integer down, integer moved, integer kept) =
        opposite_powers(up, down) && 0 <= x < 0x10000000000000000 && split(x, down, moved, kept);
    lemma moved_less: \forall integer x, up, down, moved, kept; moved(x, up, down, moved, kept) ==>
        moved * down < up * down;
    lemma moved_most: \forall integer x, up, down, moved, kept; moved(x, up, down, moved, kept) ==> moved < up;
    lemma kept_next: \forall integer x, up, down, moved, kept; moved(x, up, down, moved, kept) ==>
        (kept + 1) * up <= down * up;
    lemma kept_most: \forall integer x, up, down, moved, kept; moved(x, up, down, moved, kept) ==>
        0 <= kept * up <= 0x10000000000000000 - up;
    lemma moved_product: \forall integer up, down, part; opposite_powers(up, down) ==>
        part * (down * up) == part * 0x10000000000000000;
    lemma moved_sum: \forall integer x, up, down, moved, kept; moved(x, up, down, moved, kept) ==>
        x * up == moved * (down * up) + kept * up;
    lemma moved_all: \forall integer x, up, down, moved, kept; moved(x, up, down, moved, kept) ==>
        x * up == moved * 0x10000000000000000 + kept * up;
    predicate reduced(integer x, integer wraps, integer y) =
        x == wraps * 0x100000000000000000000000000000000 + y && 0 <= wraps &&
        0 <= y < 0x100000000000000000000000000000000;
    lemma reduced: \forall integer x, wraps, y; reduced(x, wraps, y) ==>
        x % 0x100000000000000000000000000000000 == y;
    lemma shift_all: \forall integer high, low, up, down, high_moved, high_kept, low_moved, low_kept;
        moved(high, up, down, high_moved, high_kept) && moved(low, up, down, low_moved, low_kept) ==>
        reduced((high * 0x10000000000000000 + low) * up, high_moved,
            (high_kept * up + low_moved) * 0x10000000000000000 + low_kept * up);
    predicate two_splits(integer x, integer y, integer quotient, integer rest, integer other, integer left) =
        split(x, y, quotient, rest) && split(x, y, other, left) && quotient + 1 <= other;
    lemma two_splits_by: \forall integer x, y, quotient, rest, other, left;
        two_splits(x, y, quotient, rest, other, left) ==> (quotient + 1) * y <= other * y;
    lemma two_splits_none: \forall integer x, y, quotient, rest, other, left;
        !two_splits(x, y, quotient, rest, other, left);
    lemma halved_split: \forall integer x, half, quotient, rest; split(x / 2, half, quotient, rest) && 0 <= x ==>
        split(x, 2 * half, quotient, 2 * rest + x % 2);
    predicate halved(integer x, integer half) = 0 <= x && 1 <= half;
    lemma halved_both: \forall integer x, half; halved(x, half) ==>
        split(x, 2 * half, x / 2 / half, 2 * (x / 2 % half) + x % 2) &&
        split(x, 2 * half, x / (2 * half), x % (2 * half));
    lemma halved_low: \forall integer x, half; halved(x, half) && x / 2 / half + 1 <= x / (2 * half) ==>
        two_splits(x, 2 * half, x / 2 / half, 2 * (x / 2 % half) + x % 2, x / (2 * half), x % (2 * half));
    lemma halved_high: \forall integer x, half; halved(x, half) && x / (2 * half) + 1 <= x / 2 / half ==>
        two_splits(x, 2 * half, x / (2 * half), x % (2 * half), x / 2 / half, 2 * (x / 2 % half) + x % 2);
    lemma halved_same: \forall integer x, half; halved(x, half) ==> x / 2 / half == x / (2 * half);
    lemma halved_down: \forall integer x, half; 0 <= x && 1 <= half ==> x / 2 / half == x / (2 * half);
*/
#endif
