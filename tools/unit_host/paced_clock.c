#include "paced_clock.h"

#include <stddef.h>

#include "base_tick.h"

enum {
    REAL_MILLI_SPEED = 1000
};

#define LAG_TICKS_MAX (SERVE_LAG_MS_MAX * TICKS_PER_MS)

/* Short enough for a caller that looks after others between two of them. */
#define SLICE_TICKS ((uint64_t)20 * TICKS_PER_MS)

void paced_clock_begin(struct paced_clock *paced, uint64_t real_ns)
{
    *paced = (struct paced_clock){.clock = {.milli_speed = REAL_MILLI_SPEED}};
    serve_clock_set(&paced->clock, real_ns, 0);
}

bool paced_clock_follow(struct paced_clock *paced, struct host_machine *machine, uint64_t real_ns,
                        uint64_t (*poll)(void *unit), void *unit)
{
    uint64_t now = machine->now;
    uint64_t target = serve_clock_tick(&paced->clock, real_ns);
    uint64_t left = target > now ? target - now : 0;
    if (left > LAG_TICKS_MAX) {
        paced->stood_ticks += left;
        serve_clock_set(&paced->clock, real_ns, now);
        return false;
    }
    if (left > 0) {
        uint64_t until = now + (left < SLICE_TICKS ? left : SLICE_TICKS);
        host_machine_run(machine, until, poll, NULL, unit);
    }
    return left > SLICE_TICKS;
}
