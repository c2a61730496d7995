/*
 * The seam to the line: a half-duplex RS-485 bus at 19 200 Bd, 8N1, and the switch that gives the unit its address.
 *
 * The backend keeps received bytes in a ring with the tick of their end, drives the bus as long as there are bytes to
 * send, and lets it go within one character time after the last one. It does not hear itself. Main only.
 */
#ifndef HAL_LINE_H
#define HAL_LINE_H

#include <stdbool.h>
#include <stdint.h>

struct hal_line_byte {
    uint64_t tick; /* the unit's time at which the byte was complete */
    uint8_t value;
    bool broken; /* a framing or noise error in this byte, or bytes after it were lost in an overrun */
};

/* Takes the oldest received byte; false if there is none. */
bool hal_line_read(struct hal_line_byte *byte);

/* Gives a byte to be sent; false if there is no room now: then main gets a pass when there is. */
bool hal_line_write(uint8_t byte);

/* Whether all that was given has been sent and the bus is let go. */
bool hal_line_is_idle(void);

/* The unit's address, 1 to 16, as switch S1 says: 1 + S1-1 + 2*S1-2 + 4*S1-3 + 8*S1-4. Read once at start. */
uint8_t hal_line_node(void);

#endif
