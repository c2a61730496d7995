/*
 * The bits of a single (IEEE 754, binary32): 1 of sign, 8 of exponent, 23 of fraction. Constants only.
 */
#ifndef GVE_FLOAT_FORMAT_H
#define GVE_FLOAT_FORMAT_H

#include <stdint.h>

enum {
    FLOAT_FRACTION_BITS = 23,
    FLOAT_SIGNIFICAND_BITS = 24, /* with the one that is not written */
    FLOAT_EXPONENT_MIN = -149,   /* of the lowest bit of the smallest numbers */
};

#define FLOAT_SIGN UINT32_C(0x80000000)
#define FLOAT_INFINITY UINT32_C(0x7F800000)
#define FLOAT_FRACTION UINT32_C(0x007FFFFF)

#endif
