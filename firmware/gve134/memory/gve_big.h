/*
 * Whole numbers of a fixed width, wide enough for every step between a decimal text and a single: gve_float.c names
 * the longest. Overflow is the caller's to exclude; it is asserted. Pure; may be called from anywhere. 64 bytes each.
 */
#ifndef GVE_BIG_H
#define GVE_BIG_H

#include <stdint.h>

enum {
    GVE_BIG_WORDS = 16, /* of 32 bits, the lowest first */
};

struct gve_big {
    uint32_t words[GVE_BIG_WORDS];
};

struct gve_big gve_big_of(uint32_t value);

/* Makes it value * factor + summand. */
void gve_big_multiply(struct gve_big *value, uint32_t factor, uint32_t summand);

/* Multiplies by 10^exponent. */
void gve_big_scale_ten(struct gve_big *value, uint32_t exponent);

void gve_big_shift_left(struct gve_big *value, uint32_t bits);

/* Bits up to the highest one that is set; 0 for 0. */
uint32_t gve_big_bits(const struct gve_big *value);

/* Below 0, 0 or above 0, as a is to b. */
int gve_big_compare(const struct gve_big *a, const struct gve_big *b);

/* A quotient, to the nearest whole number, ties to the even one. */
struct gve_quotient {
    uint32_t floor;   /* rounded down */
    uint32_t nearest; /* rounded */
};

/* numerator / denominator, which must be below 2^bits, with bits at most 31. */
struct gve_quotient gve_big_divide(struct gve_big numerator, struct gve_big denominator, uint32_t bits);

#endif
