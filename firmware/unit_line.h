/*
 * The unit on its line: from the backend's bytes through the link to the messages, and back. Main only.
 */
#ifndef UNIT_LINE_H
#define UNIT_LINE_H

#include <stdint.h>

struct unit;

/* Begins to listen, at the address that the switch shows. The link has the unit's answer buffer from now on. */
void unit_line_start(struct unit *unit);

/* Takes what has come in up to the end of one request, executes it, and sends what is to be sent. Returns when to call
 * again at the latest: now if more may have come in, TICK_NEVER if only the backend brings more. */
uint64_t unit_line_poll(struct unit *unit);

#endif
