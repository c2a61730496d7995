/*
 * The parser: the text of a command in, the command or what is wrong with it out. The only parser of the language.
 *
 * Comes in: what stands between the address and the CR, without a sum. Goes out: opcode and numbers. All rules are in
 * gve_commands.def. Letters may be in either case; a number of any length is read whole and does not overflow. Where
 * several things are wrong, the first of an unknown command, wrong syntax and a parameter out of bounds is told. Pure;
 * may be called from anywhere.
 */
#ifndef GVE_COMMAND_H
#define GVE_COMMAND_H

#include <stdint.h>

#include "gve_table.h"

enum {
    GVE_TEXT_BYTES_MAX = 79, /* of a command: a line without ! and address */
};

struct gve_command {
    uint8_t opcode; /* enum gve_opcode; GVE_OPCODES where it is unknown */
    uint8_t count;  /* of its parameters that were there */
    /* What they are, by their kind in the table; 0 where there is none. A word or a single has its 32 bits here. */
    int32_t numbers[GVE_NUMBERS_MAX];
};

/* What can be wrong. X(NAME, code, text for people) */
#define GVE_FAULTS(X)                                                                                                  \
    X(NONE, DONE, "nothing")                                                                                           \
    X(UNKNOWN, UNKNOWN, "there is no such command")                                                                    \
    X(TOO_LONG, WRONG_SYNTAX, "the line is too long")                                                                  \
    X(MISSING, WRONG_SYNTAX, "a parameter is missing")                                                                 \
    X(SURPLUS, WRONG_SYNTAX, "there is a parameter too many")                                                          \
    X(NO_DECIMAL, WRONG_SYNTAX, "this is no decimal number")                                                           \
    X(NO_AXIS, WRONG_SYNTAX, "this is no axis: X, Y, Z or A")                                                          \
    X(NO_HEX, WRONG_SYNTAX, "this is no hexadecimal number")                                                           \
    X(NO_SINGLE, WRONG_SYNTAX, "this is no number with digits before and after its point")                             \
    X(BOUNDS, OUT_OF_BOUNDS, "the parameter is out of bounds")

enum gve_fault {
#define X(name, code, text) GVE_FAULT_##name,
    GVE_FAULTS(X)
#undef X
    GVE_FAULTS_TOTAL
};

struct gve_reading {
    struct gve_command command; /* with a fault only its opcode counts */
    enum gve_fault fault;
    uint32_t place;     /* with a fault: the offset where it is, `length` where something is missing */
    uint32_t parameter; /* with a fault: of which parameter, from 0 */
};

/* Reads a text of at most GVE_TEXT_BYTES_MAX bytes that came to one of the two addresses. */
struct gve_reading gve_command_read(const uint8_t *text, uint32_t length, enum gve_address address);

/* The code of the answer to a fault, and its text for people. */
enum gve_code gve_fault_code(enum gve_fault fault);
const char *gve_fault_text(enum gve_fault fault);

#endif
