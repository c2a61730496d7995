/*
 * The seam to inputs, outputs and LEDs. Levels are logical: polarity is the board's affair. Main only, but for the
 * inputs.
 */
#ifndef HAL_IO_H
#define HAL_IO_H

#include <stdbool.h>
#include <stdint.h>

/* The binary inputs now: bit 0 is input 1. Main and tick interrupt. */
uint8_t hal_io_read_inputs(void);

/* Sets all binary outputs: bit 0 is output 1. */
void hal_io_write_outputs(uint8_t levels);

/* Switches the LED of motor 0 to 3. */
void hal_io_set_led(unsigned motor, bool on);

#endif
