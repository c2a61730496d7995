#include "path_root.h"

#include "path_digit.h"
#include "path_wide.h"

enum {
    WORD_BITS = 64,
    HALF_BITS = 32,
    DIGIT_BITS = 16
};

/* The root of a value of 2^30 to 2^32 - 1, rounded down: a straight line, and Newton's rule three times. */
static uint32_t root_of_word(uint32_t value)
{
    uint32_t root = (value >> 17U) + 24576U;
    root = (root + value / root) / 2U;
    root = (root + value / root) / 2U;
    root = (root + value / root) / 2U;
    return root > value / root ? root - 1U : root;
}

/* A root rounded down, and what the value is more than its square. */
struct path_root_half {
    uint32_t root;
    uint64_t rest;
};

/* Doubles the digits of a root (P. Zimmermann, Karatsuba Square Root, INRIA report 3805, 1999), as in base_wide.c. */
static struct path_root_half root_of_two_words(uint64_t value)
{
    uint32_t high = (uint32_t)(value >> HALF_BITS);
    uint32_t low = (uint32_t)value;
    uint32_t root = root_of_word(high);
    uint32_t left = high - root * root;
    uint32_t half = (left << (DIGIT_BITS - 1U)) | (low >> (DIGIT_BITS + 1U));
    uint32_t digit = half / root;
    uint64_t rest = ((uint64_t)(half % root) << (DIGIT_BITS + 1U)) | (low & ((UINT32_C(2) << DIGIT_BITS) - 1U));
    uint64_t way = (uint64_t)digit * digit;
    struct path_root_half result = {.root = (root << DIGIT_BITS) + digit, .rest = rest - way};
    if (rest < way) {
        result.root--;
        result.rest += 2U * (uint64_t)result.root + 1U;
    }
    return result;
}

/* The same once more, without the rest. The value has one of its two top bits set. The digit may be 2^32 and its root
 * 2^64: both are put right by the correction. */
static uint64_t root_of_four_words(struct wide value)
{
    struct path_root_half high = root_of_two_words(value.high);
    uint64_t half = (high.rest << (HALF_BITS - 1U)) | (value.low >> (HALF_BITS + 1U));
    uint32_t left = (uint32_t)(half >> HALF_BITS);
    uint64_t digit = 0;
    if (left >= high.root) {
        left -= high.root;
        digit = UINT64_C(1) << HALF_BITS;
    }
    digit += path_digit_pair(&left, (uint32_t)half, high.root);
    uint64_t odd = ((uint64_t)left << 1U) | ((value.low >> HALF_BITS) & 1U);
    struct wide rest = {.high = odd >> HALF_BITS, .low = (odd << HALF_BITS) | (uint32_t)value.low};
    uint64_t root = ((uint64_t)high.root << HALF_BITS) + digit;
    return path_wide_is_at_least(rest, path_wide_multiply(digit, digit)) ? root : root - 1U;
}

/* A value of more than one word is shifted left until one of the top two bits is set, by an even number of bits, and
 * the root back by half of it. Up if the next whole number is nearer: (root + 1/2)^2 = root^2 + root + 1/4, so the rest
 * decides. */
uint64_t path_root(struct wide value)
{
    uint64_t back = 0;
    struct wide scaled = value;
    if (value.high == 0) {
        back = HALF_BITS;
        scaled = (struct wide){.high = value.low};
    }
    if (scaled.high == 0) {
        return 0;
    }
    unsigned half = (WORD_BITS - path_wide_bits(scaled.high)) / 2U;
    uint64_t root = root_of_four_words(path_wide_shift(scaled, 2U * half)) >> (half + back);
    uint64_t rest = value.low - root * root;
    return rest > root ? root + 1U : root;
}
