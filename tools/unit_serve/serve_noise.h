/*
 * A bad line: in one direction bytes are lost, and others are changed. By chance, but the same for the same seed.
 */
#ifndef SERVE_NOISE_H
#define SERVE_NOISE_H

#include <stdbool.h>
#include <stdint.h>

enum {
    SERVE_NOISE_PER_MAX = 1000000 /* what rates are a part of */
};

struct serve_noise {
    uint64_t changed; /* bytes so far */
    uint64_t lost;
    uint64_t state;
    uint32_t change_rate; /* bytes of a million */
    uint32_t loss_rate;
};

/* Rates are 0 to SERVE_NOISE_PER_MAX; of a byte that is not lost `change_rate` is the chance to be changed. Other
 * seeds, of which all are good, make other chances. */
void serve_noise_init(struct serve_noise *noise, uint32_t change_rate, uint32_t loss_rate, uint64_t seed);

/* Lets a byte pass, as it is or as it becomes. False: it is lost. */
bool serve_noise_pass(struct serve_noise *noise, uint8_t *byte);

#endif
