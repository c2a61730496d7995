/*
 * Probing: what a host does where a vector file says ;@probe, after a vector that the tool sensor was to end.
 *
 * It asks F until the axes stand. If the sensor has stopped them it is disabled, the rest of the vector is dropped and
 * the axes go back to where it was touched, PL less P4; else there is nothing to go on with. Comes in: answers. Goes
 * out: the text of one command after the other.
 */
#ifndef GVE_PROBING_H
#define GVE_PROBING_H

#include <stdint.h>

enum {
    GVE_PROBING_AXES = 4,
    GVE_PROBING_TEXT_BYTES = 64,
};

enum gve_probing_phase {
    GVE_PROBING_NONE,
    GVE_PROBING_MOVES, /* towards the sensor */
    GVE_PROBING_OFF,   /* the sensor is being disabled */
    GVE_PROBING_LATCHED,
    GVE_PROBING_HERE,
    GVE_PROBING_DROPS,
    GVE_PROBING_BACK,
    GVE_PROBING_STANDS,
};

enum gve_probing_result {
    GVE_PROBING_SENDS,     /* the next command is in `text` */
    GVE_PROBING_ASKS,      /* the same again, a little later */
    GVE_PROBING_DONE,      /* the axes are where it was touched */
    GVE_PROBING_UNTOUCHED, /* nothing was, or H has stopped the axes */
    GVE_PROBING_WRONG,     /* this is no answer to what was asked */
};

struct gve_probing {
    enum gve_probing_phase phase;
    int64_t latched[GVE_PROBING_AXES]; /* pulses */
    int64_t here[GVE_PROBING_AXES];
    char text[GVE_PROBING_TEXT_BYTES]; /* with a 0 at its end */
};

/* Begins: the first command is in `text`. */
void gve_probing_begin(struct gve_probing *probing);

/* Takes the answer to `text`, from its digit on, which says that it was done. What ends it sets the phase to NONE. */
enum gve_probing_result gve_probing_take(struct gve_probing *probing, const char *answer, uint32_t length);

#endif
