/*
 * Whole numbers wider than the compiler offers: 128-bit unsigned arithmetic for the planner, and the two
 * conversions between signed and wrapping 64-bit numbers.
 *
 * The 128-bit functions are not fast and are not called from the step interrupt. All functions are pure.
 */
#ifndef BASE_WIDE_H
#define BASE_WIDE_H

#include <stdbool.h>
#include <stdint.h>

struct wide {
    uint64_t high;
    uint64_t low;
};

/* The two's complement reading of a wrapping 64-bit or 32-bit number, and back. Compilers make nothing of them: they
 * are the portable spelling of a cast, and may be used in the step interrupt. */
static inline int64_t wide_to_signed(uint64_t value)
{
    return value <= (uint64_t)INT64_MAX ? (int64_t)value : -(int64_t)(UINT64_MAX - value) - 1;
}

static inline int32_t wide_to_signed_32(uint32_t value)
{
    return value <= (uint32_t)INT32_MAX ? (int32_t)value : -(int32_t)(UINT32_MAX - value) - 1;
}

static inline uint64_t wide_from_signed(int64_t value)
{
    return (uint64_t)value;
}

/* The number of bits of value up to its highest 1; 0 for 0. Both compilers have the processor's instruction for it. May
 * be used in the step interrupt. */
static inline unsigned wide_bits(uint32_t value)
{
    return value != 0 ? 64U - (unsigned)__builtin_clzll(value) : 0U;
}

/* a * b, exact. */
struct wide wide_multiply(uint64_t a, uint64_t b);

/* a + b and a - b, modulo 2^128. */
struct wide wide_add(struct wide a, struct wide b);
struct wide wide_subtract(struct wide a, struct wide b);

/* value * 2^bits modulo 2^128; bits 0 to 63. */
struct wide wide_shift_left(struct wide value, unsigned bits);

/* Whether a >= b. */
bool wide_is_at_least(struct wide a, struct wide b);

/* The quotient of value / divisor rounded down; *remainder gets the rest. The divisor is 1 to 2^63. The quotient
 * must fit 64 bits, that is value.high < divisor; otherwise UINT64_MAX comes back with remainder 0. */
uint64_t wide_divide(struct wide value, uint64_t divisor, uint64_t *remainder);

/* value / divisor rounded to the nearest whole number, which must fit 64 bits; else as wide_divide. */
uint64_t wide_divide_nearest(struct wide value, uint64_t divisor);

/* factor * fraction / 2^32, rounded to the nearest. */
uint64_t wide_scale(uint64_t factor, uint32_t fraction);

/* The square root of value, rounded to the nearest whole number; value < 2^124. */
uint64_t wide_root_nearest(struct wide value);

#endif
