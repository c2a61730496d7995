#include "base_wide.h"

enum {
    WORD_BITS = 64,
    HALF_BITS = 32
};

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

static unsigned leading_zeros(uint64_t value)
{
    uint32_t high = (uint32_t)(value >> HALF_BITS);
    unsigned bits = wide_bits(high != 0 ? high : (uint32_t)value);
    return (high != 0 ? HALF_BITS : WORD_BITS) - bits;
}

/* One digit of 32 bits of a long division: the quotient of rest * 2^32 + next, where rest < divisor and the divisor has
 * its top bit set. The quotient of the high parts is at most 2 too large (Knuth, The Art of Computer Programming,
 * volume 2, 4.3.1, theorem B); then what is subtracted is more than there is, and the difference wraps. */
static uint32_t divide_digit(uint64_t *rest, uint32_t next, uint64_t divisor)
{
    uint32_t high = (uint32_t)(divisor >> HALF_BITS);
    uint64_t digit = *rest / high;
    uint64_t left = *rest % high;
    uint64_t low_way = digit * (divisor & UINT32_MAX);
    while (digit > UINT32_MAX || (left <= UINT32_MAX && low_way > ((left << HALF_BITS) | next))) {
        digit--;
        low_way -= divisor & UINT32_MAX;
        left += high;
    }
    *rest = ((left << HALF_BITS) | next) - low_way;
    return (uint32_t)digit;
}

uint64_t wide_divide(struct wide value, uint64_t divisor, uint64_t *remainder)
{
    if (value.high == 0) {
        uint64_t quotient = value.low / divisor;
        *remainder = value.low - quotient * divisor;
        return quotient;
    }
    if (value.high >= divisor) {
        *remainder = 0;
        return UINT64_MAX;
    }
    unsigned shift = leading_zeros(divisor);
    struct wide scaled = wide_shift_left(value, shift);
    uint64_t rest = scaled.high;
    uint64_t high = divide_digit(&rest, (uint32_t)(scaled.low >> HALF_BITS), divisor << shift);
    uint64_t low = divide_digit(&rest, (uint32_t)(scaled.low & UINT32_MAX), divisor << shift);
    *remainder = rest >> shift;
    return (high << HALF_BITS) | low;
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

/* The root of a value of 2^30 to 2^32 - 1, rounded down. The straight line is at most 13 % off; Newton's rule makes
 * of an error e the error e^2/2, never too low: three times are good for 2^-31. */
static uint32_t root_of_word(uint32_t value)
{
    uint32_t root = (value >> 17U) + 24576U;
    root = (root + value / root) / 2U;
    root = (root + value / root) / 2U;
    root = (root + value / root) / 2U;
    return root > value / root ? root - 1U : root;
}

/* A root rounded down, and what the value is more than its square. */
struct root {
    uint64_t root;
    uint64_t rest;
};

/* Doubles the digits of a root (P. Zimmermann, Karatsuba Square Root, INRIA report 3805, 1999): with the root s and the
 * rest r of the high half, and two digits a1 and a0 that follow, all to the base b,
 *     (r*b + a1) / (2*s) = q, rest u        root = s*b + q, rest = u*b + a0 - q^2
 * and one less if that rest is negative. */
static struct root root_of_two_words(uint64_t value)
{
    enum {
        DIGIT = 0x10000
    };
    uint32_t high = (uint32_t)(value >> HALF_BITS);
    uint32_t root = root_of_word(high);
    uint64_t left = (uint64_t)(high - root * root) * DIGIT + value / DIGIT % DIGIT;
    uint32_t half = (uint32_t)(left / 2U);
    uint64_t digit = half / root;
    uint64_t rest = ((uint64_t)(half % root) * 2U + left % 2U) * DIGIT + value % DIGIT;
    struct root result = {.root = (uint64_t)root * DIGIT + digit, .rest = rest - digit * digit};
    if (rest < digit * digit) {
        result.root--;
        result.rest += 2U * result.root + 1U;
    }
    return result;
}

/* The same once more, without the rest. The value has one of its two top bits set. The digit may be 2^32 and its root
 * 2^64: both are put right by the correction. */
static uint64_t root_of_four_words(struct wide value)
{
    struct root high = root_of_two_words(value.high);
    uint64_t half = (high.rest << (HALF_BITS - 1U)) | (value.low >> (HALF_BITS + 1U));
    uint64_t digit = half / high.root;
    uint64_t left = (half % high.root) << 1U | ((value.low >> HALF_BITS) & 1U);
    struct wide rest = {.high = left >> HALF_BITS, .low = (left << HALF_BITS) | (value.low & UINT32_MAX)};
    uint64_t root = (high.root << HALF_BITS) + digit;
    return wide_is_at_least(rest, wide_multiply(digit, digit)) ? root : root - 1U;
}

/* The root of a value of more than one word, rounded down: shifted left until one of the top two bits is set, by an
 * even number of bits, and the root back by half of it. */
static uint64_t root_of_long(struct wide value)
{
    unsigned zeros = leading_zeros(value.high);
    unsigned half = zeros / 2U;
    struct wide shifted = wide_shift_left(value, 2U * half);
    uint64_t root = root_of_four_words(shifted);
    return root >> half;
}

/* Up if the next whole number is nearer: (root + 1/2)^2 = root^2 + root + 1/4, so the rest decides. */
uint64_t wide_root_nearest(struct wide value)
{
    if (value.high == 0 && value.low == 0) {
        return 0;
    }
    uint64_t root = 0;
    if (value.high != 0) {
        root = root_of_long(value);
    } else {
        root = root_of_long((struct wide){.high = value.low});
        root >>= HALF_BITS;
    }
    uint64_t rest = value.low - root * root;
    return rest > root ? root + 1U : root;
}
