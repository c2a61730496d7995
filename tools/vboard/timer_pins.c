#include "timer_pins.h"

enum {
    NO_PORT = 0xFF
};

#define NO_PIN {.port = NO_PORT}
#define PIN(letter, bit) {.port = (letter) - 'A', .number = (bit)}

/* The data sheet's table of alternate functions. */
static const struct pin pins[TIMERS][TIMER_CHANNELS][TIMER_PINS_PER_CHANNEL] = {
    {{PIN('A', 0), PIN('A', 5), PIN('A', 15)},
     {PIN('A', 1), PIN('B', 3), NO_PIN},
     {PIN('A', 2), PIN('B', 10), NO_PIN},
     {PIN('A', 3), PIN('B', 11), NO_PIN}},
    {{PIN('A', 6), PIN('B', 4), PIN('C', 6)},
     {PIN('A', 7), PIN('B', 5), PIN('C', 7)},
     {PIN('B', 0), PIN('C', 8), NO_PIN},
     {PIN('B', 1), PIN('C', 9), NO_PIN}},
    {{PIN('B', 6), PIN('D', 12), NO_PIN},
     {PIN('B', 7), PIN('D', 13), NO_PIN},
     {PIN('B', 8), PIN('D', 14), NO_PIN},
     {PIN('B', 9), PIN('D', 15), NO_PIN}},
    {{PIN('A', 0), PIN('H', 10), NO_PIN},
     {PIN('A', 1), PIN('H', 11), NO_PIN},
     {PIN('A', 2), PIN('H', 12), NO_PIN},
     {PIN('A', 3), PIN('I', 0), NO_PIN}},
    {{PIN('A', 8), PIN('E', 9), NO_PIN},
     {PIN('A', 9), PIN('E', 11), NO_PIN},
     {PIN('A', 10), PIN('E', 13), NO_PIN},
     {PIN('A', 11), PIN('E', 14), NO_PIN}},
};

const struct pin *timer_pin(unsigned timer, unsigned channel, unsigned which)
{
    const struct pin *pin = &pins[timer][channel][which];
    return pin->port == NO_PORT ? NULL : pin;
}

unsigned timer_function(unsigned timer)
{
    return timer == 0 || timer == (unsigned)TIMER_TIM1 ? GPIO_AF_TIM1_TO_2 : GPIO_AF_TIM3_TO_5;
}
