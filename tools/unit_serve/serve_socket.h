/*
 * Sockets, waiting for them, and standard input, of whatever system this is: posix/ or windows/.
 *
 * Descriptors are int, -1 is none; what fails leaves an errno of POSIX. Nothing but socket_wait ever waits.
 */
#ifndef SERVE_SOCKET_H
#define SERVE_SOCKET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    SOCKET_SLOTS_MAX = 64
};

/* Something that socket_wait looks at. */
struct socket_slot {
    int fd;     /* -1: not looked at */
    bool ready; /* there is something to read, or to accept, or it has ended */
};

/* Makes the process fit for all others. False after a complaint. */
bool socket_start(void);

/* Listens at an address of four numbers and a port, which becomes the free one that was found if it is 0. -1: errno;
 * EINVAL: that is no address. */
int socket_listen(const char *address, uint16_t *port, int waiting_max);

/* Takes a client in. -1: there is none. */
int socket_accept(int listener);

/* What has come, at most `room` bytes; 0: the end; -1: errno, EAGAIN if nothing has come. */
ptrdiff_t socket_read(int fd, void *bytes, size_t room);

/* How much was taken; -1: none of it. */
ptrdiff_t socket_write(int fd, const void *bytes, size_t length);

void socket_close(int fd);

/* Standard input as something to wait for and to read; -1: there is none. */
int socket_user(void);

/* Waits until one of at most SOCKET_SLOTS_MAX is ready, so long at most; null: without end. */
void socket_wait(struct socket_slot *slots, unsigned count, const uint64_t *rest_ns);

#endif
