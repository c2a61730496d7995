/*
 * A client on the line in real time: over a pseudo-terminal or a TCP port. Virtual time is held back to real time then.
 */
#ifndef TTY_H
#define TTY_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "rs485.h"

struct tty {
    struct clock *clock;
    struct rs485 *line;
    bool open;
    int listener;     /* of TCP; -1: none */
    int stream;       /* the pseudo-terminal or the connection; -1: none yet */
    int peer;         /* the other end of the pseudo-terminal, held open */
    const char *link; /* that names it */
    uint64_t real_start_ns;
};

void tty_init(struct tty *tty, struct clock *clock, struct rs485 *line);

/* Opens a pseudo-terminal with this link, or else a TCP port; says where it listens. From then on what comes is taken
 * in each millisecond of virtual time, which waits for real time. False after a complaint. */
bool tty_open_pty(struct tty *tty, const char *link);
bool tty_open_tcp(struct tty *tty, unsigned port);
void tty_close(struct tty *tty);

/* A byte that the unit has sent, for a struct tty. */
void tty_send(void *model, uint8_t value);

/* Nanoseconds of real time. */
uint64_t tty_real_ns(void);

#endif
