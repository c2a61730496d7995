/*
 * The pins of the timers' channels, and the alternate function by which they have them (DS8626, table 9).
 */
#ifndef TIMER_PINS_H
#define TIMER_PINS_H

#include "gpio.h"
#include "timer_counter.h"

enum {
    TIMER_PINS_PER_CHANNEL = 3
};

/* Null: there are not so many. */
const struct pin *timer_pin(unsigned timer, unsigned channel, unsigned which);

unsigned timer_function(unsigned timer);

#endif
