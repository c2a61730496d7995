/*
 * Contracts of path_vector.h, proved with path_vector.acsl, for all vectors that it allows.
 */
#ifndef PATH_VECTORS_H
#define PATH_VECTORS_H

#include "path_words.h"
#include "squares.h"
#include "step_scale.h"

#include "path_vector.h"

/*@ predicate vector_fits(struct path_section *s) =
        1 <= s->vector.speed <= PATH_SPEED_MAX && 1 <= s->vector.accel <= PATH_ACCEL_MAX &&
        1 <= s->vector.extent2 <= 0xC000000000000000 && 1 <= s->length <= 0x7FFFFFFF &&
        (s->plain <==> s->vector.extent2 == square(s->length));
    predicate capped(integer x, integer divisor, integer quotient) =
        0 <= quotient <= 0x1000000000000000 && 1 <= divisor && quotient * divisor <= x &&
        (quotient < 0x1000000000000000 ==> x < quotient * divisor + divisor);
*/

/*@ requires \valid_read(section) && vector_fits(section);
    assigns \nothing;
    ensures section->plain ==> \result == speed2;
    ensures !section->plain ==> capped(speed2 * section->vector.extent2, square(section->length), \result);
*/
uint64_t path_section_to_border2(const struct path_section *section, uint64_t speed2);

/*@ requires \valid_read(section) && vector_fits(section);
    assigns \nothing;
    ensures section->plain ==> \result == speed2;
    ensures !section->plain ==> \result <= 0x1000000000000001;
*/
uint64_t path_section_to_border2_up(const struct path_section *section, uint64_t speed2);

/*@ requires \valid_read(section) && vector_fits(section);
    assigns \nothing;
    ensures section->plain ==> \result == border2;
    ensures !section->plain ==> capped(border2 * square(section->length), section->vector.extent2, \result);
*/
uint64_t path_section_from_border2(const struct path_section *section, uint64_t border2);

/*@ requires \valid_read(section) && vector_fits(section);
    assigns \nothing;
    ensures \result == 1024 * section->vector.accel && 1024 <= \result <= 0x10000000000;
*/
static inline uint64_t path_section_gain_per_step(const struct path_section *section);

/*@ requires \valid_read(section) && vector_fits(section);
    assigns \nothing;
    ensures \result == 2048 * section->vector.accel && 2048 <= \result <= 0x20000000000;
*/
static inline uint64_t path_section_grains_per_step(const struct path_section *section);

/*@ requires \valid_read(section) && vector_fits(section);
    assigns \nothing;
    ensures value(\result) == 2048 * section->vector.accel * section->length;
*/
static inline struct wide path_section_end(const struct path_section *section);

/*@ requires \valid_read(section) && axis < PATH_AXES && -0x7FFFFFFF <= section->vector.steps[axis];
    assigns \nothing;
    ensures \result == (section->vector.steps[axis] < 0 ? -section->vector.steps[axis] : section->vector.steps[axis]);
    ensures \result <= 0x7FFFFFFF;
*/
static inline uint32_t path_section_steps(const struct path_section *section, unsigned axis);

#endif
