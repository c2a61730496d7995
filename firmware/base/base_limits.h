/*
 * What every unit has. Inside the firmware motors, inputs and outputs count from 0; bit 0 of a mask is the first.
 */
#ifndef BASE_LIMITS_H
#define BASE_LIMITS_H

enum {
    UNIT_MOTORS = 4,
    UNIT_INPUTS = 8,
    UNIT_OUTPUTS = 8,
};

#endif
