/*
 * The unit: all stages put together for four motors. A backend and a main loop are all it needs.
 *
 * Main calls rkm04_init, rkm04_start and then rkm04_poll for ever, which serves the line too. Who has messages without
 * a line calls rkm04_message. The backend calls the interrupt entries that rkm04_start hands to it. About 57 kB.
 */
#ifndef RKM04_H
#define RKM04_H

#include <stdbool.h>
#include <stdint.h>

#include "base_limits.h"
#include "hal_run.h"
#include "../engine/axis/axis.h"
#include "../io/io.h"
#include "../store/store.h"
#include "interpreter/interpreter.h"
#include "messages/messages.h"
#include "rkm04_line.h"

/* Version and date of the software, as message 1 tells them. */
#define RKM04_VERSION "01.01,22.11.2026"

/* What the LED of a motor shows. */
struct rkm04_led {
    uint64_t edge_tick; /* while blinking: when it changes next */
    bool on;
    bool blinking;
};

struct rkm04 {
    struct io io;
    struct interpreter_shared shared;
    struct axis axis[UNIT_MOTORS];
    struct interpreter interpreter[UNIT_MOTORS];
    struct store store;
    struct messages messages;
    struct hal_client client;
    struct rkm04_led led[UNIT_MOTORS];
    struct rkm04_line line;
};

/* Start values; nothing moves. */
void rkm04_init(struct rkm04 *unit);

/* Starts the interrupts, the line and, unless the board comes from a watchdog or a fault, the stored programs. A
 * program that cannot be trusted is not run: its motor has failed. */
void rkm04_start(struct rkm04 *unit);

/* One pass of the main loop: at most one request of the line, and bounded work for each motor, all at the same now.
 * Returns the tick at which to call again at the latest: now or before if there is more to do at once, TICK_NEVER if
 * only an interrupt, the line or a message brings more. */
uint64_t rkm04_poll(struct rkm04 *unit);

/* Answers one message that did not come by the line; returns the answer's length, 0 for none. */
uint32_t rkm04_message(struct rkm04 *unit, const uint8_t *request, uint32_t length,
                       uint8_t answer[MESSAGES_ANSWER_BYTES_MAX]);

/* Whether nothing happens until a message comes, on all motors. */
bool rkm04_is_idle(const struct rkm04 *unit);

#endif
