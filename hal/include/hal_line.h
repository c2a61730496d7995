/*
 * The seam to the line, and the switch that gives the unit its address where a board has one. Duplex is fixed when an
 * image is built, and so are rate and format, 8N1, unless the unit sets others: IMAGE_LINE_BD and
 * IMAGE_LINE_FULL_DUPLEX of its image.h.
 *
 * The backend keeps received bytes in a ring with the tick of their end. Half duplex, an RS-485 bus: it drives the bus
 * as long as there are bytes to send, lets it go within one character time after the last one, and does not hear
 * itself. Full duplex: it hears while it sends, whatever comes, and the line is never let go. Main only.
 */
#ifndef HAL_LINE_H
#define HAL_LINE_H

#include <stdbool.h>
#include <stdint.h>

struct hal_line_byte {
    uint64_t tick; /* the unit's time at which the byte was complete; full duplex: up to 2 ms later */
    uint8_t value;
    bool broken; /* a parity, framing or noise error in this byte, or bytes after it were lost in an overrun */
};

enum {
    HAL_LINE_RUN_MAX = 32,
};

/* Bytes that came within a millisecond. */
struct hal_line_run {
    uint64_t tick; /* of the last one, as above */
    uint32_t count;
    uint8_t bytes[HAL_LINE_RUN_MAX];
    bool broken; /* it is one, and as above */
};

/* Parity, none, even or odd, and stop bits. */
enum hal_line_format {
    HAL_LINE_8E1,
    HAL_LINE_8O1,
    HAL_LINE_8N1,
    HAL_LINE_8N2,
};

/* Another rate, 9600 to 115 200 Bd, and format. Half duplex, before hal_run_start. */
void hal_line_set(uint32_t rate_bd, enum hal_line_format format);

/* Takes the oldest received byte; false if there is none. */
bool hal_line_read(struct hal_line_byte *byte);

/* Takes the oldest received bytes as long as they came together, none after one that is `last`; or one that is broken.
 * False: there is none, or what there is came after the bytes of the call before it. */
bool hal_line_read_run(struct hal_line_run *run, uint8_t last);

/* Whether there is nothing to read, and no start bit has come since the last byte either: what has been read is all so
 * far. Half duplex. Always false where the backend cannot tell. */
bool hal_line_is_quiet(void);

/* Gives a byte to be sent; false if there is no room now: then main gets a pass when there is. */
bool hal_line_write(uint8_t byte);

/* Whether all that was given has been sent and, half duplex, the bus is let go. */
bool hal_line_is_idle(void);

/* The address, 1 to 16, as switch S1 says: 1 + S1-1 + 2*S1-2 + 4*S1-3 + 8*S1-4; 1 on a board without it. Read once at
 * start, by units that have their address from it. */
uint8_t hal_line_node(void);

#endif
