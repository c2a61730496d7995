/*
 * Time, as the unit counts it: ticks of the one timer whose compare channels make the STEP edges.
 *
 * The hardware counter has 32 bits and wraps every 51 s; the unit's time is the same count in 64 bits, which never
 * wraps. Segments and the step interrupt use the low 32 bits, programs use all 64.
 * All functions are pure and may be called from anywhere.
 */
#ifndef BASE_TICK_H
#define BASE_TICK_H

#include <stdbool.h>
#include <stdint.h>

/* Ticks per second. Every scale of the step generator follows from it (step_scale.h). */
#define TICK_HZ UINT32_C(84000000)
#define TICKS_PER_MS (TICK_HZ / UINT32_C(1000))
#define TICKS_PER_US (TICK_HZ / UINT32_C(1000000))

/* A moment that never comes. */
#define TICK_NEVER UINT64_MAX

/* The signed way from tick b to tick a; the two must be less than 2^31 ticks (25 s) apart. */
int32_t tick_difference(uint32_t a, uint32_t b);

/* Whether tick a comes before tick b, across the wrap of the counter; as above, within 25 s. */
bool tick_is_before(uint32_t a, uint32_t b);

/* The 64-bit time whose low half is `tick` and which lies within 25 s of `near_ticks`. */
uint64_t tick_extend(uint32_t tick, uint64_t near_ticks);

#endif
