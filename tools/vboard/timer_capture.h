/*
 * Input capture of the timers (RM0090 sections 18.3.5 and 18.4.7 to 18.4.9): an edge at TIx puts the count into the
 * channel's register. Modelled with TIx of the channel itself or of its neighbour (so that two channels hear one pin,
 * 18.3.6), without filter: rising, falling and both edges, the prescaler, the flags for a capture and for one that came
 * before the last had been read.
 *
 * What is connected to TIx: the channel's pin, where that has the timer's function; TI4 of TIM5 may have the low-speed
 * oscillator instead (18.4.20). The few
 * clocks by which the input is brought into step with the timer, the same at each edge, are left out.
 */
#ifndef TIMER_CAPTURE_H
#define TIMER_CAPTURE_H

#include "timer.h"

enum {
    TIMER_OR_TI4_LSI = 1 << 6
};

/* Once, for TIM5, after timer_init. */
void timer_capture_init(struct timer *timer);

/* A write of CCMR or CCER is about to be taken over: ends the run where the manual forbids it, or it is not modelled.
 */
void timer_check_modes(const struct timer *timer, unsigned index, uint32_t value);
void timer_check_enables(const struct timer *timer, uint32_t value);

/* After a change of modes, enables or connections: finds out whether edges of the oscillator come in. */
void timer_plan_capture(struct timer *timer);

/* The level of a pin has changed. */
void timer_note_pin(struct timer *timer, struct pin pin, bool rises, uint64_t cycle);

/* The program reads the register of a channel that is an input: the flag goes (18.4.5). */
void timer_take_capture(struct timer *timer, unsigned channel);

#endif
