/*
 * Digits of quotients, by the processor's own division of words.
 */
#ifndef PATH_DIGIT_H
#define PATH_DIGIT_H

#include <stdint.h>

/* A digit of 16 bits of a quotient: of *rest * 2^16 + next, where *rest < divisor and the top bit of the divisor is
 * set. The quotient of the high parts is at most 2 too large (Knuth, The Art of Computer Programming, volume 2, 4.3.1,
 * theorem B). *rest gets the remainder. */
static inline uint32_t path_digit(uint32_t *rest, uint32_t next, uint32_t divisor)
{
    uint32_t high = divisor >> 16U;
    uint32_t digit = *rest / high;
    uint32_t left = ((*rest % high) << 16U) | next;
    uint32_t way = digit * (divisor & UINT16_MAX);
    if (left < way) {
        digit--;
        left += divisor;
        if (left >= divisor && left < way) {
            digit--;
            left += divisor;
        }
    }
    *rest = left - way;
    return digit;
}

/* The same of 32 bits: of *rest * 2^32 + next. */
static inline uint32_t path_digit_pair(uint32_t *rest, uint32_t next, uint32_t divisor)
{
    uint32_t high = path_digit(rest, next >> 16U, divisor);
    return (high << 16U) | path_digit(rest, next & UINT16_MAX, divisor);
}

#endif
