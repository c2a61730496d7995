/*
 * The interpreter of one motor: runs the commands in program memory as soon as they are stored, and never blocks.
 *
 * Comes in: program text that has been checked, and time. Goes out: orders to the mover, levels to io. Each poll runs
 * a bounded number of commands and says when it wants to be called again. Main only. About 6.5 kB, of which program
 * memory has 6.
 */
#ifndef INTERPRETER_H
#define INTERPRETER_H

#include <stdbool.h>
#include <stdint.h>

#include "base_tick.h"
#include "io.h"
#include "motion_order.h"
#include "mover.h"
#include "program_memory.h"
#include "program_parser.h"

enum {
    INTERPRETER_LOOPS_MAX = 8,
    INTERPRETER_CALLS_MAX = 6,
    INTERPRETER_SLICE_COMMANDS = 16, /* commands of one poll */
};

/* How far the program clock may fall behind and still be the start of a move or a wait: a start this far in the past is
 * as exact as one to come, since the first pulse of a move follows its start by 496 us at least (S2000 A60000). */
#define INTERPRETER_CLOCK_SLACK_TICKS (UINT64_C(200) * TICKS_PER_US)

/* Why a program has ended with an error. X(NAME, text) */
#define INTERPRETER_ERRORS(X)                                                                                          \
    X(NONE, "")                                                                                                        \
    X(NO_LABEL, "label not found")                                                                                     \
    X(LOOP_END, "E without L")                                                                                         \
    X(LOOP_DEPTH, "more than 8 nested loops")                                                                          \
    X(CALL_DEPTH, "more than 6 nested calls")                                                                          \
    X(RETURN, ". without a call")                                                                                      \
    X(SECTIONS, "more than 10 sections")                                                                               \
    X(DIRECTION, "change of direction inside a compound move")                                                         \
    X(NO_STEPS, "Y without F or B")                                                                                    \
    X(STORED_PROGRAM, "the stored program is damaged")                                                                 \
    X(NO_CRYSTAL, "no motion without the crystal")

enum interpreter_error {
#define X(name, text) INTERPRETER_ERROR_##name,
    INTERPRETER_ERRORS(X)
#undef X
};

enum interpreter_state {
    INTERPRETER_RUNNING,    /* commands may be run now */
    INTERPRETER_IDLE,       /* all that is stored has been run */
    INTERPRETER_HELD,       /* at `[`, until `]` is stored */
    INTERPRETER_MOVING,     /* until the mover has ended its move */
    INTERPRETER_WAIT_TIME,  /* until the program clock */
    INTERPRETER_WAIT_LEVEL, /* until an input or variable has its level */
    INTERPRETER_STOPPED,    /* by K, until C75 */
    INTERPRETER_RESETTING,  /* by `\`, until the motor stands */
    INTERPRETER_ENDED,      /* by X, until `\` */
    INTERPRETER_FAILED,     /* by an error, until `\` */
};

struct interpreter_loop {
    uint32_t body; /* ordinal of the first command of the body */
    uint16_t left; /* passes still to run, this one included */
    uint8_t calls; /* the depth of calls at which it was begun: the `.` from there closes it */
};

struct interpreter {
    struct program_memory memory;
    struct mover *mover;
    struct io *io;
    uint64_t clock;        /* the program clock: the tick at which the next move begins, unless it is later already */
    uint32_t next;         /* ordinal of the command to be run next */
    uint32_t place;        /* message 7: ordinal, from 1, of the command being or last run; 0: none since reset */
    uint64_t release_tick; /* when the youngest `]` came: what it releases does not begin before */
    uint8_t state;         /* enum interpreter_state */
    uint8_t resume_state;  /* while STOPPED: the state to go on with */
    bool resuming;         /* while STOPPED: C75 has come, the motor has yet to stand */
    bool under_way;        /* a move has been begun and its end has not been seen yet, in any state */
    uint8_t error;         /* enum interpreter_error */
    uint8_t motor;         /* 0 to 3 */

    /* What the commands have set up. */
    uint32_t start_speed;  /* S, steps/s */
    uint32_t speed;        /* V, steps/s */
    uint32_t acceleration; /* A, steps/s^2 */
    uint32_t steps;        /* F or B; 0: none yet */
    bool backward;
    struct motion_order compound; /* sections appended by Y */
    bool compound_backward;       /* its direction, fixed by the first Y */
    bool compound_reversed;       /* D has turned it round since */
    bool compound_done;           /* R has run it: the next Y begins a new one, the next F or B forgets it */
    uint8_t mark_outputs;         /* T51-T58: bit 0 is output 1 */
    uint8_t compound_outputs;     /* mark_outputs as they were at the first Y */

    struct interpreter_loop loops[INTERPRETER_LOOPS_MAX];
    uint32_t calls[INTERPRETER_CALLS_MAX]; /* ordinals to return to */
    uint8_t loop_depth;
    uint8_t call_depth;

    /* Guards: masks, bit 0 is input 1. */
    uint8_t guard_high; /* M */
    uint8_t guard_low;  /* N */
    uint8_t total_stop; /* X */

    /* What WAIT_LEVEL waits for. */
    uint8_t wait_number; /* input 1-8 or variable 80-95 */
    bool wait_level;

    /* The move in progress, and what is left of it or of a wait while STOPPED. */
    struct motion_order order;
    struct mover_guards order_guards;
    bool order_backward;
    uint8_t order_outputs; /* to be set when the last section begins, if still on in mark_outputs; 0 when they have */
    uint64_t wait_left;    /* ticks */
};

/* Start values, empty memory; `mover` and `io` must outlive it. */
void interpreter_init(struct interpreter *interpreter, unsigned motor, struct mover *mover, struct io *io);

/* Takes a text that program_check has found good, with what it said, as one Set Command message: stores its commands,
 * or acts at once on K, C75 or V alone. True if the memory has overflowed since the last `\` of the text (flag 3). The
 * commands may run from `now_ticks` on. */
bool interpreter_take(struct interpreter *interpreter, const uint8_t *text, uint32_t length,
                      const struct program_summary *summary, uint64_t now_ticks);

/* Gives a program to an interpreter that has just been initialised; K and C75 in it do nothing. The text is read once,
 * so it need not have been checked. False: it has an error, and no command of it is kept. */
bool interpreter_load(struct interpreter *interpreter, const uint8_t *text, uint32_t length, uint64_t now_ticks);

/* Ends the program with an error, as if one of its commands had caused it. */
void interpreter_fail(struct interpreter *interpreter, enum interpreter_error error, uint64_t now_ticks);

/* Runs what can be run. Returns the tick at which to call again at the latest: `now_ticks` if there is more to run at
 * once, TICK_NEVER if only a message, an input, a variable or the end of the move can change anything. */
uint64_t interpreter_poll(struct interpreter *interpreter, uint64_t now_ticks);

/* Whether nothing happens until a message comes: not moving, and idle, held, stopped, ended or failed. */
bool interpreter_is_idle(const struct interpreter *interpreter);

/* The name of an error, for people. */
const char *interpreter_error_text(enum interpreter_error error);

#endif
