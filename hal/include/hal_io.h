/*
 * The seam to inputs, outputs, a PWM output and LEDs. Levels are logical: polarity is the board's affair. Main only,
 * but for the inputs.
 */
#ifndef HAL_IO_H
#define HAL_IO_H

#include <stdbool.h>
#include <stdint.h>

enum {
    HAL_IO_LEDS = 8,
    HAL_IO_PWM_MAX = 1000
};

/* The binary inputs now: bit 0 is input 1. Main and tick interrupt. */
uint8_t hal_io_read_inputs(void);

/* Sets all binary outputs: bit 0 is output 1. */
void hal_io_write_outputs(uint8_t levels);

/* Sets how much of each millisecond the PWM output is 1, in thousandths: 0 never, HAL_IO_PWM_MAX always. 0 after every
 * reset. A board without such an output does nothing here. */
void hal_io_write_pwm(uint32_t permille);

/* Switches LED 0 to 7. A board may have the first four only. */
void hal_io_set_led(unsigned led, bool on);

#endif
