/*
 * 128-bit arithmetic as in base_wide.h, for the innermost loops of planning: the compiler makes a few instructions of
 * each, where a call would cost as many again. Pure functions; any context.
 */
#ifndef PATH_WIDE_H
#define PATH_WIDE_H

#include <stdbool.h>
#include <stdint.h>

#include "base_wide.h"

/* a * b, exact. */
static inline struct wide path_wide_multiply(uint64_t a, uint64_t b)
{
    uint64_t a_low = (uint32_t)a;
    uint64_t a_high = a >> 32U;
    uint64_t b_low = (uint32_t)b;
    uint64_t b_high = b >> 32U;
    uint64_t low = a_low * b_low;
    uint64_t middle = a_high * b_low + (low >> 32U);
    uint64_t carry = a_low * b_high + (uint32_t)middle;
    return (struct wide){
        .high = a_high * b_high + (middle >> 32U) + (carry >> 32U),
        .low = (carry << 32U) | (uint32_t)low,
    };
}

/* a + b and a - b, modulo 2^128. */
static inline struct wide path_wide_add(struct wide a, struct wide b)
{
    uint64_t low = a.low + b.low;
    return (struct wide){.high = a.high + b.high + (low < a.low ? 1U : 0U), .low = low};
}

static inline struct wide path_wide_subtract(struct wide a, struct wide b)
{
    return (struct wide){.high = a.high - b.high - (a.low < b.low ? 1U : 0U), .low = a.low - b.low};
}

/* value * factor, modulo 2^128. */
static inline struct wide path_wide_times(struct wide value, uint64_t factor)
{
    struct wide product = path_wide_multiply(value.low, factor);
    product.high += value.high * factor;
    return product;
}

/* value * 2^bits modulo 2^128; bits 0 to 63. */
static inline struct wide path_wide_shift(struct wide value, unsigned bits)
{
    return (struct wide){
        .high = (value.high << bits) | ((value.low >> 1U) >> (63U - bits)),
        .low = value.low << bits,
    };
}

/* The number of bits of value up to its highest 1; 0 for 0. */
static inline unsigned path_wide_bits(uint64_t value)
{
    uint32_t high = (uint32_t)(value >> 32U);
    return high != 0 ? 32U + wide_bits(high) : wide_bits((uint32_t)value);
}

static inline bool path_wide_is_at_least(struct wide a, struct wide b)
{
    return a.high != b.high ? a.high > b.high : a.low >= b.low;
}

static inline bool path_wide_is_equal(struct wide a, struct wide b)
{
    return a.low == b.low && a.high == b.high;
}

#endif
