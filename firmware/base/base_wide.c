#include "base_wide.h"

enum { WORD_BITS = 64, HALF_BITS = 32 };

unsigned wide_bits(uint32_t value)
{
    unsigned bits = 0;
    for (unsigned half = HALF_BITS / 2; half > 0; half /= 2U) {
        if (value >> half != 0) {
            value >>= half;
            bits += half;
        }
    }
    return bits + value;
}

struct wide wide_multiply(uint64_t a, uint64_t b)
{
    uint64_t a_low = a & UINT32_MAX;
    uint64_t a_high = a >> HALF_BITS;
    uint64_t b_low = b & UINT32_MAX;
    uint64_t b_high = b >> HALF_BITS;
    uint64_t low = a_low * b_low;
    uint64_t middle = a_high * b_low + (low >> HALF_BITS);
    uint64_t carry = a_low * b_high + (middle & UINT32_MAX);
    return (struct wide){
        .high = a_high * b_high + (middle >> HALF_BITS) + (carry >> HALF_BITS),
        .low = (carry << HALF_BITS) | (low & UINT32_MAX),
    };
}

struct wide wide_add(struct wide a, struct wide b)
{
    uint64_t low = a.low + b.low;
    return (struct wide){.high = a.high + b.high + (low < a.low ? 1U : 0U), .low = low};
}

struct wide wide_subtract(struct wide a, struct wide b)
{
    return (struct wide){.high = a.high - b.high - (a.low < b.low ? 1U : 0U), .low = a.low - b.low};
}

struct wide wide_shift_left(struct wide value, unsigned bits)
{
    if (bits == 0) {
        return value;
    }
    return (struct wide){
        .high = (value.high << bits) | (value.low >> (WORD_BITS - bits)),
        .low = value.low << bits,
    };
}

bool wide_is_at_least(struct wide a, struct wide b)
{
    return a.high != b.high ? a.high > b.high : a.low >= b.low;
}

/* Schoolbook division, a bit at a time: the rest stays below the divisor, so it never needs a 65th bit. */
uint64_t wide_divide(struct wide value, uint64_t divisor, uint64_t *remainder)
{
    if (value.high == 0) {
        *remainder = value.low % divisor;
        return value.low / divisor;
    }
    *remainder = 0;
    if (value.high >= divisor) {
        return UINT64_MAX;
    }
    uint64_t rest = value.high;
    uint64_t quotient = 0;
    for (unsigned bit = WORD_BITS; bit-- > 0;) {
        rest = (rest << 1U) | ((value.low >> bit) & 1U);
        quotient <<= 1U;
        if (rest >= divisor) {
            rest -= divisor;
            quotient |= 1U;
        }
    }
    *remainder = rest;
    return quotient;
}

uint64_t wide_scale(uint64_t factor, uint32_t fraction)
{
    struct wide product = wide_add(wide_multiply(factor, fraction), (struct wide){.low = UINT64_C(1) << 31});
    return (product.high << HALF_BITS) | (product.low >> HALF_BITS);
}

uint64_t wide_divide_nearest(struct wide value, uint64_t divisor)
{
    uint64_t rest = 0;
    uint64_t quotient = wide_divide(value, divisor, &rest);
    return rest > 0 && rest >= divisor - rest ? quotient + 1U : quotient;
}

/* Digit by digit, as on paper, two bits of the value for one of the root: rest = what is left of the bits so far, and
 * (2*root + 1)^2 - (2*root)^2 = 4*root + 1 decides the next bit. Then up if the next half is nearer: (root + 1/2)^2 =
 * root^2 + root + 1/4, so the rest decides. */
uint64_t wide_root_nearest(struct wide value)
{
    uint64_t root = 0;
    uint64_t rest = 0;
    for (unsigned i = 0; i < WORD_BITS; i++) {
        rest = (rest << 2U) | (value.high >> (WORD_BITS - 2U));
        value = wide_shift_left(value, 2);
        uint64_t trial = (root << 2U) | 1U;
        root <<= 1U;
        if (rest >= trial) {
            rest -= trial;
            root |= 1U;
        }
    }
    return rest > root ? root + 1U : root;
}
