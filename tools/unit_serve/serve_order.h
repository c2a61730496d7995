/*
 * The lines by which a user of `serve` sets inputs and asks for the state, on standard input and on the control port:
 *
 *     3=1      input 3 becomes 1, of the only unit
 *     2.3=1    the same of unit 2, if units have addresses
 *     ?        the state of every unit
 *
 * Blanks around them do no harm; a line without anything says nothing.
 */
#ifndef SERVE_ORDER_H
#define SERVE_ORDER_H

#include <stdbool.h>
#include <stdint.h>

#include "serve_kind.h"

enum {
    SERVE_ORDER_BYTES_MAX = 64
};

/* A line on its way in. */
struct serve_text {
    char bytes[SERVE_ORDER_BYTES_MAX];
    uint32_t length; /* SERVE_ORDER_BYTES_MAX: it is too long to be an order */
};

enum serve_order_kind {
    SERVE_ORDER_NOTHING,
    SERVE_ORDER_STATUS,
    SERVE_ORDER_INPUT,
    SERVE_ORDER_WRONG,
};

struct serve_order {
    enum serve_order_kind kind;
    uint8_t node;  /* 0: none is named */
    uint8_t input; /* 1 to 8 */
    bool level;
};

/* Takes a byte. True: it was the end of a line; the text then holds it and is to be cleared. */
bool serve_text_take(struct serve_text *text, char byte);

void serve_text_clear(struct serve_text *text);

/* What a line says. */
struct serve_order serve_order_read(const struct serve_text *text, const struct serve_kind *kind);

#endif
