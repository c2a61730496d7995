/*
 * A client on the line in real time: over a pseudo-terminal or a TCP port. Virtual time is held back to real time then.
 */
#ifndef TTY_H
#define TTY_H

#include <stdbool.h>
#include <stdint.h>

struct board;

struct tty {
    bool open;
    int listener;     /* of TCP; -1: none */
    int stream;       /* the pseudo-terminal or the connection; -1: none yet */
    int peer;         /* the other end of the pseudo-terminal, held open */
    const char *link; /* that names it */
    uint64_t real_start_ns;
};

/* Opens what the options ask for and says where it listens. False after a complaint. */
bool tty_open(struct board *board);
void tty_close(struct board *board);

/* A byte that the unit has sent. */
void tty_send(struct board *board, uint8_t value);

/* Each millisecond of virtual time: takes in what has come and waits for real time. */
void tty_event(struct board *board, uint64_t cycle);

/* Nanoseconds of real time. */
uint64_t tty_real_ns(void);

#endif
