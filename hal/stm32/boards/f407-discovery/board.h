/*
 * ST's STM32F407G-DISC1 (STM32F407VGT6, LQFP100, 8 MHz crystal), with drivers, line and inputs wired to its headers.
 * README.md beside this file has the same pins as a table, with what else sits on that board.
 *
 * X(signal, port, pin, use): each signal's pin. `use` is IN, IN_UP (pull-up) or OUT, or the peripheral that has the
 * pin.
 */
#ifndef BOARD_H
#define BOARD_H

#define BOARD_PINS(X)                                                                                                  \
    X(STEP_1, A, 5, TIM2_CH1)                                                                                          \
    X(STEP_2, A, 1, TIM5_CH2)                                                                                          \
    X(STEP_3, A, 2, TIM5_CH3)                                                                                          \
    X(STEP_4, A, 3, TIM5_CH4)                                                                                          \
    X(DIR_1, C, 6, TIM3_CH1)                                                                                           \
    X(DIR_2, B, 5, TIM3_CH2)                                                                                           \
    X(DIR_3, C, 8, TIM3_CH3)                                                                                           \
    X(DIR_4, C, 9, TIM3_CH4)                                                                                           \
    X(LINE_DE, D, 10, OUT)                                                                                             \
    X(LINE_TX, D, 8, USART3)                                                                                           \
    X(LINE_RX, D, 9, USART3)                                                                                           \
    X(BI_1, E, 8, IN_UP)                                                                                               \
    X(BI_2, E, 9, IN_UP)                                                                                               \
    X(BI_3, E, 10, IN_UP)                                                                                              \
    X(BI_4, E, 11, IN_UP)                                                                                              \
    X(BI_5, E, 12, IN_UP)                                                                                              \
    X(BI_6, E, 13, IN_UP)                                                                                              \
    X(BI_7, E, 14, IN_UP)                                                                                              \
    X(BI_8, E, 15, IN_UP)                                                                                              \
    X(BO_1, B, 11, OUT)                                                                                                \
    X(BO_2, C, 1, OUT)                                                                                                 \
    X(BO_3, B, 7, OUT)                                                                                                 \
    X(BO_4, B, 8, OUT)                                                                                                 \
    X(BO_5, B, 12, OUT)                                                                                                \
    X(BO_6, B, 13, OUT)                                                                                                \
    X(BO_7, B, 14, OUT)                                                                                                \
    X(BO_8, B, 15, OUT)                                                                                                \
    X(LED_1, D, 12, OUT)                                                                                               \
    X(LED_2, D, 13, OUT)                                                                                               \
    X(LED_3, D, 14, OUT)                                                                                               \
    X(LED_4, D, 15, OUT)                                                                                               \
    X(S1_1, E, 4, IN_UP)                                                                                               \
    X(S1_2, E, 5, IN_UP)                                                                                               \
    X(S1_3, E, 6, IN_UP)                                                                                               \
    X(S1_4, E, 7, IN_UP)

/* ENABLE of the drivers: one for each, or EN_ALL. They go on so long before a first pulse, 200 us at most, and off when
 * no motor has moved for the idle time; 0: never. */
#define BOARD_ENABLE_PINS(X)                                                                                           \
    X(EN_1, D, 0, OUT)                                                                                                 \
    X(EN_2, D, 1, OUT)                                                                                                 \
    X(EN_3, D, 2, OUT)                                                                                                 \
    X(EN_4, D, 3, OUT)
#define BOARD_ENABLE_READY_US 200U
#define BOARD_ENABLE_IDLE_MS 60000U

/* Where the bring-up image captures what a wire brings: channel 1 of TIM1 or TIM4. Nothing else of the board is at
 * that pin. */
#define BOARD_CAPTURE_PINS(X) X(CAPTURE, A, 8, TIM1_CH1)

/* Pins that parts on the board drive or load; checked, not used. */
#define BOARD_TAKEN(X)                                                                                                 \
    X(A, 0, "button B1")                                                                                               \
    X(A, 4, "audio")                                                                                                   \
    X(A, 6, "accelerometer")                                                                                           \
    X(A, 7, "accelerometer")                                                                                           \
    X(A, 9, "USB")                                                                                                     \
    X(A, 10, "USB")                                                                                                    \
    X(A, 11, "USB")                                                                                                    \
    X(A, 12, "USB")                                                                                                    \
    X(B, 3, "SWO")                                                                                                     \
    X(B, 6, "audio")                                                                                                   \
    X(B, 9, "audio")                                                                                                   \
    X(B, 10, "microphone")                                                                                             \
    X(B, 2, "BOOT1")                                                                                                   \
    X(C, 0, "USB")                                                                                                     \
    X(C, 3, "microphone")                                                                                              \
    X(C, 7, "audio")                                                                                                   \
    X(C, 10, "audio")                                                                                                  \
    X(C, 12, "audio")                                                                                                  \
    X(D, 4, "audio") X(D, 5, "USB") X(E, 0, "accelerometer") X(E, 1, "accelerometer") X(E, 3, "accelerometer")

/* Pins without a signal that are pulled up, so that a part beside them rests. */
#define BOARD_PULLED_UP(X) X(E, 3, "chip select of the accelerometer")

#define BOARD_PACKAGE "LQFP100"
#define BOARD_CRYSTAL_MHZ 8U
#define BOARD_USART 3

/* The supply at the part: the lowest in good order (3.0 V behind a diode; 2.89 to 2.94 V were measured on such boards);
 * level of the voltage detector below which the flash is not written; bytes written at a time; level of the brown-out
 * reset that `board options` sets (3 is the highest). stm32_supply.c checks that they fit to each other. */
#define BOARD_SUPPLY_MIN_MV 2890U
#define BOARD_DETECT_LEVEL 4U
#define BOARD_FLASH_BYTES 2U
#define BOARD_BROWN_OUT_LEVEL 2U

/* The level at the pin that means 1: 1 high, 0 low. Opto-isolators pull an input low; a switch that is ON closes to
 * ground. */
#define BOARD_STEP_LEVEL 1U
#define BOARD_DIR_LEVEL 1U
#define BOARD_ENABLE_LEVEL 0U
#define BOARD_BI_LEVEL 0U
#define BOARD_BO_LEVEL 1U
#define BOARD_LED_LEVEL 1U
#define BOARD_S1_LEVEL 0U

/* What the drivers of the motors need at least: STEP high, STEP low, DIR before and after a rising edge of STEP. These
 * are those of common drivers with opto-isolated inputs. */
#define BOARD_STEP_HIGH_NS 2500U
#define BOARD_STEP_LOW_NS 2500U
#define BOARD_DIR_SETUP_NS 5000U
#define BOARD_DIR_HOLD_NS 5000U

#endif
