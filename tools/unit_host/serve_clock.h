/*
 * The clock of units that run beside a real clock: real time times a speed gives ticks. Pure; the caller reads the real
 * clock.
 */
#ifndef SERVE_CLOCK_H
#define SERVE_CLOCK_H

#include <stdint.h>

/* Thousandths of real time: up to 1000 times as fast. */
enum {
    SERVE_MILLI_SPEED_MAX = 1000000
};

/* Real time by which units may be late; if they are later, the clock goes on from where they are. */
#define SERVE_LAG_MS_MAX UINT64_C(1000)

struct serve_clock {
    uint64_t base_ns;     /* real time, and ... */
    uint64_t base_tick;   /* ... the tick that it was then */
    uint32_t milli_speed; /* 1 to SERVE_MILLI_SPEED_MAX */
};

/* From now on the clock goes on from `tick`. */
void serve_clock_set(struct serve_clock *clock, uint64_t real_ns, uint64_t tick);

/* The tick that it is; real time must not go back. */
uint64_t serve_clock_tick(struct serve_clock *clock, uint64_t real_ns);

/* The real time at which the clock is past a tick; of ticks far ahead some time before. */
uint64_t serve_clock_ns(const struct serve_clock *clock, uint64_t tick);

#endif
