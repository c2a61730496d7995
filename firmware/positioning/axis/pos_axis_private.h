/*
 * What the files of an axis share: pos_axis.c (instructions and states), pos_axis_motion.c (measures, their begin and
 * end), pos_axis_home.c (homing). Main only.
 */
#ifndef POS_AXIS_PRIVATE_H
#define POS_AXIS_PRIVATE_H

#include "base_wide.h"
#include "pos_axis.h"
#include "pos_registers.h"

/* A setting of the axis. */
static inline uint32_t pos_axis_setting(const struct pos_axis *axis, enum pos_axis_register which)
{
    return axis->settings[which];
}

static inline int32_t pos_axis_signed_setting(const struct pos_axis *axis, enum pos_axis_register which)
{
    return wide_to_signed_32(axis->settings[which]);
}

/* Sets and clears bits of the control record, and writes all of them but MP. */
void pos_axis_mark(struct pos_axis *axis, unsigned set, unsigned cleared);

/* The axis' own place, and what the inputs have kept, are those of now. */
void pos_axis_look(struct pos_axis *axis);

/* A measure, or a part of homing, to a step of the axis. False: there is no pulse to make. */
bool pos_axis_aim(struct pos_axis *axis, int64_t step);

/* The measure is over, at its target. */
void pos_axis_reached(struct pos_axis *axis);

/* Nothing is left of what was to be done, nor wanted. */
void pos_axis_drop(struct pos_axis *axis);

/* Whatever is done ends: the drive stops, nothing of a measure is left. */
void pos_axis_give_up(struct pos_axis *axis, bool fault);

/* Whether an input of the axis, a setting, is active. */
bool pos_axis_is_active(const struct pos_axis *axis, enum pos_axis_register input, uint8_t inputs);

/* Homing: stands before its begin; leaves a stand, the first time with its first part; goes on where a part of it has
 * ended; the speed that it allows. */
void pos_home_prepare(struct pos_axis *axis);
void pos_home_start(struct pos_axis *axis, uint8_t inputs);
void pos_home_follow(struct pos_axis *axis, uint8_t inputs);
uint32_t pos_home_feed(const struct pos_axis *axis);

#endif
