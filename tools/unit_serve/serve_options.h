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

/* What the help of every `serve` says of the options that all have, and of orders to units with addresses. */
#define SERVE_HELP_OF_ALL                                                                                              \
    "--unpaced         bytes take no time on the line\n"                                                               \
    "--control PORT    takes the lines of standard input by TCP too; 0 takes any free port\n"                          \
    "--address ADDRESS listens there, for others to connect (127.0.0.1: only this machine)\n"                          \
    "--noise N         a bad line: so many bytes of a million come changed, on both ways (0)\n"                        \
    "--loss N          and so many are lost (0)\n"                                                                     \
    "--seed N          others are changed and lost with another one (0)\n"                                             \
    "--json            says where it listens as a JSON object\n"                                                       \
    "--until-eof       ends when standard input does, as it does when the program that writes there ends\n"
#define SERVE_HELP_OF_NODES                                                                                            \
    "Lines on standard input: 3=1 sets input 3, 2.3=1 that of unit 2, ? prints the state of all\n"                     \
    "units. Each is answered by JSON: the state by a line per unit, the others by one line.\n"

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
