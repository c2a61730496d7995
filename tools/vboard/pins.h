/*
 * Which signal of the unit is on which pin: a text file with lines `SIGNAL PIN [low]`, as `m1_step PA0` or
 * `bi3 PC4 low`, where `low` means that the pin is low when the signal is 1. `line USART2` names the USART of the
 * line. `#` starts a comment.
 */
#ifndef PINS_H
#define PINS_H

#include <stdbool.h>
#include <stdint.h>

#include "gpio.h"

enum {
    PINS_MOTORS = 4,
    PINS_INPUTS = 8,
    PINS_OUTPUTS = 8,
    PINS_SWITCHES = 4,
    PINS_MORE_LEDS = 4,
    PINS_MORE_LEDS_FIRST = 5, /* its number */
};

/* Signals by number. */
enum signal {
    SIGNAL_STEP,
    SIGNAL_DIRECTION = SIGNAL_STEP + PINS_MOTORS, /* 1 is backward */
    SIGNAL_LED = SIGNAL_DIRECTION + PINS_MOTORS,
    SIGNAL_INPUT = SIGNAL_LED + PINS_MOTORS,
    SIGNAL_OUTPUT = SIGNAL_INPUT + PINS_INPUTS,
    SIGNAL_DRIVER = SIGNAL_OUTPUT + PINS_OUTPUTS,  /* of the line: 1 sends */
    SIGNAL_ENABLE = SIGNAL_DRIVER + 1,             /* of the motor drivers */
    SIGNAL_MORE_LED = SIGNAL_ENABLE + PINS_MOTORS, /* LEDs that belong to no motor, from 5 on */
    SIGNAL_PWM = SIGNAL_MORE_LED + PINS_MORE_LEDS,
    SIGNAL_SWITCH = SIGNAL_PWM + 1, /* S1-1 to S1-4: 1 is closed */
    SIGNALS = SIGNAL_SWITCH + PINS_SWITCHES,
    SIGNAL_NONE = SIGNALS,
};

struct pins {
    struct pin pin[SIGNALS]; /* port GPIO_PORTS: not connected */
    bool low[SIGNALS];
    uint8_t signal[GPIO_PORTS][GPIO_PINS]; /* SIGNAL_NONE: none */
    unsigned usart;                        /* 0 to 2 */
};

/* Reads the file; a null path leaves all signals unconnected. False after a complaint. */
bool pins_read(struct pins *pins, const char *path);

/* Reads a pin's name, as PA0, up to the end of the text. */
bool pins_read_name(const char *text, struct pin *pin);

static inline bool pins_is_connected(const struct pins *pins, unsigned signal)
{
    return pins->pin[signal].port < GPIO_PORTS;
}

#endif
