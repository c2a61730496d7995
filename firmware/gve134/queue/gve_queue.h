/*
 * The queue: vectors in, motion of the four axes out, and the states of the unit.
 *
 * Comes in: vectors as they are entered, halts, interrupts, changes of speed, reference runs. Goes out: segments to the
 * four step channels by two groups, of which one is in use: that with 128 places, or, after K, a small one for the
 * single vectors of a host that works beside the kept path. The state is told by two bits: RUN, something moves or
 * waits; INTA, a stop has been accepted. After a stop the rest of the path waits for G.
 *
 * Who may call:
 *   step interrupt   gve_queue_lay_isr
 *   tick interrupt   gve_queue_sense_isr
 *   plan interrupt   gve_queue_plan_isr
 *   main             everything else
 * About 34 kB.
 */
#ifndef GVE_QUEUE_H
#define GVE_QUEUE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "base_limits.h"
#include "hal_step.h"
#include "../guards/gve_guards.h"
#include "../speeds/gve_speeds.h"
#include "../../engine/group/group.h"

enum {
    GVE_QUEUE_VECTORS = 128,
    GVE_QUEUE_VECTORS_BESIDE = 2, /* after K: for one at a time */
};

/* A path and what its vectors were entered with. */
struct gve_chain {
    struct group group;
    struct gve_vector *vectors; /* of each place of the ring */
    uint32_t size;
};

/* How a reference run goes. */
enum gve_home_phase {
    GVE_HOME_NONE,
    GVE_HOME_TO_SWITCH,
    GVE_HOME_FROM_SWITCH,
    GVE_HOME_BACK, /* to the place where the switch let go */
};

enum gve_home_result {
    GVE_HOME_RUNS,
    GVE_HOME_DONE,
    GVE_HOME_NOT_FOUND,
    GVE_HOME_STOPPED,
};

/* What W is told. */
struct gve_home_order {
    unsigned axis;
    int32_t way;         /* to the switch at most, with its direction; not 0 */
    uint32_t speed;      /* pulses/s */
    int32_t way_back;    /* from the switch at most, 1 or more */
    uint32_t speed_back; /* pulses/s */
};

struct gve_home {
    struct gve_home_order order;
    _Atomic uint8_t phase; /* enum gve_home_phase; the tick interrupt reads it */
    _Atomic bool reached;  /* the tick interrupt: the switch is as the phase wants it */
    _Atomic bool ended;    /* the tick interrupt: another input has interrupted while it brakes for that */
    int64_t place_steps;   /* where it became so; written before `reached` */
    int64_t begin_steps;   /* where the phase began */
    uint8_t result;        /* enum gve_home_result */
};

/* What K keeps besides the path. */
struct gve_kept {
    bool valid;
    bool inta;
    bool intcom;
    uint8_t cause[2];
    uint64_t pause_ticks; /* before the next start of the path */
};

struct gve_queue {
    struct step_channel channel[UNIT_MOTORS];
    struct gve_guards guards;
    struct gve_modal modal;
    uint32_t factor;                 /* of the X commands */
    uint32_t taken_limit[PATH_AXES]; /* VL as the last X command has given it to the queue */
    struct gve_chain chain[2];       /* the large and the small one */
    _Atomic uint8_t used;            /* which of them */
    struct gve_kept kept;
    struct gve_home home;
    bool inta;
    bool intcom;
    bool halting;                       /* H waits for the axes */
    bool stopping;                      /* a stop by SW6 waits for them */
    uint64_t pause_ticks;               /* before the next start; 0: it goes on */
    uint64_t last_tick;                 /* of the last pulse of all axes; 0: none was made */
    int64_t start_steps[UNIT_MOTORS];   /* positions at the last start */
    int64_t latched_steps[UNIT_MOTORS]; /* positions at the last interrupt that began a stop; tick interrupt */
    uint8_t coupling;                   /* axis that motor 4 follows; 3: its own */
    struct gve_vector vectors[GVE_QUEUE_VECTORS];
    struct gve_vector vectors_beside[GVE_QUEUE_VECTORS_BESIDE];
    struct path_section ring[GVE_QUEUE_VECTORS];
    struct path_section ring_beside[GVE_QUEUE_VECTORS_BESIDE];
};

/* As after a reset: nothing is queued, the axes stand at 0. No pulse may be to come. */
void gve_queue_init(struct gve_queue *queue);

/* ---- states --------------------------------------------------------------------------------------------------- */

/* Something moves, brakes, pauses or waits to go on. A reference run moves from its begin to its end. */
bool gve_queue_runs(const struct gve_queue *queue);

static inline bool gve_queue_inta(const struct gve_queue *queue)
{
    return queue->inta;
}

/* A stop has been asked for, and the axes do not stand yet. */
bool gve_queue_is_stopping(const struct gve_queue *queue);

/* Pulses are being made, or are about to be. */
bool gve_queue_moves(const struct gve_queue *queue);

/* Free places for vectors that join; none after K. */
uint32_t gve_queue_room(const struct gve_queue *queue);

/* ---- vectors --------------------------------------------------------------------------------------------------- */

/* Enters a vector with what holds now, not all 0, at the end of the queue. There must be room, or nothing queued. */
void gve_queue_enter(struct gve_queue *queue, const int32_t steps[PATH_AXES]);

/* Begins what has been entered, if nothing moves and no G is needed: at once or after its pause. */
void gve_queue_begin(struct gve_queue *queue, uint8_t inputs);

/* All queued vectors take the factor and the VL in force; with `last` the last V, too. */
void gve_queue_change(struct gve_queue *queue, uint32_t factor, bool last);

/* ---- stops ----------------------------------------------------------------------------------------------------- */

/* H. True: the axes stand, and INTA and INTCOM are set; else they will be when the axes stand. */
bool gve_queue_halt(struct gve_queue *queue);

/* The same by SW6: without INTCOM, and nothing at rest. */
void gve_queue_stop(struct gve_queue *queue);

/* INTA and INTCOM as SW6 writes them, while the axes stand; what waits goes on if INTA falls. */
void gve_queue_write_flags(struct gve_queue *queue, bool inta, bool intcom, uint8_t inputs);

/* G: INTA, INTCOM and causes are cleared, and what waits goes on. Only with INTA. */
void gve_queue_go(struct gve_queue *queue, uint8_t inputs);

/* D: as G, but what waits is deleted. While the axes stand. */
void gve_queue_delete(struct gve_queue *queue);

/* K, R: keeps queue, causes, INTA and INTCOM and empties them; puts them back. False: something is kept already;
 * nothing is. While the axes stand. */
bool gve_queue_keep(struct gve_queue *queue);
bool gve_queue_restore(struct gve_queue *queue);

/* Pulses end at once. What is queued is of no use any more; gve_queue_init follows when gve_queue_is_quiet. */
void gve_queue_abort(struct gve_queue *queue);
bool gve_queue_is_quiet(const struct gve_queue *queue);

/* ---- reference run --------------------------------------------------------------------------------------------- */

/* Begins a reference run; only at rest. */
void gve_queue_home(struct gve_queue *queue, const struct gve_home_order *order, uint8_t inputs);

/* How it goes; as soon as it is over, INTA and RUN say so, too. */
enum gve_home_result gve_queue_home_result(const struct gve_queue *queue);

/* ---- positions ------------------------------------------------------------------------------------------------- */

/* Positions of all axes at one moment; at the last interrupt that began a stop. A coupled A shows its axis. */
void gve_queue_positions(const struct gve_queue *queue, int64_t steps[UNIT_MOTORS]);
void gve_queue_latched(const struct gve_queue *queue, int64_t steps[UNIT_MOTORS]);

/* While the axes stand. */
void gve_queue_set_position(struct gve_queue *queue, unsigned axis, int64_t steps);

/* Motor 4 makes the pulses of axis 0 to 2, or its own (3). While the axes stand. */
void gve_queue_couple(struct gve_queue *queue, unsigned axis);

/* ---- time ------------------------------------------------------------------------------------------------------ */

/* Feeds the channels, sees the axes stand, begins what waits for nothing. Returns when to call again at the latest. */
uint64_t gve_queue_poll(struct gve_queue *queue, uint8_t inputs);

/* Inputs, as io.h has them, may have changed. True: the plan interrupt is needed. */
bool gve_queue_sense_isr(struct gve_queue *queue, uint8_t inputs);

/* The same in main, after what counts has changed. */
void gve_queue_sense(struct gve_queue *queue, uint8_t inputs);

void gve_queue_plan_isr(struct gve_queue *queue);
unsigned gve_queue_lay_isr(struct gve_queue *queue, unsigned motor, struct hal_step_room *room);

#endif
