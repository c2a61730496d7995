/*
 * What is fixed when an image of this unit is built. The STM32 backend includes it, as it does the header of the board.
 */
#ifndef IMAGE_H
#define IMAGE_H

/* The line: its rate, one of six, and whether it hears while it sends (hal_line.h). FIRMWARE_LINE_BD of the build takes
 * another rate. */
#ifndef IMAGE_LINE_BD
#define IMAGE_LINE_BD 115200U
#endif
#define IMAGE_LINE_FULL_DUPLEX 1

/* The most steps of a motor in a second, for which a board's drivers must do. */
#define IMAGE_STEPS_PER_S_MAX 200000U

/* The width of a pulse at STEP; 0: that of the board. */
#define IMAGE_STEP_HIGH_NS 2500U

/* Of the 8 LEDs of hal_io.h those that the unit has, whether all of them blink without the crystal, and whether there
 * is a PWM output. */
#define IMAGE_LEDS 8
#define IMAGE_LEDS_BLINK 0
#define IMAGE_PWM 1

/* Pulses of a motor that can be laid ahead, a power of two, 64 at least; 8 bytes each. */
#define IMAGE_STEP_RING_PULSES 64

/* The stack; tools/rkm04_tools/board_size.py proves how much of it can be needed. */
#define IMAGE_STACK_BYTES 3952

#endif
