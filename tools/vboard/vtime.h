/*
 * Virtual time. The unit of everything on the chip is the cycle of HCLK, the clock of the processor, counted since
 * power-on in 64 bits; what has a time of its own (crystal, LSI, scripts) counts picoseconds since power-on. The two
 * meet at an anchor that moves whenever the clock tree changes.
 */
#ifndef VTIME_H
#define VTIME_H

#include <stdint.h>

#define VTIME_NEVER UINT64_MAX
#define VTIME_PS_PER_SECOND UINT64_C(1000000000000)
#define VTIME_PS_PER_MS UINT64_C(1000000000)
#define VTIME_PS_PER_US UINT64_C(1000000)
#define VTIME_PS_PER_NS UINT64_C(1000)

struct vtime {
    uint64_t anchor_cycle;
    uint64_t anchor_ps;
    uint64_t hclk_hz;
};

/* a * b / c, rounded down, with 128 bits between. c is not 0 and the result fits. */
uint64_t vtime_scale(uint64_t a, uint64_t b, uint64_t c);

/* A frequency from now on. */
void vtime_set_hclk(struct vtime *time, uint64_t cycle, uint64_t hz);

uint64_t vtime_ps_of_cycle(const struct vtime *time, uint64_t cycle);

/* The first cycle that is not before `ps`; the anchor's for times before it. VTIME_NEVER stays so. */
uint64_t vtime_cycle_of_ps(const struct vtime *time, uint64_t ps);

#endif
