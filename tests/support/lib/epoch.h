/*
 * Chance of a test program: where the timer stands when a unit starts, so that no test relies on it.
 *
 * Each program tells its seed, on standard output, before anything can fail; RKM04_SEED repeats a run.
 */
#ifndef EPOCH_H
#define EPOCH_H

#include <stdint.h>

/* Uniform over 64 bits. */
uint64_t epoch_chance(void);

/* A unit's time at its start, below 2^48; half of them let the 32-bit counter wrap within 3 s. */
uint64_t epoch_random(void);

#endif
