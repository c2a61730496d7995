#include "serve_noise.h"

#include <assert.h>

enum {
    CHANGES = 255 /* of a byte: all others that it can be */
};

void serve_noise_init(struct serve_noise *noise, uint32_t change_rate, uint32_t loss_rate, uint64_t seed)
{
    assert(change_rate <= SERVE_NOISE_PER_MAX && loss_rate <= SERVE_NOISE_PER_MAX);
    *noise = (struct serve_noise){.state = seed, .change_rate = change_rate, .loss_rate = loss_rate};
}

/* SplitMix64 (Steele, Lea, Flood 2014): a number below `limit`. */
static uint32_t draw(struct serve_noise *noise, uint32_t limit)
{
    noise->state += UINT64_C(0x9E3779B97F4A7C15);
    uint64_t mixed = noise->state;
    mixed = (mixed ^ mixed >> 30U) * UINT64_C(0xBF58476D1CE4E5B9);
    mixed = (mixed ^ mixed >> 27U) * UINT64_C(0x94D049BB133111EB);
    return (uint32_t)((mixed ^ mixed >> 31U) % limit);
}

bool serve_noise_pass(struct serve_noise *noise, uint8_t *byte)
{
    if (draw(noise, SERVE_NOISE_PER_MAX) < noise->loss_rate) {
        noise->lost++;
        return false;
    }
    if (draw(noise, SERVE_NOISE_PER_MAX) < noise->change_rate) {
        noise->changed++;
        *byte = (uint8_t)(*byte ^ (1U + draw(noise, CHANGES)));
    }
    return true;
}
