/*
 * What path_divide.c knows of reciprocals, and the contracts of its parts; the lemmas are of whole numbers.
 */
#ifndef PATH_RECIPROCALS_H
#define PATH_RECIPROCALS_H

/* (b^2 - 1) / divisor and (b^3 - 1) / divisor, rounded down, less b: b = 2^32. */
/*@ predicate is_word_reciprocal(integer divisor, integer reciprocal) =
        (reciprocal + 0x100000000) * divisor <= 0xFFFFFFFFFFFFFFFF <
            (reciprocal + 0x100000000) * divisor + divisor;
    predicate is_reciprocal(integer divisor, integer reciprocal) =
        (reciprocal + 0x100000000) * divisor <= 0xFFFFFFFFFFFFFFFFFFFFFFFF <
            (reciprocal + 0x100000000) * divisor + divisor;
*/
#endif
