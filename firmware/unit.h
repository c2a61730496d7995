/*
 * The unit: all stages put together for four motors. A backend and a main loop are all it needs.
 *
 * Main calls unit_init, unit_start and then unit_poll for ever, which serves the line too. Who has messages without a
 * line calls unit_message. The backend calls the interrupt entries that unit_start hands to it. About 57 kB.
 */
#ifndef UNIT_H
#define UNIT_H

#include <stdbool.h>
#include <stdint.h>

#include "base_limits.h"
#include "hal_run.h"
#include "interpreter.h"
#include "io.h"
#include "link.h"
#include "mover.h"
#include "protocol.h"
#include "store.h"

/* Version and date of the software, as message 1 tells them. */
#define UNIT_VERSION "01.00,21.11.2026"

/* What the LED of a motor shows. */
struct unit_led {
    uint64_t edge_tick; /* while blinking: when it changes next */
    bool on;
    bool blinking;
};

struct unit {
    struct io io;
    struct mover mover[UNIT_MOTORS];
    struct interpreter interpreter[UNIT_MOTORS];
    struct store store;
    struct protocol protocol;
    struct hal_client client;
    struct unit_led led[UNIT_MOTORS];
    struct link link;
    uint64_t polled_tick;                      /* the now of the last pass */
    uint8_t answer[PROTOCOL_ANSWER_BYTES_MAX]; /* to the last request of the line; at the start, before there is one, a
                                                  stored program on its way into program memory */
};

/* Start values; nothing moves. */
void unit_init(struct unit *unit);

/* Starts the interrupts, the line and, unless the board comes from a watchdog or a fault, the stored programs. A
 * program that cannot be trusted is not run: its motor has failed. */
void unit_start(struct unit *unit);

/* One pass of the main loop: at most one request of the line, and bounded work for each motor, all at the same now.
 * Returns the tick at which to call again at the latest: now or before if there is more to do at once, TICK_NEVER if
 * only an interrupt, the line or a message brings more. */
uint64_t unit_poll(struct unit *unit);

/* Answers one message that did not come by the line; returns the answer's length, 0 for none. */
uint32_t unit_message(struct unit *unit, const uint8_t *request, uint32_t length,
                      uint8_t answer[PROTOCOL_ANSWER_BYTES_MAX]);

/* Whether nothing happens until a message comes, on all motors. */
bool unit_is_idle(const struct unit *unit);

#endif
