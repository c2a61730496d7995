/*
 * What the files of a channel share: step_channel.c queues and lays, step_channel_change.c changes what has been queued
 * and laid. All with hal_step held, but for step_channel_follow.
 */
#ifndef STEP_CHANNEL_PRIVATE_H
#define STEP_CHANNEL_PRIVATE_H

#include "step_channel.h"

/* Moves a cursor on to a pulse, or to the last one that is queued. Also without hal_step held, on what is not being
 * changed meanwhile. */
void step_channel_follow(struct step_cursor *cursor, const struct step_channel *channel, uint64_t pulse);

/* No way leads back from where the cursor is. */
void step_channel_keep_nothing(struct step_channel *channel);

/* Appends a segment; there must be room. */
void step_channel_append(struct step_channel *channel, const struct step_segment *segment);

/* Pulses made in the present or last move. */
uint64_t step_channel_count(const struct step_channel *channel);

/* The last of the places that are kept from which a way leads on to a pulse. */
const struct step_cursor *step_channel_base(const struct step_channel *channel, uint64_t pulse);

/* The pulses after the one that the cursor stands on go the other way. Also in the step interrupt. */
void step_channel_turn_over(struct step_channel *channel);

#endif
