/*
 * The reference board: STM32F405RGT6 (LQFP64) with an 8 MHz crystal. README.md beside this file has the same pins as a
 * table, with notes on wiring.
 *
 * X(signal, port, pin, use): each signal's pin. `use` is IN, IN_UP (pull-up) or OUT, or the peripheral that has the
 * pin.
 */
#ifndef BOARD_H
#define BOARD_H

#define BOARD_PINS(X)                                                                                                  \
    X(STEP_1, A, 0, TIM5_CH1)                                                                                          \
    X(STEP_2, A, 1, TIM5_CH2)                                                                                          \
    X(STEP_3, A, 2, TIM5_CH3)                                                                                          \
    X(STEP_4, A, 3, TIM5_CH4)                                                                                          \
    X(DIR_1, A, 6, TIM3_CH1)                                                                                           \
    X(DIR_2, A, 7, TIM3_CH2)                                                                                           \
    X(DIR_3, B, 0, TIM3_CH3)                                                                                           \
    X(DIR_4, B, 1, TIM3_CH4)                                                                                           \
    X(LINE_DE, A, 8, OUT)                                                                                              \
    X(LINE_TX, A, 9, USART1)                                                                                           \
    X(LINE_RX, A, 10, USART1)                                                                                          \
    X(BI_1, C, 0, IN_UP)                                                                                               \
    X(BI_2, C, 1, IN_UP)                                                                                               \
    X(BI_3, C, 2, IN_UP)                                                                                               \
    X(BI_4, C, 3, IN_UP)                                                                                               \
    X(BI_5, C, 4, IN_UP)                                                                                               \
    X(BI_6, C, 5, IN_UP)                                                                                               \
    X(BI_7, C, 6, IN_UP)                                                                                               \
    X(BI_8, C, 7, IN_UP)                                                                                               \
    X(BO_1, B, 8, OUT)                                                                                                 \
    X(BO_2, B, 9, OUT)                                                                                                 \
    X(BO_3, B, 10, OUT)                                                                                                \
    X(BO_4, B, 11, OUT)                                                                                                \
    X(BO_5, B, 12, OUT)                                                                                                \
    X(BO_6, B, 13, OUT)                                                                                                \
    X(BO_7, B, 14, OUT)                                                                                                \
    X(BO_8, B, 15, OUT)                                                                                                \
    X(LED_1, C, 8, OUT)                                                                                                \
    X(LED_2, C, 9, OUT)                                                                                                \
    X(LED_3, C, 10, OUT)                                                                                               \
    X(LED_4, C, 11, OUT)                                                                                               \
    X(S1_1, A, 4, IN_UP)                                                                                               \
    X(S1_2, A, 5, IN_UP)                                                                                               \
    X(S1_3, B, 4, IN_UP)                                                                                               \
    X(S1_4, B, 5, IN_UP)

/* What some units have besides: a PWM output, and LEDs 5 to 8. */
#define BOARD_PWM_PINS(X) X(PWM, B, 6, TIM4_CH1)
#define BOARD_PWM_LEVEL 1U
#define BOARD_MORE_LED_PINS(X)                                                                                         \
    X(LED_5, C, 12, OUT)                                                                                               \
    X(LED_6, D, 2, OUT)                                                                                                \
    X(LED_7, B, 3, OUT)                                                                                                \
    X(LED_8, B, 7, OUT)

/* Where the bring-up image captures what a wire brings: channel 1 of TIM1 or TIM4. The pin is the PWM output of
 * other units. */
#define BOARD_CAPTURE_PINS(X) X(CAPTURE, B, 6, TIM4_CH1)

/* Pins without a signal that are pulled up, so that a part beside them rests. */
#define BOARD_PULLED_UP(X)

#define BOARD_PACKAGE "LQFP64"
#define BOARD_CRYSTAL_MHZ 8U
#define BOARD_USART 1

/* The supply at the part: the lowest in good order (3.3 V less 5 %); level of the voltage detector below which the
 * flash is not written; bytes written at a time; level of the brown-out reset that `board options` sets (3 is the
 * highest). stm32_supply.c checks that they fit to each other. */
#define BOARD_SUPPLY_MIN_MV 3135U
#define BOARD_DETECT_LEVEL 6U
#define BOARD_FLASH_BYTES 4U
#define BOARD_BROWN_OUT_LEVEL 3U

/* The level at the pin that means 1: 1 high, 0 low. Opto-isolators pull an input low; a switch that is ON closes to
 * ground. */
#define BOARD_STEP_LEVEL 1U
#define BOARD_DIR_LEVEL 1U
#define BOARD_BI_LEVEL 0U
#define BOARD_BO_LEVEL 1U
#define BOARD_LED_LEVEL 1U
#define BOARD_S1_LEVEL 0U

/* What the drivers of the motors need at least: STEP high, STEP low, DIR before and after a rising edge of STEP. */
#define BOARD_STEP_HIGH_NS 500U
#define BOARD_STEP_LOW_NS 500U
#define BOARD_DIR_SETUP_NS 5000U
#define BOARD_DIR_HOLD_NS 5000U

#endif
