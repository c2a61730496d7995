/*
 * Chance that a seed repeats.
 */
#ifndef SOAK_CHANCE_H
#define SOAK_CHANCE_H

#include <stdint.h>

/* splitmix64; any state is a good seed. */
static inline uint64_t chance_next(uint64_t *state)
{
    *state += UINT64_C(0x9e3779b97f4a7c15);
    uint64_t mixed = (*state ^ (*state >> 30U)) * UINT64_C(0xbf58476d1ce4e5b9);
    mixed = (mixed ^ (mixed >> 27U)) * UINT64_C(0x94d049bb133111eb);
    return mixed ^ (mixed >> 31U);
}

/* 0 to `count` - 1. */
static inline uint32_t chance_below(uint64_t *state, uint32_t count)
{
    return (uint32_t)((chance_next(state) >> 32U) * count >> 32U);
}

#endif
