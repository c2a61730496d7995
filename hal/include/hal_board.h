/*
 * The seam for start and idle of a board. Main only.
 */
#ifndef HAL_BOARD_H
#define HAL_BOARD_H

#include <stdbool.h>
#include <stdint.h>

/* Why the board has started. What follows a watchdog or a fault stays until power goes: a reset by hand does not hide
 * it. */
enum hal_board_cause {
    HAL_BOARD_CAUSE_POWER,    /* power-on or brown-out */
    HAL_BOARD_CAUSE_RESET,    /* by hand or by a debugger */
    HAL_BOARD_CAUSE_WATCHDOG, /* main, tick or step interrupt did not go on */
    HAL_BOARD_CAUSE_FAULT,    /* a fault of the processor, a failed assertion, a crystal that has stopped */
};

/* Readies clocks, pins, timer, line and watchdog; outputs stay at 0. Every wait in it is bounded. Once. */
void hal_board_init(void);

/* Why the board has started. A host backend has this function and the next four, not the others. */
enum hal_board_cause hal_board_start_cause(void);

/* Whether motion is allowed: not without the crystal, as step times would be wrong. */
bool hal_board_may_move(void);

/* Whether anything may start by itself: not after a watchdog or a fault. */
bool hal_board_may_start_programs(void);

/* Pulses that were made later than asked for, since the start; modulo 2^32. */
uint32_t hal_board_late_steps(void);

/* Whether a timer makes each edge of STEP at its tick. If not, an interrupt makes it, some microseconds late: class 2
 * of design.md. */
bool hal_board_steps_are_timed(void);

/* The end of one pass of the main loop: tells the watchdog that main lives, and sleeps until `wake_tick` (nearly; now
 * or past: not at all) or until an interrupt has something for main that came after the pass began: a tick interrupt
 * with other inputs, a step interrupt that says so (main_has_work), bytes of the line. */
void hal_board_idle(uint64_t wake_tick);

#endif
