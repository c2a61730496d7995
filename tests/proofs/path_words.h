/*
 * Contracts of path_wide.h, proved with path_wide.acsl: exact for all operands.
 */
#ifndef PATH_WORDS_H
#define PATH_WORDS_H

#include "shifts.h"
#include "wide.h"

#include <stdbool.h>
#include <stdint.h>

/*@ assigns \nothing;
    ensures value(\result) == a * b;
*/
static inline struct wide path_wide_multiply(uint64_t a, uint64_t b);

/*@ assigns \nothing;
    ensures value(\result) == value(a) + value(b) ||
        value(\result) == value(a) + value(b) - 0x100000000000000000000000000000000;
*/
static inline struct wide path_wide_add(struct wide a, struct wide b);

/*@ assigns \nothing;
    ensures value(\result) == value(a) - value(b) ||
        value(\result) == value(a) - value(b) + 0x100000000000000000000000000000000;
*/
static inline struct wide path_wide_subtract(struct wide a, struct wide b);

/*@ assigns \nothing;
    ensures value(\result) == (value(value) * factor) % 0x100000000000000000000000000000000;
*/
static inline struct wide path_wide_times(struct wide value, uint64_t factor);

/*@ requires bits <= 63;
    assigns \nothing;
    ensures value(\result) == (value(value) * power(bits)) % 0x100000000000000000000000000000000;
*/
static inline struct wide path_wide_shift(struct wide value, unsigned bits);

/*@ assigns \nothing;
    ensures \result <= 64;
    ensures value == 0 ==> \result == 0;
    ensures value != 0 ==> 1 <= \result && power(\result - 1) <= value < power(\result);
*/
static inline unsigned path_wide_bits(uint64_t value);

/*@ assigns \nothing;
    ensures \result <==> value(a) >= value(b);
*/
static inline bool path_wide_is_at_least(struct wide a, struct wide b);

/*@ assigns \nothing;
    ensures \result <==> value(a) == value(b);
*/
static inline bool path_wide_is_equal(struct wide a, struct wide b);

#endif
