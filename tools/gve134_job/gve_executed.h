/*
 * How many vectors of a job are over, told from the positions of the axes.
 *
 * A unit tells neither how many wait nor which one runs. But it holds GVE_EXECUTED_PLACES at most, they lie on a path
 * that is known, and L and N are taken only when nothing waits. So the vector is looked for on whose line all axes
 * stand, from the last one known on; on that they do not go back. Where the path comes by the same place again the
 * first is meant: the number may be too low for a while, never too high.
 *
 * A vector without pulses takes no place in the unit, however many there are: each is over with the one before it. What
 * drops vectors, or puts others in their place, makes the number unknown.
 *
 * Commands are texts as files have them, several with LF between them. Positions are those of X, Y, Z and A in pulses,
 * modulo 2^32 as the unit tells them. It only counts: its owner hands in what the unit has taken, and asks.
 */
#ifndef GVE_EXECUTED_H
#define GVE_EXECUTED_H

#include <stdbool.h>
#include <stdint.h>

enum {
    GVE_EXECUTED_PLACES = 128,
    GVE_EXECUTED_AXES = 4,
};

#define GVE_EXECUTED_UNKNOWN UINT32_MAX

struct gve_executed_vector {
    int32_t steps[GVE_EXECUTED_AXES]; /* not all 0 */
    uint32_t empty;                   /* so many vectors without pulses come after it */
};

struct gve_executed {
    struct gve_executed_vector ring[GVE_EXECUTED_PLACES];
    uint32_t first;                    /* in the ring */
    uint32_t waiting;                  /* from there on: taken, and not known to be over */
    uint32_t done;                     /* so many are over */
    bool unknown;                      /* how many are over */
    uint32_t place[GVE_EXECUTED_AXES]; /* where the first vector begins that is not over */
    uint64_t gone;                     /* pulses of all axes that were seen of it */
    bool moved[GVE_EXECUTED_AXES];     /* by the job; of a coupled A the positions are those of another */
};

/* Nothing was taken; the axes are at `place`, where the first vector begins. */
void gve_executed_init(struct gve_executed *executed, const int32_t place[GVE_EXECUTED_AXES]);

/* From now on the number is unknown. */
void gve_executed_lose(struct gve_executed *executed);

/* The unit has taken these commands. */
void gve_executed_take(struct gve_executed *executed, const uint8_t *text, uint32_t length);

/* All that was taken is over, and the axes stand there. */
void gve_executed_stand(struct gve_executed *executed, const int32_t place[GVE_EXECUTED_AXES]);

/* How many are over when the axes are there, or GVE_EXECUTED_UNKNOWN; these commands were perhaps taken, too. */
uint32_t gve_executed_look(struct gve_executed *executed, const int32_t place[GVE_EXECUTED_AXES], const uint8_t *text,
                           uint32_t length);

/* The same as far as it is known without a look. */
uint32_t gve_executed_done(const struct gve_executed *executed);

#endif
