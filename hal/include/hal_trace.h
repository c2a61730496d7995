/*
 * The seam for onlookers: what the unit does, event by event. A backend without onlookers does nothing here. Main
 * and tick interrupt.
 *
 * X(NAME, text): the text is what trace files show.
 */
#ifndef HAL_TRACE_H
#define HAL_TRACE_H

#include <stdint.h>

#define HAL_TRACE_EVENTS(X)                                                                                            \
    X(START, "start")     /* a program begins to run; value 0 */                                                       \
    X(MOVE, "move")       /* a move begins; value = steps, signed; 0 for a run without a set end */                    \
    X(DONE, "done")       /* a move has ended; value = steps made, signed */                                           \
    X(STOP, "stop")       /* a motion or program is stopped; value = enum axis_cause */                                \
    X(OUT, "out")         /* an output changes; value = its number, negative when cleared; motor 0 = the unit */       \
    X(VAR, "var")         /* a variable of programs is written; as OUT */                                              \
    X(WAIT, "wait")       /* a wait begins; value = milliseconds, or 0 where its time is not set */                    \
    X(SPEED, "speed")     /* the speed of the move in progress changes; value = steps/s */                             \
    X(ERROR, "error")     /* the program ends with an error; value = its number in the unit's list */                  \
    X(END, "end")         /* the program has nothing left to do; value 0 */                                            \
    X(COMMAND, "command") /* a command of the program begins; value = its place as message 7 counts */

enum hal_trace_event {
#define X(name, text) HAL_TRACE_##name,
    HAL_TRACE_EVENTS(X)
#undef X
};

/* Reports an event of motor 1 to 4 (0: the unit) that happened at `tick` of the unit's time. On a board nobody hears of
 * it, so there a call is nothing: HAL_TRACE_NONE of the build. */
#ifdef HAL_TRACE_NONE
static inline void hal_trace(uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    (void)tick;
    (void)motor;
    (void)event;
    (void)value;
}
#else
void hal_trace(uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value);
#endif

#endif
