/*
 * The bring-up image: what a new board tells of itself over its line, at 19 200 Bd in plain text, so that a terminal
 * does as well as `tools/rkm04 bringup`. It uses the drivers of the unit's image, and nothing of a unit. Nothing is
 * switched but by a command, and an output that is on goes off a minute after the last one.
 *
 * A command is a letter, perhaps a number, and the end of the line: see README.md beside this file. The answer is
 * lines of a name and values, then `end LETTER SUM` of all bytes before that line; or `error LETTER WHY`.
 *
 * Main only, but for the interrupts that these files start.
 */
#ifndef BRINGUP_H
#define BRINGUP_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_run.h"
#include "hal_step.h"

/* Each answers a command on the line. */
void bringup_part_tell(void);
void bringup_clock_tell(void);
void bringup_inputs_tell(void);
void bringup_cycles_tell(void);

/* The unit's time, 32 bits of it, and how many of its ticks and of the processor's cycles pass in a millisecond, awake.
 */
void bringup_clock_tell_now(void);

/* The clock of the timers on a bus. */
uint32_t bringup_timer_hz(uint32_t bus_hz);

/* What the part says of its last reset, which the start of the board clears: taken before that. */
void bringup_part_take_reset(void);

/* Begins to count edges anew. */
void bringup_inputs_forget(void);

/* Counts edges of the inputs from the start of the interrupts on. Tick interrupt. */
void bringup_inputs_isr(void *context, uint64_t since_tick);

/* The rate of the low-speed oscillator; first of all, as it takes the board's timers for it, 31 ms. */
void bringup_measure_oscillator(void);
void bringup_measure_tell_oscillator(void);

/* The supply, by the internal reference. */
void bringup_measure_tell_supply(void);

/* Counts the cycles of each interrupt from now on; the interrupts have been started. */
void bringup_cycles_start(void);

/* The pin at which pulses are captured rests, an input that is pulled down. */
void bringup_capture_start(void);

/* The level of that pin; false where the board has none. */
bool bringup_capture_read(void);

/* Makes pulses of a motor, 1 to 4, and tells what was captured of them. A null answer: done; else why not. */
const char *bringup_capture_tell(uint32_t number);

/* Makes pulses of all motors at once, and tells how many. A null answer: done; else why not. Where they are too much
 * for the part it is reset meanwhile. */
const char *bringup_together_tell(void);

/* Begins so many pulses of a motor, 0 to 3, the first at a tick, each an interval after the one before. What was begun
 * before has been made; with the step interrupt held off. */
void bringup_train_begin(unsigned motor, uint32_t first_tick, uint32_t count, uint32_t (*interval_ticks)(uint32_t));

/* How many of them have been made. */
uint32_t bringup_train_count_made(unsigned motor);

/* Lays them. Step interrupt. */
unsigned bringup_train_lay_isr(void *context, unsigned motor, struct hal_step_room *room);

/* Switches one of the wires of a kind on and all others of all kinds off; number 0: all off. A null answer: done, and
 * the levels that the pins have now were told; else why not. */
const char *bringup_outputs_set(char kind, uint32_t number);

/* Ends what has been on for too long. */
void bringup_outputs_watch(void);

/* Never return: main stands still until the watchdog resets the part; the stack overflows. */
_Noreturn void bringup_hang(void);
_Noreturn void bringup_overflow(void);

/* bringup_say.c: text on the line. An answer begins: what was said before does not count. */
void say_begin(void);
void say_name(const char *name);
void say_word(const char *word);
void say_decimal(uint32_t value);
void say_hex(uint32_t value, unsigned digits);
void say_line_end(void);
/* A line of its own. */
void say_number(const char *name, uint32_t value);
/* The last line of an answer; of a refusal. */
void say_end(char command);
void say_error(char command, const char *why);
/* Until all has been sent. */
void say_wait(void);

/* Lets so many milliseconds pass. */
void bringup_wait(uint32_t milliseconds);

#endif
