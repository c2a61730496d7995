/*
 * Get Status (messages.md, "200 Get Status"): what the unit is like now, in one answer of fixed layout.
 *
 * Comes in: the state of interpreters, movers, io and board. Goes out: a struct, and the bytes of the answer. Main
 * only.
 */
#ifndef PROTOCOL_STATUS_H
#define PROTOCOL_STATUS_H

#include <stdint.h>

#include "base_limits.h"
#include "base_text.h"
#include "interpreter.h"

enum {
    PROTOCOL_STATUS_LAYOUT = 2, /* a later layout has these bytes too, and more after them */
    PROTOCOL_LINE_COUNTS = 12,  /* counters of the link, in the order of its LINK_COUNTS */

    /* What a motor waits for: the number of an input or variable, with the level in bit 7, or one of these. */
    PROTOCOL_WAITS_HIGH = 0x80,
    PROTOCOL_WAITS_TIME = 96,
    PROTOCOL_WAITS_RELEASE = 97, /* `]` */
};

/* Bits of `switches`. X(NAME, bit) */
#define PROTOCOL_STATUS_SWITCHES(X)                                                                                    \
    X(NO_CRYSTAL, 0)  /* no motion, as step times would be wrong */                                                    \
    X(NOT_STARTED, 1) /* behind a watchdog or a fault the stored programs have not been started */                     \
    X(LOCKED, 2)      /* T40 */                                                                                        \
    X(SIMULATING, 3)  /* T41 */                                                                                        \
    X(NO_STORE, 4)    /* the part is too small for stored programs */

/* Bits of `motors`. X(NAME, bit) */
#define PROTOCOL_STATUS_MOTORS(X)                                                                                      \
    X(MOVING, 0)    /* a move is in progress */                                                                        \
    X(RUNNING, 1)   /* the program is being run: it moves, waits, or has a command to run */                           \
    X(WAITING, 2)   /* and waits: for a time, a level, or `]` */                                                       \
    X(STOPPED, 3)   /* by K, until C75 */                                                                              \
    X(FAILED, 4)    /* by the error in `errors`, until `\` */                                                          \
    X(ENDED, 5)     /* by X, until `\` */                                                                              \
    X(SIMULATED, 6) /* STEP and DIR are disconnected (T41) */

enum protocol_status_bit {
#define X(name, bit) PROTOCOL_STATUS_##name = 1 << (bit),
    PROTOCOL_STATUS_SWITCHES(X) PROTOCOL_STATUS_MOTORS(X)
#undef X
};

struct protocol_status {
    uint8_t inputs;   /* as sampled last; bit 0 is BI1 */
    uint8_t outputs;  /* as programs have set them; bit 0 is BO1 */
    uint8_t cause;    /* enum hal_board_cause */
    uint8_t switches; /* of the unit */
    uint8_t motors[UNIT_MOTORS];
    uint8_t errors[UNIT_MOTORS]; /* enum interpreter_error; 0: none */
    int64_t positions_steps[UNIT_MOTORS];
    uint32_t late_steps;                        /* since the start; modulo 2^32 */
    uint32_t line_counts[PROTOCOL_LINE_COUNTS]; /* since the start; modulo 2^32 */
    uint8_t waits[UNIT_MOTORS];                 /* see PROTOCOL_WAITS_HIGH; 0: for nothing */
};

/* Reads all of it but the counters of the link. */
void protocol_status_read(struct protocol_status *status, const struct interpreter interpreters[UNIT_MOTORS]);

/* Puts what follows the message number: the layout and its bytes. */
void protocol_status_put(const struct protocol_status *status, struct text *answer);

#endif
