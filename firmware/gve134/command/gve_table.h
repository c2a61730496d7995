/*
 * The table of the commands, gve_commands.def, as data that the parser and the tools read. Pure; may be called from
 * anywhere.
 */
#ifndef GVE_TABLE_H
#define GVE_TABLE_H

#include <assert.h>
#include <stdbool.h>
#include <stdint.h>

enum gve_opcode {
#define X(name, text, address, packet, states, least, p1, p2, p3, p4, p5, example, answer) GVE_##name,
#include "gve_commands.def"
#undef X
    GVE_OPCODES
};

enum gve_parameter {
    GVE_PARAMETER_NONE,
#define P(name, form, min, max) GVE_PARAMETER_##name,
#include "gve_commands.def"
#undef P
    GVE_PARAMETERS
};

/* How a parameter is written; gve_commands.def says what each is. */
enum gve_form {
    GVE_FORM_DECIMAL,
    GVE_FORM_NONZERO,
    GVE_FORM_AXIS,
    GVE_FORM_HEX,
    GVE_FORM_HEX_WORD,
    GVE_FORM_SINGLE,
};

/* Where a command came to; a row may be for both. */
enum gve_address {
    GVE_ADDRESS_INTERPOLATOR = 1,
    GVE_ADDRESS_SPINDLE = 2,
    GVE_ADDRESS_BOTH = 3,
};

/* What a command is in a packet. */
enum gve_packet {
    GVE_PACKET_OTHER, /* not executed */
    GVE_PACKET_TAKEN,
    GVE_PACKET_ENDS,
    GVE_PACKET_BEGINS,
};

/* What an answer begins with. */
enum gve_code {
    GVE_DONE = 0,
    GVE_NO_ROOM = 1,
    GVE_DAMAGED = 2,
    GVE_UNKNOWN = 3,
    GVE_WRONG_SYNTAX = 4,
    GVE_OUT_OF_BOUNDS = 5,
    GVE_NOTHING_LEFT = 6,
    GVE_NOT_NOW = 7,
    GVE_INTA = 8, /* set in it */
};

/* The states of the axes that refuse commands, by INTA and RUN; and LOCKED, in which no motion is made after a fault.
 */
enum gve_state {
    GVE_STATE_REST,    /* 0 0 */
    GVE_STATE_WORK,    /* 0 1 */
    GVE_STATE_ENDED,   /* 1 0 */
    GVE_STATE_WAITING, /* 1 1 */
    GVE_STATE_LOCKED,
    GVE_STATES
};

enum {
    GVE_NUMBERS_MAX = 5, /* parameters of a command */
};

struct gve_kind {
    int64_t min;
    int64_t max;
    uint8_t form; /* enum gve_form */
};

struct gve_row {
    const char *text;                    /* what the command begins with, in upper case */
    const char *states;                  /* a code for each enum gve_state */
    uint8_t parameters[GVE_NUMBERS_MAX]; /* enum gve_parameter; after the last one NONE */
    uint8_t least;                       /* parameters that it must have */
    uint8_t most;                        /* and may have */
    uint8_t address;                     /* enum gve_address */
    uint8_t packet;                      /* enum gve_packet */
};

/* The opcodes from `first` to the one before `past`. */
struct gve_opcodes {
    uint8_t first;
    uint8_t past;
};

/* Among which all commands are that begin with a character, in upper case; others may be there too. */
struct gve_opcodes gve_opcodes_of(uint8_t character);

/* The row of an opcode below GVE_OPCODES; the kind of a parameter below GVE_PARAMETERS. */
extern const struct gve_row gve_rows[GVE_OPCODES];
extern const struct gve_kind gve_kinds[GVE_PARAMETERS];

static inline const struct gve_row *gve_row(unsigned opcode)
{
    assert(opcode < (unsigned)GVE_OPCODES);
    return &gve_rows[opcode];
}

static inline const struct gve_kind *gve_kind(unsigned parameter)
{
    assert(parameter < (unsigned)GVE_PARAMETERS);
    return &gve_kinds[parameter];
}

/* What the table has for people and tools; an image that does not ask for it does not hold it. */
struct gve_words {
    const char *name;
    const char *example; /* without ! and address */
    const char *answer;  /* to it; empty: none */
};

/* Of an opcode below GVE_OPCODES; and the name of a parameter below GVE_PARAMETERS. */
const struct gve_words *gve_words(unsigned opcode);
const char *gve_kind_name(unsigned parameter);

/* The code with which a state refuses a command; GVE_DONE: it does not. */
enum gve_code gve_refusal(unsigned opcode, enum gve_state state);

#endif
