/*
 * Positions and slopes modulo 2^64, as the code has them.
 */
#ifndef POSITIONS_H
#define POSITIONS_H

#include "search_guesses.h"
#include "numbers.h"

/*@ lemma wrap_product: \forall integer x, y; (uint64_t)(x * (uint64_t)y) == (uint64_t)(x * y);
    lemma wrap_way: \forall integer y, accel, ticks;
        (uint64_t)(ticks * ((uint64_t)y + accel * ticks)) == (uint64_t)(ticks * (y + accel * ticks));
    predicate is_wrapped(integer wrapped, integer x) = wrapped == (uint64_t)x;
    predicate is_wrapped_times(integer wrapped, integer x, integer y) = (uint64_t)(y * wrapped) == (uint64_t)(y * x);
    lemma wrap_times_first: \forall integer x, y; is_wrapped_times((uint64_t)x, x, y);
    lemma wrap_times: \forall integer wrapped, x, y; is_wrapped(wrapped, x) ==> is_wrapped_times(wrapped, x, y);
    lemma wrap_position: \forall integer x, y, accel, ticks;
        (uint64_t)position((uint64_t)x, (uint64_t)y, accel, ticks) == (uint64_t)position(x, y, accel, ticks);
    lemma wrap_signed: \forall integer x; 0 <= x < 0x10000000000000000 ==> (uint64_t)signed_64(x) == x;
    lemma signed_wrap: \forall integer x; -0x8000000000000000 <= x < 0x8000000000000000 ==>
        signed_64((uint64_t)x) == x;
    lemma wrap_none: \forall integer x; 0 <= x < 0x10000000000000000 ==> (uint64_t)x == x;
    lemma wrap_position_signed: \forall integer x, y, accel, ticks; 0 <= x < 0x10000000000000000 ==>
        (uint64_t)position(x, y, accel, ticks) == (uint64_t)position(signed_64(x), y, accel, ticks);
    lemma from_signed_up: \forall integer x; 0 <= x < 0x8000000000000000 ==> (uint64_t)x == x;
    lemma from_signed_down: \forall integer x; -0x8000000000000000 <= x < 0 ==> (uint64_t)x == x + 0x10000000000000000;
    lemma gain_range: \forall integer x, y; -0x80000000 <= x <= 0x7FFFFFFF && 0 <= y <= 0x40000000 ==>
        -0x2000000000000000 <= x * y <= 0x2000000000000000;
*/
#endif
