/*
 * The states of an axis, and what leads from one to another. One trigger, one reason: whatever ends a motion goes
 * through this table, and the first that comes is the one that counts.
 *
 *               BEGIN    REFUSE   STOP      HALT       PLANNED    RESUME   LAST     TAKE
 *   STANDING    MOVING   ENDED    -         -          -          -        -        -
 *   MOVING      -        -        BRAKING   STOPPING   -          -        ENDED    -
 *   BRAKING     -        -        -         -          STOPPING   MOVING   ENDED    -
 *   STOPPING    -        -        -         -          -          MOVING   ENDED    -
 *   ENDED       -        -        -         -          -          -        -        STANDING
 *
 * The states of a group are the same, of all its motors together.
 * Any context but the step interrupt.
 */
#ifndef AXIS_STATE_H
#define AXIS_STATE_H

#include <stdatomic.h>
#include <stdbool.h>

/* In this order: from MOVING to STOPPING pulses may come. */
enum axis_state {
    AXIS_SAME,     /* no state: what the table says of an event that means nothing */
    AXIS_STANDING, /* no motion */
    AXIS_MOVING,   /* as ordered */
    AXIS_BRAKING,  /* a stop has come: the motor brakes at once where it can, and the way down is to be planned */
    AXIS_STOPPING, /* the way down has been planned, or the motor was halted: it comes to rest */
    AXIS_ENDED,    /* the motor stands, and its owner has not seen it yet */
    AXIS_STATES,
};

enum axis_event {
    AXIS_BEGIN,   /* a motion begins */
    AXIS_REFUSE,  /* a motion is to begin, but an input already has a level that it guards against: no step is made */
    AXIS_STOP,    /* stop down the ramp */
    AXIS_HALT,    /* stop at once */
    AXIS_PLANNED, /* the stop has been planned */
    AXIS_RESUME,  /* a stop is taken back; groups only */
    AXIS_LAST,    /* the last pulse has been made */
    AXIS_TAKE,    /* the owner has seen the end */
    AXIS_EVENTS,
};

/* The state after an event; AXIS_SAME where the event means nothing in that state. */
enum axis_state axis_state_next(enum axis_state state, enum axis_event event);

/* Goes from a state, an enum axis_state, to the one that an event leads to. False if the event means nothing now, also
 * because another context was first. */
bool axis_state_enter(_Atomic unsigned *state, enum axis_event event);

#endif
