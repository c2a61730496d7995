/*
 * Speeds: what V, A, B, $, VK, VN, VL, VJ and X mean for a vector.
 *
 * Comes in: what commands have set, and vectors in pulses. Goes out: the speed limit of a vector, in 1/256 pulse/s of
 * its longest axis, and the speed at the border where it joins another one; both whole numbers without a rounding of
 * their own beyond what is said here. Speeds count pulses of the longest axis (VN) or of the way of X, Y and Z together
 * (VK): the extent E is that length, L the longest axis. Pure functions.
 */
#ifndef GVE_SPEEDS_H
#define GVE_SPEEDS_H

#include <stdbool.h>
#include <stdint.h>

#include "../../engine/path/path_vector.h"

#define GVE_SPEED_TOP 200000U

/* The factor of the X commands, in 1/65536 per cent: 1 to 1000 per cent. */
#define GVE_FACTOR_PER_CENT UINT32_C(65536)
#define GVE_FACTOR_ONE UINT32_C(6553600)

enum {
    GVE_VECTOR_US_MIN = 500, /* no vector passes faster */
};

/* What holds for the vectors that follow. */
struct gve_modal {
    uint32_t speed;            /* V, 10 to GVE_SPEED_TOP pulses/s */
    uint32_t accel;            /* A, 1 to 8000, 1000 pulses/s^2 */
    uint32_t brake;            /* B, 10 to GVE_SPEED_TOP pulses/s */
    uint32_t short_pulses;     /* $: vectors with fewer are short */
    uint32_t pause_ms;         /* T, 1 to 24 */
    uint32_t limit[PATH_AXES]; /* VL, 10 to GVE_SPEED_TOP pulses/s; none: GVE_SPEED_TOP */
    uint32_t jump[PATH_AXES];  /* VJ, pulses/s; 0: off */
    bool corrected;            /* VK */
};

/* What is kept of a vector while it is queued. */
struct gve_vector {
    int32_t steps[PATH_AXES];
    uint32_t speed; /* V */
    uint32_t brake; /* B */
    uint32_t accel; /* A */
    bool is_short;
    bool corrected;
};

/* As after a reset. */
void gve_modal_init(struct gve_modal *modal);

/* A vector, not all 0, as it is entered. */
struct gve_vector gve_speeds_take(const struct gve_modal *modal, const int32_t steps[PATH_AXES]);

/* E^2, at least 1. */
uint64_t gve_speeds_extent2(const struct gve_vector *vector);

/* The speed limit U, 1 to 256 * GVE_SPEED_TOP, under a factor and the limits of the axes:
 *   V* = max(1, floor(256*V*f + 1/2)), at most 256*B if short;
 *   U = max(1, min(floor(V* * L/E + 1/2), 256*GVE_SPEED_TOP, 256*L*10^6/GVE_VECTOR_US_MIN,
 *                  floor(256*VL_j*L/|d_j|) for each axis that moves)). */
uint32_t gve_speeds_limit(const struct gve_vector *vector, uint32_t factor, const uint32_t limit[PATH_AXES]);

/* The most at the border where `after` joins `before`, in 1/256 pulse/s in terms of V: B of the one before, and for
 * each axis with a jump J floor(256*J*N*N' / (2^16*|d'*N - d*N'|)), where N = ceil(2^16*E) and dashes are of `after`.
 */
uint32_t gve_speeds_border(const struct gve_vector *before, const struct gve_vector *after,
                           const uint32_t jump[PATH_AXES]);

/* The factor a sixteenth up or down, to the nearest, halves up; of so many per cent. 1 to 1000 per cent. */
uint32_t gve_factor_up(uint32_t factor);
uint32_t gve_factor_down(uint32_t factor);

#endif
