/*
 * Contract of one digit of the long division in base_wide.c, proved with base_wide_digit.acsl.
 */
#ifndef WIDE_DIGIT_H
#define WIDE_DIGIT_H

#include <stdint.h>

/*@ predicate digit_found(integer rest, integer next, integer divisor, integer digit, integer left) =
        rest * 0x100000000 + next == digit * divisor + left && 0 <= left < divisor;
*/
/*@ requires \valid(rest) && 0x8000000000000000 <= divisor && *rest < divisor;
    assigns *rest;
    ensures digit_found(\old(*rest), next, divisor, \result, *rest);
*/
static uint32_t divide_digit(uint64_t *rest, uint32_t next, uint64_t divisor);

#endif
