/*
 * The seam to the step output: four STEP pins whose edges the hardware makes, each at its tick, and the DIR pins.
 *
 * Pulses are laid ahead: while a motor moves, the backend asks the client for those that are due next (hal_run.h,
 * lay_isr), in time and at least one ahead. What has been laid is made without any code, or taken back. A pulse is
 * made when its active edge has come. The position is what has been made.
 */
#ifndef HAL_STEP_H
#define HAL_STEP_H

#include <stdbool.h>
#include <stdint.h>

/* The edges of a pulse, the active one and the one back (hal_step_set_polarity has the levels): the low 32 bits of the
 * unit's time. */
struct hal_step_pulse {
    uint32_t rise_tick;
    uint32_t fall_tick;
};

/* What the backend asks lay_isr for. */
struct hal_step_room {
    struct hal_step_pulse *pulse; /* where the pulses go, in their order */
    unsigned count;               /* of places, at least 1 */
    unsigned waiting;             /* pulses laid before that have not been made */
    uint32_t until_tick;          /* no pulse is wanted after the first that is due at this tick or later */
    uint32_t high_ticks;          /* the width of a pulse; the backend may move fall_tick later */
    bool backward;                /* DIR with these pulses; comes in as with those before */
    bool main_has_work;           /* set by the client where main is to be woken */
};

/* Lays what is due of a motor, and goes on asking for more: where it begins, where pulses were taken back, and where
 * what follows has changed, also if there was no more before. What lay_isr says of main is not looked at. A pulse is
 * due less than 25 s ahead; one whose tick has gone by is made good at once and counted as late. But for the next one,
 * none is laid more than a millisecond ahead, or a stop is less exact (design.md). Only while
 * hal_step_hold is in force. */
void hal_step_run(unsigned motor);

/* Pulses laid that have not been made. Only while hal_step_hold is in force. */
unsigned hal_step_waiting(unsigned motor);

/* Takes the last `count` pulses of those that wait back, or those of them for which it is not too late; tells how many.
 * If any were, hal_step_run has to follow for more to come. Only while hal_step_hold is in force. */
unsigned hal_step_take_back(unsigned motor, unsigned count);

/* DIR changes by itself between a pulse and the next one laid if that goes the other way: HOLD after the rising edge of
 * the one, SETUP before that of the other. So long the two must be apart, else the other one is late. Microseconds; any
 * context. */
uint32_t hal_step_turn_us(void);

/* Sets DIR: false forward, true backward. Called only while no pulse waits. Main. */
void hal_step_set_direction(unsigned motor, bool backward);

/* Connects STEP and DIR of a motor to their pins, or holds the pins at rest while all else runs on; at first they are
 * connected. Called only while the motor stands: DIR moves where no pulse is near. Main. */
void hal_step_connect(unsigned motor, bool connected);

/* Sets the levels of STEP and DIR of a motor: `falling`: STEP is high at rest and the active edge of a pulse, its first
 * one, falls; `turned`: DIR has the other level for each direction. After every reset as the board says, neither.
 * Pins that show another level then change once, DIR as it does in hal_step_set_direction. Called only while the motor
 * stands and no pulse waits. Main. */
void hal_step_set_polarity(unsigned motor, bool falling, bool turned);

/* Ticks that the backend wants between the planning of a change and the pulse at which it takes effect: at least
 * what planning takes. 0 where planning takes no time. Main. */
uint32_t hal_step_lead_ticks(void);

/* Holds off the interrupt in which pulses are laid and all others with it, and lets them through again; not nested.
 * Main, plan and tick interrupt. */
void hal_step_hold(void);
void hal_step_release(void);

#endif
