/*
 * Contracts of path_digit.h, proved with path_digit.acsl.
 */
#ifndef PATH_HALVES_H
#define PATH_HALVES_H

#include <stdint.h>

/*@ predicate half_over(integer rest, integer next, integer divisor, integer digit, integer over) =
        rest * 0x10000 + next == digit * divisor + over;
    predicate half_found(integer rest, integer next, integer divisor, integer digit, integer left) =
        half_over(rest, next, divisor, digit, left) && 0 <= left < divisor && 0 <= digit <= 0xFFFF;
    predicate word_found(integer rest, integer next, integer divisor, integer digit, integer left) =
        rest * 0x100000000 + next == digit * divisor + left && 0 <= left < divisor && 0 <= digit <= 0xFFFFFFFF;
*/

/*@ requires \valid(rest) && 0x80000000 <= divisor && *rest < divisor && next <= 0xFFFF;
    assigns *rest;
    ensures half_found(\old(*rest), next, divisor, \result, *rest);
*/
static inline uint32_t path_digit(uint32_t *rest, uint32_t next, uint32_t divisor);

/*@ requires \valid(rest) && 0x80000000 <= divisor && *rest < divisor;
    assigns *rest;
    ensures word_found(\old(*rest), next, divisor, \result, *rest);
*/
static inline uint32_t path_digit_pair(uint32_t *rest, uint32_t next, uint32_t divisor);

#endif
