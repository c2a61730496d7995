/*
 * Get Status (messages.md, "200 Get Status"): what the unit is like now, in one answer of fixed layout.
 *
 * Comes in: what interpreters and board say of themselves. Goes out: a struct, and the bytes of the answer. Main
 * only.
 */
#ifndef MESSAGES_STATUS_H
#define MESSAGES_STATUS_H

#include <stdint.h>

#include "base_limits.h"
#include "base_text.h"
#include "../interpreter/interpreter_status.h"

enum {
    MESSAGES_STATUS_LAYOUT = 2, /* a later layout has these bytes too, and more after them */
    MESSAGES_LINE_COUNTS = 12,  /* counters of the link, in the order of its LINK_COUNTS */
};

/* Bits of `switches`. X(NAME, bit) */
#define MESSAGES_STATUS_SWITCHES(X)                                                                                    \
    X(NO_CRYSTAL, 0)  /* no motion, as step times would be wrong */                                                    \
    X(NOT_STARTED, 1) /* after a watchdog or a fault the stored programs have not been started */                      \
    X(LOCKED, 2)      /* T40 */                                                                                        \
    X(SIMULATING, 3)  /* T41 */                                                                                        \
    X(NO_STORE, 4)    /* the part is too small for stored programs */                                                  \
    X(UNTIMED, 5)     /* an interrupt makes the edges of STEP, not a timer */

enum {
#define X(name, bit) MESSAGES_STATUS_##name = 1 << (bit),
    MESSAGES_STATUS_SWITCHES(X)
#undef X
};

struct messages_status {
    uint8_t inputs;              /* as sampled last; bit 0 is BI1 */
    uint8_t outputs;             /* as programs have set them; bit 0 is BO1 */
    uint8_t cause;               /* enum hal_board_cause */
    uint8_t switches;            /* of the unit */
    uint8_t motors[UNIT_MOTORS]; /* INTERPRETER_STATUS_ */
    uint8_t errors[UNIT_MOTORS]; /* enum interpreter_error; 0: none */
    int64_t positions_steps[UNIT_MOTORS];
    uint32_t late_steps;                        /* since the start; modulo 2^32 */
    uint32_t line_counts[MESSAGES_LINE_COUNTS]; /* since the start; modulo 2^32 */
    uint8_t waits[UNIT_MOTORS];                 /* see INTERPRETER_WAITS_HIGH; 0: for nothing */
};

/* Reads all of it but the counters of the link. */
void messages_status_read(struct messages_status *status, const struct interpreter interpreters[UNIT_MOTORS],
                          const struct interpreter_shared *shared);

/* Puts what follows the message number: the layout and its bytes. */
void messages_status_put(const struct messages_status *status, struct text *answer);

#endif
