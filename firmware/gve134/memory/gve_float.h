/*
 * A single of IEEE 754 as its 32 bits, from decimal text and to it, in whole numbers alone: the firmware has no
 * floating point. Both ways are rounded once, to the nearest, ties to even. Pure; may be called from anywhere.
 *
 *   text in:   [-] digits [. digits] [E [+ or -] digits], E in either case; at most GVE_FLOAT_READ_BYTES_MAX bytes
 *   text out:  as C's "%.9G", so that reading it gives the same bits: 0.100000001, 1.50000005E-07, -INF, NAN
 */
#ifndef GVE_FLOAT_H
#define GVE_FLOAT_H

#include <stdint.h>

#include "base_text.h"

enum {
    GVE_FLOAT_READ_BYTES_MAX = 80,
    GVE_FLOAT_PUT_BYTES_MAX = 15, /* -1.17549435E-38 */
};

enum gve_float_status {
    GVE_FLOAT_OK,
    GVE_FLOAT_NO_NUMBER, /* the text is not as above */
    GVE_FLOAT_TOO_LARGE, /* it would become infinite */
};

/* Reads all of a text. *bits is written where all is well; what is too small becomes a zero with its sign. */
enum gve_float_status gve_float_read(const uint8_t *text, uint32_t length, uint32_t *bits);

/* Puts the text of a single, of whatever bits; all that are no number are NAN. */
void gve_float_put(struct text *text, uint32_t bits);

#endif
