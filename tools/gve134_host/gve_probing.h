/*
 * Probing: what a host does where a vector file says ;@probe, after an L that the tool sensor is to end.
 *
 * Before that L it asks F until the axes stand, and P4: a sensor that is touched there has not been probed. After it
 * it asks F again. If the sensor has stopped the axes it is disabled, the rest of the vector is dropped and the axes
 * that it moves go back to where it was touched, PL less P4; else there is nothing to go on with. Comes in: answers.
 * Goes out: the text of one command after the other.
 */
#ifndef GVE_PROBING_H
#define GVE_PROBING_H

#include <stdbool.h>
#include <stdint.h>

enum {
    GVE_PROBING_AXES = 4,
    GVE_PROBING_TEXT_BYTES = 64,
};

enum gve_probing_phase {
    GVE_PROBING_NONE,
    GVE_PROBING_RESTS,  /* before the L: until the axes stand */
    GVE_PROBING_BEGINS, /* where it begins */
    GVE_PROBING_MOVES,  /* towards the sensor */
    GVE_PROBING_CAUSE,  /* whether a reference switch has stopped the axes */
    GVE_PROBING_LATCHED,
    GVE_PROBING_HERE,
    GVE_PROBING_OFF, /* the sensor is being disabled */
    GVE_PROBING_DROPS,
    GVE_PROBING_BACK,
    GVE_PROBING_STANDS,
};

enum gve_probing_result {
    GVE_PROBING_SENDS, /* the next command is in `text` */
    GVE_PROBING_ASKS,  /* the same again, a little later */
    GVE_PROBING_READY, /* the L may be sent */
    GVE_PROBING_DONE,  /* the axes are where it was touched */
    GVE_PROBING_FAILS, /* why is in `reason` */
};

struct gve_probing {
    enum gve_probing_phase phase;
    bool moves[GVE_PROBING_AXES];    /* the axes of the L; a coupled A goes along by itself */
    int64_t begin[GVE_PROBING_AXES]; /* pulses */
    int64_t latched[GVE_PROBING_AXES];
    int64_t here[GVE_PROBING_AXES];
    const char *reason; /* as tools/rkm04_tools/gve134/probing.py has it; null: no answer to what was asked */
    char text[GVE_PROBING_TEXT_BYTES]; /* with a 0 at its end */
};

/* Begins before the L, which has this text, and after it: the first command is in `text`. */
void gve_probing_approach(struct gve_probing *probing, const uint8_t *line, uint32_t length);
void gve_probing_begin(struct gve_probing *probing);

/* Takes the answer to `text`, from its digit on, which says that it was done. What ends it sets the phase to NONE. */
enum gve_probing_result gve_probing_take(struct gve_probing *probing, const char *answer, uint32_t length);

#endif
