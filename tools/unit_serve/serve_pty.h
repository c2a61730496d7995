/*
 * A pty that passes every byte as it is, and the link to it, where the system has such: posix/ or windows/.
 */
#ifndef SERVE_PTY_H
#define SERVE_PTY_H

#include "complain.h"

enum {
    SERVE_DEVICE_BYTES = 128
};

struct serve_pty {
    int terminal;                    /* its other side, so that it stays open; -1: none */
    const char *link;                /* to it; null: none */
    char device[SERVE_DEVICE_BYTES]; /* what the link leads to */
};

void serve_pty_init(struct serve_pty *pty);

/* Makes a pty and the link to it; `fd` is our side, which the caller closes, or -1. A link that leads to a pty which is
 * no more is replaced, anything else of this name is not. EXIT_DONE, or another after a complaint. */
enum exit_status serve_pty_open(struct serve_pty *pty, const char *link, int *fd);

/* Removes the link, if it still leads here, and closes the other side. */
void serve_pty_close(struct serve_pty *pty);

#endif
