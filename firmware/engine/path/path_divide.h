/*
 * Division by hardware multiplication: a divisor is readied once, and each digit of 32 bits of a quotient costs two
 * products. What base_wide.h does with the divisions of the compiler's library, for a planner that has hundreds of them
 * to make for every vector.
 *
 * Pure functions; main or plan interrupt.
 */
#ifndef PATH_DIVIDE_H
#define PATH_DIVIDE_H

#include <stdint.h>

#include "base_wide.h"

/* A divisor, ready for use. */
struct path_divisor {
    uint64_t scaled; /* the divisor * 2^shift: its top bit is set */
    uint32_t
        reciprocal; /* 2^96 / scaled, rounded down, or one less where that is a whole number, without its top bit */
    uint32_t shift;
};

/* Readies a divisor, at least 1. */
struct path_divisor path_divisor_of(uint64_t divisor);

/* A whole number divided, rounded down; the quotient is below 2^64. *rest gets the remainder. */
uint64_t path_divide(struct wide dividend, const struct path_divisor *divisor, uint64_t *rest);

/* The same to 64 binary places. */
struct wide path_divide_fixed(struct wide dividend, const struct path_divisor *divisor);

/* A number of 128 bits divided, rounded down, to a quotient of as many. */
struct wide path_divide_wide(struct wide dividend, const struct path_divisor *divisor);

#endif
