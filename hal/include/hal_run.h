/*
 * What the backend calls: the unit's interrupt entries, handed over once at start.
 */
#ifndef HAL_RUN_H
#define HAL_RUN_H

#include <stdbool.h>
#include <stdint.h>

struct hal_step_room;

struct hal_client {
    void *context;

    /* Step interrupt, and hal_step_run: writes the pulses of motor 0 to 3 that are due next into `room` and returns how
     * many. 0: none is left. It is asked once more when all that were laid have been made, and then the motor rests. It
     * is not asked while a change of DIR is to come between two pulses that it has laid. */
    unsigned (*lay_isr)(void *context, unsigned motor, struct hal_step_room *room);

    /* Tick interrupt, whenever an input changes; a board may call it every millisecond, too: senses the inputs for
     * guards and stops. They had not changed before `since_tick`, the unit's time; an input that a board looks at every
     * millisecond only has changed in the last one. Main has a pass after it (hal_board_idle). */
    void (*tick_isr)(void *context, uint64_t since_tick);

    /* Plan interrupt, below the tick interrupt and above main: whenever hal_run_plan has asked for it. Plans, which
     * takes long. */
    void (*plan_isr)(void *context);
};

/* Starts the interrupts. The client must live as long as the backend runs. Main. */
void hal_run_start(const struct hal_client *client);

/* Asks for the plan interrupt: it comes as soon as nothing above it runs and main does not hold it off. Main and tick
 * interrupt. */
void hal_run_plan(void);

/* Holds the plan interrupt off while main works on what it shares with it, and lets it through again; not nested.
 * Main. */
void hal_run_hold_plan(void);
void hal_run_release_plan(void);

#endif
