/*
 * The watch on the inputs of an axis: what the tick interrupt does at their edges, and what it keeps for main.
 *
 * An input of an axis is a number: 0 none; 1 to 8 input 1 to 8, active when it is 1; -1 to -8 the same, active when it
 * is 0. Main writes what is wanted and takes what has happened while hal_step_hold is in force.
 */
#ifndef POS_WATCH_H
#define POS_WATCH_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

struct pos_drive;

enum pos_seek {
    POS_SEEK_NOTHING,
    POS_SEEK_ACTIVE,   /* stop when the reference input is active */
    POS_SEEK_INACTIVE, /* stop when it goes from active to inactive */
};

struct pos_watch {
    /* What is wanted. */
    int8_t limit; /* the input that ends the motion in progress */
    int8_t reference;
    int8_t capture;
    uint8_t seek; /* enum pos_seek */
    bool armed;

    /* What was sensed last. */
    bool reference_was_active;
    bool capture_was_active;

    _Atomic bool happened; /* one of the next three has been set */

    /* What has happened; main takes it. */
    bool limit_hit;
    bool reference_hit;
    bool captured;
    int64_t reference_motor_steps;
    int64_t captured_motor_steps;
};

/* Whether an input is active at these levels. */
bool pos_watch_is_active(int32_t input, uint8_t inputs);

/* Senses the inputs, and stops the drive. Tick interrupt; main before the interrupts start. True: the plan interrupt is
 * needed. */
bool pos_watch_sense_isr(struct pos_watch *watch, struct pos_drive *drive, uint8_t inputs);

#endif
