/*
 * Contracts of the conversions in base_wide.h, proved with base_tick.acsl. wide_bits, a built-in of the
 * compilers, is trusted.
 */
#ifndef CONVERSIONS_H
#define CONVERSIONS_H

#include <stdint.h>

/*@ assigns \nothing;
    ensures \result == (value <= 0x7FFFFFFFFFFFFFFF ? value : value - 0x10000000000000000);
*/
static inline int64_t wide_to_signed(uint64_t value);

/*@ assigns \nothing;
    ensures \result == (value <= 0x7FFFFFFF ? value : value - 0x100000000);
*/
static inline int32_t wide_to_signed_32(uint32_t value);

/*@ assigns \nothing;
    ensures \result == (value >= 0 ? value : value + 0x10000000000000000);
*/
static inline uint64_t wide_from_signed(int64_t value);

/*@ assigns \nothing;
    ensures value == 0 ==> \result == 0;
    ensures value != 0 ==> 1 <= \result <= 32 && (1 << (\result - 1)) <= value < (1 << \result);
*/
static inline unsigned wide_bits(uint32_t value);

#endif
