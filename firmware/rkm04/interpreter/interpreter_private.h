/*
 * What the files of the interpreter share. Each uses those before it only:
 *   interpreter_shared.c    what the interpreters of a unit share
 *   interpreter_state.c     states, clock, errors
 *   interpreter_move.c      moves, from the command to what is left after a stop
 *   interpreter_commands.c  one function for each command
 *   interpreter_take.c      messages
 *   interpreter.c           the poll that runs it all
 */
#ifndef INTERPRETER_PRIVATE_H
#define INTERPRETER_PRIVATE_H

#include "hal_trace.h"
#include "interpreter.h"

/* Whether the state of the program has a trait; the table is in interpreter.h. */
bool interpreter_is(const struct interpreter *interpreter, enum interpreter_trait trait);

/* Start values; memory, loops, calls, guards and errors are cleared. A move under way is left to its end. */
void interpreter_clear(struct interpreter *interpreter);

void interpreter_trace(const struct interpreter *interpreter, uint64_t tick, enum hal_trace_event event, int64_t value);

/* Whether no command is left of what is stored. */
bool interpreter_has_run_all(const struct interpreter *interpreter);

/* The clock never goes back. */
void interpreter_raise_clock(struct interpreter *interpreter, uint64_t tick);

/* Before a move or a wait begins at the clock: a clock that has fallen behind too far is set to now. */
void interpreter_align_clock(struct interpreter *interpreter, uint64_t now_ticks);

/* Runs one command; the motor stands and `next` is after the command already. */
void interpreter_run(struct interpreter *interpreter, const struct program_instruction *instruction,
                     uint64_t now_ticks);

/* Begins a move at the clock. `halt_high` is the input that ends a limit run, as a mask; `outputs` are set when the
 * last section begins. */
void interpreter_begin_move(struct interpreter *interpreter, const struct motion_order *order, bool backward,
                            uint8_t halt_high, uint8_t outputs, uint64_t now_ticks);

/* Sees what the axis has done: the last section has begun, the move has ended; where the motor stands, simulation is
 * switched on or off. */
void interpreter_watch_move(struct interpreter *interpreter, uint64_t now_ticks);

/* Stops the motor if it moves, and tells why the program stops. */
void interpreter_stop(struct interpreter *interpreter, enum axis_cause cause, uint64_t now_ticks);

/* From STOPPED or RESUMING back to the state that K interrupted; the motor stands. */
void interpreter_continue(struct interpreter *interpreter, uint64_t now_ticks);

#endif
