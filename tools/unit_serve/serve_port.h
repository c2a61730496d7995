/*
 * A place where others connect: TCP with several clients, or a pty with a link to it. Nothing here ever waits.
 *
 * What a client does not take at once is lost to it and counted: it gets less than all, as on a line with noise.
 */
#ifndef SERVE_PORT_H
#define SERVE_PORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "complain.h"
#include "serve_pty.h"

enum {
    SERVE_CLIENTS_MAX = 16,
    SERVE_NAME_BYTES = 128,
};

struct serve_port {
    int listener;                   /* a descriptor; -1: a pty, or not open */
    int clients[SERVE_CLIENTS_MAX]; /* descriptors; -1: free; the first one may be the pty */
    uint64_t dropped;               /* bytes that clients did not take */
    struct serve_pty pty;           /* if it is one */
    char name[SERVE_NAME_BYTES];    /* for clients: socket://ADDRESS:PORT or the link */
};

/* Not open: closing and writing do nothing. */
void serve_port_init(struct serve_port *port);

/* Listens; `option` is the name that complaints give to the port, 0 takes any free one. EXIT_DONE, or EXIT_USAGE or
 * EXIT_CONNECTION after a complaint. */
enum exit_status serve_port_listen(struct serve_port *port, const char *option, const char *address, uint16_t number);

/* Makes a pty and the link to it, as serve_pty_open does. EXIT_DONE, or another after a complaint. */
enum exit_status serve_port_open_pty(struct serve_port *port, const char *link);

/* Takes a new client in if there is one; those above the limit are sent away. Its index; -1: none. */
int serve_port_accept(struct serve_port *port);

/* Reads what a client has sent, at most `room` bytes. 0: nothing now, or the client has gone. */
size_t serve_port_read(struct serve_port *port, unsigned client, void *bytes, size_t room);

/* Gives bytes to one client, to all. */
void serve_port_write(struct serve_port *port, unsigned client, const void *bytes, size_t length);
void serve_port_write_all(struct serve_port *port, const void *bytes, size_t length);

unsigned serve_port_clients(const struct serve_port *port);

/* Removes the link, if it still leads here, and lets everybody go. */
void serve_port_close(struct serve_port *port);

#endif
