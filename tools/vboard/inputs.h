/*
 * The levels of the unit's inputs over time: a file of lines `ms,input,level`, as 350.5,3,1. All inputs start at 0.
 */
#ifndef INPUTS_H
#define INPUTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct board;

struct input_change {
    uint64_t ps;
    uint32_t line; /* of the file, for order among equals */
    uint8_t input; /* from 0 */
    bool level;
};

struct inputs {
    struct input_change *change; /* sorted */
    size_t changes;
    size_t next;
};

/* Reads the file that the options name and sets all inputs and the switch to their first levels. False after a
 * complaint. */
bool inputs_open(struct board *board);
void inputs_close(struct board *board);

void inputs_event(struct board *board, uint64_t cycle);

#endif
