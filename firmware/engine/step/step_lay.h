/*
 * Lays the pulses of one segment: the generator's ticks, as edges, into the room that the backend gives. The innermost
 * loop of the firmware. Step interrupt, or with hal_step held.
 */
#ifndef STEP_LAY_H
#define STEP_LAY_H

#include "hal_step.h"
#include "step_generator.h"

/* Lays at least one pulse from place `first` of the room on, at most `count`, none after the first that is due at
 * room->until_tick or later. The segment has `count` pulses left at least, and the room as many places. Returns how
 * many. */
unsigned step_lay(struct step_generator *generator, const struct hal_step_room *room, unsigned first, unsigned count);

/* Whether a pulse after the one at `tick` is wanted: tick_is_before, without a call. */
static inline bool step_lay_goes_on(uint32_t tick, const struct hal_step_room *room)
{
    return room->until_tick - tick - 1U < UINT32_C(1) << 31U;
}

/* Lays the pulse that the generator stands on. */
static inline void step_lay_pulse(const struct step_generator *generator, const struct hal_step_room *room,
                                  unsigned place)
{
    room->pulse[place].rise_tick = generator->tick;
    room->pulse[place].fall_tick = generator->tick + room->high_ticks;
}

#endif
