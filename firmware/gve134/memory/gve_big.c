#include "gve_big.h"

#include <assert.h>
#include <stdbool.h>

enum {
    WORD_BITS = 32,
    QUOTIENT_BITS_MAX = 31,
};

struct gve_big gve_big_of(uint32_t value)
{
    return (struct gve_big){.words = {value}};
}

void gve_big_multiply(struct gve_big *value, uint32_t factor, uint32_t summand)
{
    uint64_t carry = summand;
    for (unsigned i = 0; i < GVE_BIG_WORDS; i++) {
        carry += (uint64_t)value->words[i] * factor;
        value->words[i] = (uint32_t)carry;
        carry >>= WORD_BITS;
    }
    assert(carry == 0);
}

void gve_big_scale_ten(struct gve_big *value, uint32_t exponent)
{
    for (uint32_t i = 0; i < exponent; i++) {
        gve_big_multiply(value, 10, 0);
    }
}

void gve_big_shift_left(struct gve_big *value, uint32_t bits)
{
    assert(gve_big_bits(value) + bits <= (uint32_t)GVE_BIG_WORDS * WORD_BITS);
    uint32_t far = bits / WORD_BITS;
    uint32_t near = bits % WORD_BITS;
    for (uint32_t i = GVE_BIG_WORDS; i-- > 0;) {
        uint64_t high = i >= far ? value->words[i - far] : 0;
        uint64_t low = i > far ? value->words[i - far - 1U] : 0;
        value->words[i] = (uint32_t)((((high << WORD_BITS) | low) << near) >> WORD_BITS);
    }
}

static void shift_right_one(struct gve_big *value)
{
    uint32_t carry = 0;
    for (unsigned i = GVE_BIG_WORDS; i-- > 0;) {
        uint32_t word = value->words[i];
        value->words[i] = (word >> 1U) | (carry << (WORD_BITS - 1));
        carry = word & 1U;
    }
}

uint32_t gve_big_bits(const struct gve_big *value)
{
    uint32_t bits = 0;
    for (uint32_t i = 0; i < GVE_BIG_WORDS; i++) {
        uint32_t place = i * WORD_BITS;
        for (uint32_t word = value->words[i]; word != 0; word >>= 1U) {
            place++;
            bits = place;
        }
    }
    return bits;
}

int gve_big_compare(const struct gve_big *a, const struct gve_big *b)
{
    for (unsigned i = GVE_BIG_WORDS; i-- > 0;) {
        if (a->words[i] != b->words[i]) {
            return a->words[i] < b->words[i] ? -1 : 1;
        }
    }
    return 0;
}

static void subtract(struct gve_big *a, const struct gve_big *b)
{
    uint32_t borrow = 0;
    for (unsigned i = 0; i < GVE_BIG_WORDS; i++) {
        uint64_t difference = (uint64_t)a->words[i] - b->words[i] - borrow;
        a->words[i] = (uint32_t)difference;
        borrow = (uint32_t)(difference >> WORD_BITS) & 1U;
    }
}

struct gve_quotient gve_big_divide(struct gve_big numerator, struct gve_big denominator, uint32_t bits)
{
    assert(bits <= QUOTIENT_BITS_MAX);
    uint32_t floor = 0;
    gve_big_shift_left(&denominator, bits);
    assert(gve_big_compare(&numerator, &denominator) < 0);
    for (uint32_t i = 0; i < bits; i++) {
        shift_right_one(&denominator);
        bool fits = gve_big_compare(&numerator, &denominator) >= 0;
        floor = floor * 2U + (fits ? 1U : 0U);
        if (fits) {
            subtract(&numerator, &denominator);
        }
    }
    gve_big_shift_left(&numerator, 1); /* the remainder beside half of the denominator */
    int half = gve_big_compare(&numerator, &denominator);
    bool up = half > 0 || (half == 0 && floor % 2U != 0);
    return (struct gve_quotient){.floor = floor, .nearest = floor + (up ? 1U : 0U)};
}
