/*
 * Two connected sockets: how a thread wakes a loop that waits for sockets.
 */
#ifndef SERVE_PAIR_H
#define SERVE_PAIR_H

#include <stdbool.h>

struct serve_pair {
    int reads;
    int writes;
};

/* After socket_start. False: there are none. */
bool serve_pair_make(struct serve_pair *pair);

#endif
