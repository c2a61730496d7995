/*
 * The options of `serve`, from the command line.
 */
#ifndef SERVE_OPTIONS_H
#define SERVE_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "arguments.h"

enum {
    SERVE_UNITS_MAX = 16, /* as many as there are addresses */
    SERVE_NODE_MAX = 16,
    SERVE_TCP_PORT = 5000, /* where it listens unless told otherwise */
};

struct serve_options {
    const char *pty;      /* the name of the link to a pty; null: TCP */
    const char *address;  /* to listen on */
    const char *flash;    /* null: programs are kept until the end only */
    uint64_t baud;        /* the rate of the line, where it can be chosen; 0: as it is delivered */
    uint64_t noise;       /* bytes of a million that the line changes, each way */
    uint64_t loss;        /* and that it loses */
    uint64_t seed;        /* of what is changed and lost */
    uint32_t milli_speed; /* thousandths of real time; 0: as fast as possible */
    uint16_t tcp_port;    /* 0: any free one */
    uint16_t control_port;
    bool control; /* whether control_port was asked for */
    bool tcp;
    bool unpaced;
    bool json;
    bool until_eof; /* ends when standard input does */
    uint8_t units;
    uint8_t nodes[SERVE_UNITS_MAX];
};

/* The option of units that have addresses: --node N. */
argument_reader serve_options_read_node;

/* Reads what follows `serve`; `own` is the option that a kind of unit has besides those of all. EXIT_DONE, or
 * EXIT_USAGE after a complaint. */
enum exit_status serve_options_read(struct serve_options *options, const struct argument *own, int count,
                                    char *const arguments[]);

#endif
