/*
 * The levels of the unit's inputs over time: a file of lines `ms,input,level`, as 350.5,3,1. All inputs start at 0.
 */
#ifndef INPUTS_H
#define INPUTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "clock.h"
#include "gpio.h"
#include "pins.h"

struct input_change {
    uint64_t ps;
    uint32_t line; /* of the file, for order among equals */
    uint8_t input; /* from 0 */
    bool level;
};

struct inputs_wires {
    struct clock *clock;
    const struct pins *pins;
    struct gpio *gpio;
};

struct inputs {
    struct inputs_wires wires;
    struct input_change *change; /* sorted */
    size_t changes;
    size_t next;
};

void inputs_init(struct inputs *inputs, struct inputs_wires wires);

/* Sets all inputs to 0 and the switch to an address from 1 on, and reads the file, null for none. False after a
 * complaint. */
bool inputs_open(struct inputs *inputs, unsigned node, const char *path);
void inputs_close(struct inputs *inputs);

#endif
