/*
 * The talk with the user: orders come in, answers in JSON go out, a line each; the state has a line per unit.
 */
#ifndef SERVE_TALK_H
#define SERVE_TALK_H

#include <stddef.h>

#include "serve_line.h"
#include "serve_order.h"
#include "serve_port.h"
#include "serve_units.h"

struct serve_talk {
    struct serve_units *units;
    const struct serve_line *line; /* whose clients and losses the state tells */
    struct serve_port *control;
    struct serve_text user;
    struct serve_text clients[SERVE_CLIENTS_MAX];
};

void serve_talk_init(struct serve_talk *talk, struct serve_units *units, const struct serve_line *line,
                     struct serve_port *control);

/* Takes what has come from standard input; answers there. */
void serve_talk_user(struct serve_talk *talk, const char *bytes, size_t count);

/* A client of the control port has come; it has sent something. */
void serve_talk_begin(struct serve_talk *talk, unsigned client);
void serve_talk_client(struct serve_talk *talk, unsigned client, const char *bytes, size_t count);

#endif
