#include "path_divide.h"

#include "path_digit.h"
#include "path_wide.h"

enum {
    WORD_BITS = 64,
    HALF_BITS = 32
};

/* (2^64 - 1) / divisor, rounded down, less 2^32. */
static uint32_t reciprocal_of_word(uint32_t divisor)
{
    uint32_t rest = ~divisor;
    return path_digit_pair(&rest, UINT32_MAX, divisor);
}

/* (2^96 - 1) / scaled, rounded down, less 2^32: N. Moeller, T. Granlund, Improved Division by Invariant Integers, IEEE
 * Transactions on Computers 60 (2011), algorithm 6. All but the products is modulo 2^32. */
static uint32_t reciprocal_of(uint64_t scaled)
{
    uint32_t high = (uint32_t)(scaled >> HALF_BITS);
    uint32_t low = (uint32_t)scaled;
    uint32_t reciprocal = reciprocal_of_word(high);
    uint32_t rest = high * reciprocal + low;
    if (rest < low) {
        reciprocal--;
        if (rest >= high) {
            reciprocal--;
            rest -= high;
        }
        rest -= high;
    }
    uint64_t product = (uint64_t)reciprocal * low;
    uint32_t carry = (uint32_t)(product >> HALF_BITS);
    rest += carry;
    if (rest < carry) {
        reciprocal--;
        if ((((uint64_t)rest << HALF_BITS) | (uint32_t)product) >= scaled) {
            reciprocal--;
        }
    }
    return reciprocal;
}

struct path_divisor path_divisor_of(uint64_t divisor)
{
    unsigned shift = WORD_BITS - path_wide_bits(divisor);
    uint64_t scaled = divisor << shift;
    return (struct path_divisor){.scaled = scaled, .reciprocal = reciprocal_of(scaled), .shift = shift};
}

/* A digit of 32 bits: of *rest * 2^32 + next, where *rest < scaled. Algorithm 4 of the same. */
static inline uint32_t digit_of(uint64_t *rest, uint32_t next, const struct path_divisor *divisor)
{
    uint64_t scaled = divisor->scaled;
    uint64_t guess = (uint64_t)divisor->reciprocal * (uint32_t)(*rest >> HALF_BITS) + *rest;
    uint32_t digit = (uint32_t)(guess >> HALF_BITS);
    uint32_t high = (uint32_t)*rest - digit * (uint32_t)(scaled >> HALF_BITS);
    uint64_t left = (((uint64_t)high << HALF_BITS) | next) - (uint64_t)digit * (uint32_t)scaled - scaled;
    digit++;
    if ((uint32_t)(left >> HALF_BITS) >= (uint32_t)guess) {
        digit--;
        left += scaled;
    }
    if (left >= scaled) {
        digit++;
        left -= scaled;
    }
    *rest = left;
    return digit;
}

static inline uint64_t two_digits(uint64_t *rest, uint64_t next, const struct path_divisor *divisor)
{
    uint64_t high = digit_of(rest, (uint32_t)(next >> HALF_BITS), divisor);
    return (high << HALF_BITS) | digit_of(rest, (uint32_t)next, divisor);
}

/* The bits of a word that a shift to the left by less than a word pushes out. */
static uint64_t pushed_out(uint64_t value, unsigned shift)
{
    return (value >> 1U) >> (WORD_BITS - 1U - shift);
}

uint64_t path_divide(struct wide dividend, const struct path_divisor *divisor, uint64_t *rest)
{
    unsigned shift = divisor->shift;
    uint64_t left = (dividend.high << shift) | pushed_out(dividend.low, shift);
    uint64_t quotient = two_digits(&left, dividend.low << shift, divisor);
    *rest = left >> shift;
    return quotient;
}

struct wide path_divide_fixed(struct wide dividend, const struct path_divisor *divisor)
{
    unsigned shift = divisor->shift;
    uint64_t left = (dividend.high << shift) | pushed_out(dividend.low, shift);
    uint64_t whole = two_digits(&left, dividend.low << shift, divisor);
    return (struct wide){.high = whole, .low = two_digits(&left, 0, divisor)};
}

struct wide path_divide_wide(struct wide dividend, const struct path_divisor *divisor)
{
    unsigned shift = divisor->shift;
    uint64_t left = pushed_out(dividend.high, shift);
    uint64_t next = (dividend.high << shift) | pushed_out(dividend.low, shift);
    uint64_t high = two_digits(&left, next, divisor);
    return (struct wide){.high = high, .low = two_digits(&left, dividend.low << shift, divisor)};
}
