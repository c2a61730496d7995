/*
 * A kind of unit, as the programs see it that let one run on the host machine: the functions of its firmware and the
 * words of its files. The unit itself is a struct of the caller, which only the functions of its kind know.
 */
#ifndef UNIT_KIND_H
#define UNIT_KIND_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base_limits.h"
#include "hal_trace.h"

struct unit_kind {
    const char *program; /* what files name as their writer */
    size_t bytes;        /* of a unit */

    /* Start values, then interrupts and line; on the machine that is selected. */
    void (*begin)(void *unit);

    /* As the pass of host_machine_run. */
    uint64_t (*poll)(void *unit);

    /* Nothing more happens by itself, or there is only what a line brings; and whether its line has bytes to take or
     * to send. */
    bool (*is_idle)(const void *unit);
    bool (*is_talking)(const void *unit);

    /* Of motor 0 to 3: its counter, steps; whether it moves, so that pulses may change the counter. */
    int64_t (*position_steps)(const void *unit, unsigned motor);
    bool (*is_moving)(const void *unit, unsigned motor);

    /* What the value of a trace event means in words. Null: it is a number. */
    const char *(*trace_text)(enum hal_trace_event event, int64_t value);

    const char *const *leds; /* names of the HAL_IO_LEDS LEDs; null: the first four are m1_led to m4_led */
    bool has_pwm;
    bool traces_positions; /* positions that commands write are events of the trace, too */
    bool moves_together;   /* all motors begin and end their moves together, those that make no steps, too */
    uint8_t inputs_used;   /* those that the unit has; bit 0 is input 1 */
    uint8_t inputs_turned; /* those whose level is the other one in files and orders than at the machine: 1 is open */
    const char *inputs_wrong; /* what is said of a file that names another one */
};

/* Whether it has the input of a number from 1. */
static inline bool unit_kind_has_input(const struct unit_kind *kind, uint64_t number)
{
    return number >= 1 && number <= UNIT_INPUTS && ((unsigned)kind->inputs_used >> (number - 1U) & 1U) != 0;
}

#endif
