/*
 * What is fixed when an image of this unit is built. The STM32 backend includes it, as it does the header of the board.
 */
#ifndef IMAGE_H
#define IMAGE_H

/* The line: its rate, and whether it hears while it sends (hal_line.h). */
#define IMAGE_LINE_BD 19200U
#define IMAGE_LINE_FULL_DUPLEX 0

/* The byte that wakes main at once; others wait for its next pass, a millisecond at most. It closes a frame, and a
 * broadcast counts from then on. */
#define IMAGE_LINE_LAST 0x7EU

/* The most steps of a motor in a second, for which a board's drivers must do. */
#define IMAGE_STEPS_PER_S_MAX 16000U

/* The width of a pulse at STEP; 0: that of the board. */
#define IMAGE_STEP_HIGH_NS 0U

/* Of the 8 LEDs of hal_io.h those that the unit has, whether all of them blink without the crystal, and whether there
 * is a PWM output. */
#define IMAGE_LEDS 4
#define IMAGE_LEDS_BLINK 1
#define IMAGE_PWM 0

/* Pulses of a motor that can be laid ahead, a power of two, 64 at least; 8 bytes each. */
#define IMAGE_STEP_RING_PULSES 128

/* The stack; tools/rkm04_tools/board_size.py proves how much of it can be needed. */
#define IMAGE_STACK_BYTES 4480

#endif
