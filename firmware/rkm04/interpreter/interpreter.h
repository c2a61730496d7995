/*
 * The interpreter of one motor: runs the commands in program memory as soon as they are stored, and never blocks.
 *
 * Comes in: program text that has been checked, and time. Goes out: orders to the axis, levels to what all
 * interpreters share. Each poll runs
 * a bounded number of commands and says when it wants to be called again. Main only. About 6.5 kB, of which program
 * memory has 6.
 */
#ifndef INTERPRETER_H
#define INTERPRETER_H

#include <stdbool.h>
#include <stdint.h>

#include "base_tick.h"
#include "interpreter_shared.h"
#include "../../engine/axis/axis.h"
#include "../program/program_memory.h"
#include "../program/program_parser.h"

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

/* How this unit calls what ends a motion, X(axis_cause, text). */
#define INTERPRETER_CAUSES(X)                                                                                          \
    X(NONE, "")                                                                                                        \
    X(PAUSE, "K")                                                                                                      \
    X(HIGH, "M")                                                                                                       \
    X(LOW, "N")                                                                                                        \
    X(ABORT, "X")                                                                                                      \
    X(COMMAND, "reset")                                                                                                \
    X(LIMIT, "limit")                                                                                                  \
    X(FAULT, "error")

/*
 * The states of a program, and what is so in each of them.
 *
 *              until                        RUNS  TAKES_K  SETTLES  PAUSED  RESTS
 *   RUNNING    there is no more to run      x     x        x
 *   IDLE       a command is stored                x        x
 *   HELD       `]` is stored                x     x
 *   MOVING     the axis has ended its move  x     x
 *   WAIT_TIME  the program clock            x     x        x
 *   WAIT_LEVEL the level is there           x     x
 *   STOPPED    C75; K has stopped it        x                       x       x
 *   RESUMING   the motor stands, after C75  x                       x
 *   RESETTING  the motor stands, after `\`        x        x
 *   ENDED      `\`; X has ended it                                          x
 *   FAILED     `\`; an error has ended it                                   x
 */
enum interpreter_trait {
    INTERPRETER_RUNS = 1,    /* X ends the program, and `\` has something to stop */
    INTERPRETER_TAKES_K = 2, /* K stops it, unless it has come to rest */
    INTERPRETER_SETTLES = 4, /* it has come to rest if the clock has gone by and nothing is left to run */
    INTERPRETER_PAUSED = 8,  /* by K */
    INTERPRETER_RESTS = 16,  /* nothing happens before a message, once the motor stands */
};

/* X(NAME, traits, bits of interpreter_status.h; IDLE has them while a command is left) */
#define INTERPRETER_STATES(X)                                                                                          \
    X(RUNNING, INTERPRETER_RUNS | INTERPRETER_TAKES_K | INTERPRETER_SETTLES, INTERPRETER_STATUS_RUNNING)               \
    X(IDLE, INTERPRETER_TAKES_K | INTERPRETER_SETTLES, INTERPRETER_STATUS_RUNNING)                                     \
    X(HELD, INTERPRETER_RUNS | INTERPRETER_TAKES_K, INTERPRETER_STATUS_RUNNING | INTERPRETER_STATUS_WAITING)           \
    X(MOVING, INTERPRETER_RUNS | INTERPRETER_TAKES_K, INTERPRETER_STATUS_RUNNING)                                      \
    X(WAIT_TIME, INTERPRETER_RUNS | INTERPRETER_TAKES_K | INTERPRETER_SETTLES,                                         \
      INTERPRETER_STATUS_RUNNING | INTERPRETER_STATUS_WAITING)                                                         \
    X(WAIT_LEVEL, INTERPRETER_RUNS | INTERPRETER_TAKES_K, INTERPRETER_STATUS_RUNNING | INTERPRETER_STATUS_WAITING)     \
    X(STOPPED, INTERPRETER_RUNS | INTERPRETER_PAUSED | INTERPRETER_RESTS, INTERPRETER_STATUS_STOPPED)                  \
    X(RESUMING, INTERPRETER_RUNS | INTERPRETER_PAUSED, INTERPRETER_STATUS_STOPPED)                                     \
    X(RESETTING, INTERPRETER_TAKES_K | INTERPRETER_SETTLES, 0)                                                         \
    X(ENDED, INTERPRETER_RESTS, INTERPRETER_STATUS_ENDED)                                                              \
    X(FAILED, INTERPRETER_RESTS, INTERPRETER_STATUS_FAILED)

enum interpreter_state {
#define X(name, traits, status) INTERPRETER_##name,
    INTERPRETER_STATES(X)
#undef X
};

struct interpreter_loop {
    uint32_t body; /* ordinal of the first command of the body */
    uint16_t left; /* passes still to run, this one included */
    uint8_t calls; /* the depth of calls at which it was begun: the `.` from there closes it */
};

/* What the commands have set up for the next move, and what the present one has yet to do. */
struct interpreter_order {
    uint32_t start_speed_steps_per_s; /* S */
    uint32_t speed_steps_per_s;       /* V */
    uint32_t accel_steps_per_s2;      /* A */
    uint32_t steps;                   /* F or B; 0: none yet */
    bool backward;
    uint8_t mark_outputs; /* T51-T58: bit 0 is output 1 */
    uint8_t outputs_left; /* to be set when the last section begins, if still on in mark_outputs; 0 when they have */
};

/* The sections that Y has appended. */
struct interpreter_compound {
    struct motion_order order;
    bool backward;   /* fixed by the first Y */
    bool reversed;   /* D has turned it round since */
    bool done;       /* R has run it: the next Y begins a new one, the next F or B forgets it */
    uint8_t outputs; /* mark_outputs as they were at the first Y */
};

/* What a wait waits for. */
struct interpreter_wait {
    uint64_t left_ticks; /* while STOPPED: what is left of a wait for time */
    uint8_t number;      /* WAIT_LEVEL: input 1-8 or variable 80-95 */
    bool level;
};

struct interpreter {
    struct program_memory memory;
    struct axis *axis;
    struct interpreter_shared *shared;
    uint64_t clock;        /* the program clock: the tick at which the next move begins, unless it is later already */
    uint32_t next;         /* ordinal of the command to be run next */
    uint32_t place;        /* message 7: ordinal, from 1, of the command being or last run; 0: none since reset */
    uint64_t release_tick; /* when the youngest `]` came: what it releases does not begin before */
    uint8_t state;         /* enum interpreter_state */
    uint8_t resume_state;  /* while STOPPED or RESUMING: the state to go on with */
    uint8_t error;         /* enum interpreter_error */
    uint8_t motor;         /* 0 to 3 */
    struct interpreter_order order;
    struct interpreter_compound compound;
    struct interpreter_wait wait;
    struct axis_guards guards; /* M, N and X; a limit run has a fourth */
    struct interpreter_loop loops[INTERPRETER_LOOPS_MAX];
    uint32_t calls[INTERPRETER_CALLS_MAX]; /* ordinals to return to */
    uint8_t loop_depth;
    uint8_t call_depth;
};

/* Start values, empty memory; `axis` and `shared` must outlive it. */
void interpreter_init(struct interpreter *interpreter, unsigned motor, struct axis *axis,
                      struct interpreter_shared *shared);

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
