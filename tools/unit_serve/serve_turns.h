/*
 * Who has asked what, where several clients talk to a unit that answers each request once and in order (serve_kind):
 * each hears the answers to what it has sent, and no others. Else one takes an answer for its own that tells of
 * something else.
 *
 * A request is held until it has come whole, so that none comes to stand within one of another client: what is held
 * holds up nobody. A second without a byte of it, and it is forgotten, as it is damage on a line.
 *
 * What is told again must be the client's own: where another one has had the last answer it hears none, and finds out
 * that the unit cannot tell it any more. Where damage swallows requests their turns are forgotten as soon as the unit
 * owes nothing.
 */
#ifndef SERVE_TURNS_H
#define SERVE_TURNS_H

#include <stdbool.h>
#include <stdint.h>

#include "serve_kind.h"
#include "serve_port.h"

enum {
    SERVE_REQUEST_BYTES_MAX = 8192, /* what is longer goes on in pieces */
    SERVE_TURNS_MAX = 4608,         /* more than the line and a unit hold of the shortest */
};

struct serve_held {
    uint8_t bytes[SERVE_REQUEST_BYTES_MAX];
    uint32_t length;
    uint32_t line;  /* its last line begins there */
    uint64_t at_ns; /* when its last byte came */
    bool goes_on;   /* it has lines before that */
    bool has_asked; /* this client, for something that changes what is told again */
};

struct serve_turn {
    int8_t client; /* -1: it has gone */
    uint8_t asks;  /* enum serve_asks */
};

struct serve_turns {
    const struct serve_kind *kind;
    struct serve_held held[SERVE_CLIENTS_MAX];
    struct serve_turn ring[SERVE_TURNS_MAX];
    uint32_t first;
    uint32_t count;
    int to;      /* who has the answer that is under way, or had the last one; -1: nobody */
    int last;    /* who has had the one that would be told again */
    bool inside; /* of an answer */
};

void serve_turns_init(struct serve_turns *turns, const struct serve_kind *kind);

/* A client has come. */
void serve_turns_begin(struct serve_turns *turns, unsigned client);

/* The unit owes nothing: who waits for an answer waits in vain. */
void serve_turns_forget(struct serve_turns *turns);

/* Takes a byte of a client. How many bytes of its `held` are to be put on the line now. */
uint32_t serve_turns_take(struct serve_turns *turns, unsigned client, uint8_t byte, uint64_t now_ns);

/* Takes a byte of the unit, which `resets` or does not. The client that is to hear it; -1: none is. */
int serve_turns_hear(struct serve_turns *turns, uint8_t byte, bool resets);

#endif
