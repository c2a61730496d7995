/*
 * Why a motion ends before its end. The engine owns the list; a unit calls them as its language does, and the trace
 * shows the unit's words.
 */
#ifndef AXIS_CAUSE_H
#define AXIS_CAUSE_H

enum axis_cause {
    AXIS_CAUSE_NONE,    /* it does not */
    AXIS_CAUSE_PAUSE,   /* to go on later: axis_go_on */
    AXIS_CAUSE_HIGH,    /* an input is 1 (axis_guards.stop_high) */
    AXIS_CAUSE_LOW,     /* an input is 0 (axis_guards.stop_low) */
    AXIS_CAUSE_ABORT,   /* an input is 1 that ends more than this motion (axis_guards.abort_high) */
    AXIS_CAUSE_COMMAND, /* its owner has done with it */
    AXIS_CAUSE_LIMIT,   /* the input that a limit run looks for is 1 (axis_guards.halt_high): at once, without a ramp */
    AXIS_CAUSE_FAULT,   /* an error of the owner */
    AXIS_CAUSES,
};

#endif
