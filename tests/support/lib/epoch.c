#include "epoch.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "base_tick.h"

#define WRAP_SOON_TICKS (UINT64_C(3) * TICK_HZ)

static uint64_t first_state(void)
{
    const char *given = getenv("RKM04_SEED");
    struct timespec now = {0};
    (void)timespec_get(&now, TIME_UTC);
    uint64_t state = given != NULL ? strtoull(given, NULL, 0) : (uint64_t)now.tv_sec * 1000000U + (uint64_t)now.tv_nsec;
    printf("RKM04_SEED=%" PRIu64 "\n", state);
    (void)fflush(stdout); /* a program that aborts would lose it */
    return state;
}

/* splitmix64 */
uint64_t epoch_chance(void)
{
    static uint64_t state;
    static bool seeded;
    state = seeded ? state : first_state();
    seeded = true;
    state += UINT64_C(0x9e3779b97f4a7c15);
    uint64_t mixed = (state ^ (state >> 30U)) * UINT64_C(0xbf58476d1ce4e5b9);
    mixed = (mixed ^ (mixed >> 27U)) * UINT64_C(0x94d049bb133111eb);
    return mixed ^ (mixed >> 31U);
}

uint64_t epoch_random(void)
{
    uint64_t chance = epoch_chance();
    uint64_t epoch = chance >> 16U;
    return (chance & 1U) != 0 ? (epoch | UINT32_MAX) - epoch % WRAP_SOON_TICKS : epoch;
}
