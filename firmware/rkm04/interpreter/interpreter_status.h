/*
 * What an interpreter is doing, for those who only ask: messages and LEDs. Main only.
 *
 * Comes in: nothing. Goes out: numbers as messages.md tells them ("200 Get Status", "7 Get Progress").
 */
#ifndef INTERPRETER_STATUS_H
#define INTERPRETER_STATUS_H

#include <stdbool.h>
#include <stdint.h>

#include "interpreter.h"

/* The bits of a status. X(NAME, bit) */
#define INTERPRETER_STATUS_BITS(X)                                                                                     \
    X(MOVING, 0)    /* a move is in progress */                                                                        \
    X(RUNNING, 1)   /* the program is being run: it moves, waits, or has a command to run */                           \
    X(WAITING, 2)   /* and waits: for a time, a level, or `]` */                                                       \
    X(STOPPED, 3)   /* by K, until C75 */                                                                              \
    X(FAILED, 4)    /* by the error, until `\` */                                                                      \
    X(ENDED, 5)     /* by X, until `\` */                                                                              \
    X(SIMULATED, 6) /* STEP and DIR are disconnected (T41) */

enum {
#define X(name, bit) INTERPRETER_STATUS_##name = 1 << (bit),
    INTERPRETER_STATUS_BITS(X)
#undef X
};

/* What a program waits for: the number of an input or variable, with the level in bit 7, or one of these. */
enum {
    INTERPRETER_WAITS_HIGH = 0x80,
    INTERPRETER_WAITS_TIME = 96,
    INTERPRETER_WAITS_RELEASE = 97, /* `]` */
};

struct interpreter_status {
    uint8_t bits;  /* INTERPRETER_STATUS_ */
    uint8_t error; /* enum interpreter_error; 0: none */
    uint8_t waits; /* see INTERPRETER_WAITS_HIGH; 0: for nothing */
};

struct interpreter_status interpreter_status(const struct interpreter *interpreter);

struct interpreter_progress {
    uint64_t steps;   /* made in the move in progress; 0 while there is none */
    uint32_t command; /* ordinal, from 1, of the command being or last run; 0: none since the reset */
};

struct interpreter_progress interpreter_progress(const struct interpreter *interpreter);

/* Whether an error has ended the program; until `\`. */
bool interpreter_has_failed(const struct interpreter *interpreter);

/* The absolute position of the motor. */
int64_t interpreter_position_steps(const struct interpreter *interpreter);

/* The break points of the move in progress; 0 of them while there is none. */
unsigned interpreter_corners(const struct interpreter *interpreter, struct motion_corner corners[MOTION_CORNERS_MAX]);

/* Writes all stored commands in canonical form and returns the length; `capacity` as in program_memory_list. */
uint32_t interpreter_list(const struct interpreter *interpreter, uint8_t *text, uint32_t capacity);

#endif
