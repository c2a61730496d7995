/*
 * The contract of motion_lower, before its definition in motion_profile.h: proved with motion_profile.acsl.
 */
#ifndef LOWER_H
#define LOWER_H

#include <stdint.h>

/*@ assigns \nothing;
    ensures \result == (a < b ? a : b);
*/
static inline uint64_t motion_lower(uint64_t a, uint64_t b);

#endif
