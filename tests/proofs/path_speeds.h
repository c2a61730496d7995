/*
 * Contracts of speeds and paces in path_fixed.h, proved with path_fixed_slope.acsl and path_fixed_pace.acsl.
 */
#ifndef PATH_SPEEDS_H
#define PATH_SPEEDS_H

#include "path_fixeds.h"

#include "path_vector.h"

/* The most that a speed may be, but for what rounds it: twice its square. A slope is below 2^55, 2^63 / 256. */
/*@ logic integer twice_speed2_most = 4 * PATH_SPEED_MAX * PATH_SPEED_MAX; */

/*@ requires twice_speed2 <= twice_speed2_most;
    assigns \nothing;
    ensures \result.high <= 0x70000000000000;
    ensures 1 <= twice_speed2 ==> 0x100000 <= \result.high;
*/
struct wide path_fixed_slope(uint64_t twice_speed2);

/*@ requires 0x100000 <= slope.high < 0x8000000000000000;
    assigns \nothing;
    ensures \result.high < 0x40000000000;
*/
struct wide path_fixed_pace(struct wide slope);

#endif
