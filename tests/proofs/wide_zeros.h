/*
 * Contract of the count of leading zeros in base_wide.c, proved with base_wide_divide.acsl.
 */
#ifndef WIDE_ZEROS_H
#define WIDE_ZEROS_H

#include "shifts.h"

#include <stdint.h>

/*@ requires 1 <= value;
    assigns \nothing;
    ensures \result <= 63;
    ensures 0x8000000000000000 <= value * power(\result) < 0x10000000000000000;
*/
static unsigned leading_zeros(uint64_t value);

#endif
