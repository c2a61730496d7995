/*
 * What one unit has: the counts and numbers that every stage shares.
 *
 * Numbers as a program writes them: inputs and outputs 1 to 8, internal variables 80 to 95, motors 1 to 4 (a
 * message says 0 for all four). Inside the firmware motors, inputs and outputs count from 0.
 */
#ifndef BASE_LIMITS_H
#define BASE_LIMITS_H

enum {
    UNIT_MOTORS = 4,
    UNIT_INPUTS = 8,
    UNIT_OUTPUTS = 8,
    UNIT_VARIABLES = 16,
    UNIT_VARIABLE_FIRST = 80, /* the number that a program gives to the first internal variable */
};

#endif
