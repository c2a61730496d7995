/*
 * BIGTREETECH's SKR Pro V1.2 (STM32F407ZGT6, LQFP144, 8 MHz crystal), a board for printers with sockets for drivers: X,
 * Y, Z and E0 are motors 1 to 4. README.md beside this file has the same pins as a table, with connectors and sources.
 *
 * X(signal, port, pin, use): each signal's pin. `use` is IN, IN_UP (pull-up) or OUT, or the peripheral that has the
 * pin; GPIO: an interrupt writes it.
 */
#ifndef BOARD_H
#define BOARD_H

#define BOARD_PINS(X)                                                                                                  \
    X(STEP_1, E, 9, GPIO)                                                                                              \
    X(STEP_2, E, 11, GPIO)                                                                                             \
    X(STEP_3, E, 13, GPIO)                                                                                             \
    X(STEP_4, E, 14, GPIO)                                                                                             \
    X(DIR_1, F, 1, OUT)                                                                                                \
    X(DIR_2, E, 8, OUT)                                                                                                \
    X(DIR_3, C, 2, OUT)                                                                                                \
    X(DIR_4, A, 0, OUT)                                                                                                \
    X(LINE_DE, D, 10, OUT)                                                                                             \
    X(LINE_TX, D, 8, USART3)                                                                                           \
    X(LINE_RX, D, 9, USART3)                                                                                           \
    X(BI_1, B, 10, IN_UP)                                                                                              \
    X(BI_2, E, 12, IN_UP)                                                                                              \
    X(BI_3, G, 8, IN_UP)                                                                                               \
    X(BI_4, E, 15, IN_UP)                                                                                              \
    X(BI_5, E, 10, IN_UP)                                                                                              \
    X(BI_6, G, 5, IN_UP)                                                                                               \
    X(BI_7, A, 1, IN_UP)                                                                                               \
    X(BI_8, A, 2, IN_UP)                                                                                               \
    X(BO_1, B, 1, OUT)                                                                                                 \
    X(BO_2, D, 14, OUT)                                                                                                \
    X(BO_3, B, 0, OUT)                                                                                                 \
    X(BO_4, D, 12, OUT)                                                                                                \
    X(BO_5, C, 8, OUT)                                                                                                 \
    X(BO_6, E, 5, OUT)                                                                                                 \
    X(BO_7, E, 6, OUT)                                                                                                 \
    X(BO_8, C, 9, OUT)                                                                                                 \
    X(LED_1, A, 7, OUT)                                                                                                \
    X(LED_2, G, 3, OUT)                                                                                                \
    X(LED_3, G, 6, OUT)                                                                                                \
    X(LED_4, G, 7, OUT)                                                                                                \
    X(S1_1, F, 11, IN_UP)                                                                                              \
    X(S1_2, F, 12, IN_UP)                                                                                              \
    X(S1_3, G, 10, IN_UP)                                                                                              \
    X(S1_4, B, 12, IN_UP)

/* ENABLE of the drivers: one for each, or EN_ALL. They go on so long before a first pulse, 200 us at most, and off when
 * no motor has moved for the idle time; 0: never. */
#define BOARD_ENABLE_PINS(X)                                                                                           \
    X(EN_1, F, 2, OUT)                                                                                                 \
    X(EN_2, D, 7, OUT)                                                                                                 \
    X(EN_3, C, 0, OUT)                                                                                                 \
    X(EN_4, C, 3, OUT)
#define BOARD_ENABLE_READY_US 200U
#define BOARD_ENABLE_IDLE_MS 120000U

/* Where the bring-up image captures what a wire brings: channel 1 of TIM1 or TIM4. The pin is at EXP1 (BTN_ENC). */
#define BOARD_CAPTURE_PINS(X) X(CAPTURE, A, 8, TIM1_CH1)

/* Pins that parts on the board drive or load; checked, not used. */
#define BOARD_TAKEN(X)                                                                                                 \
    X(A, 4, "microSD")                                                                                                 \
    X(A, 5, "microSD")                                                                                                 \
    X(A, 6, "microSD")                                                                                                 \
    X(B, 5, "microSD")                                                                                                 \
    X(B, 11, "microSD")                                                                                                \
    X(A, 11, "USB")                                                                                                    \
    X(A, 12, "USB")                                                                                                    \
    X(A, 9, "TFT header")                                                                                              \
    X(A, 10, "TFT header")                                                                                             \
    X(C, 6, "Wi-Fi socket")                                                                                            \
    X(C, 7, "Wi-Fi socket")                                                                                            \
    X(F, 14, "Wi-Fi socket")                                                                                           \
    X(F, 15, "Wi-Fi socket")                                                                                           \
    X(G, 0, "Wi-Fi socket")                                                                                            \
    X(G, 1, "Wi-Fi socket")                                                                                            \
    X(C, 14, "32 kHz crystal")                                                                                         \
    X(C, 15, "32 kHz crystal")                                                                                         \
    X(B, 2, "BOOT1")                                                                                                   \
    X(F, 3, "thermistor")                                                                                              \
    X(F, 4, "thermistor")                                                                                              \
    X(F, 5, "thermistor")                                                                                              \
    X(F, 6, "thermistor")                                                                                              \
    X(C, 10, "SPI of drivers")                                                                                         \
    X(C, 11, "SPI of drivers")                                                                                         \
    X(C, 12, "SPI of drivers")                                                                                         \
    X(A, 15, "driver X")                                                                                               \
    X(B, 8, "driver Y")                                                                                                \
    X(B, 9, "driver Z")                                                                                                \
    X(B, 3, "driver E0")                                                                                               \
    X(G, 15, "driver E1")                                                                                              \
    X(G, 12, "driver E2")                                                                                              \
    X(C, 13, "UART of driver X")                                                                                       \
    X(E, 3, "UART of driver Y")                                                                                        \
    X(E, 1, "UART of driver Z")                                                                                        \
    X(D, 4, "UART of driver E0")                                                                                       \
    X(D, 1, "UART of driver E1")                                                                                       \
    X(D, 6, "UART of driver E2")                                                                                       \
    X(D, 15, "driver E1")                                                                                              \
    X(E, 7, "driver E1")                                                                                               \
    X(A, 3, "driver E1")                                                                                               \
    X(D, 13, "driver E2")                                                                                              \
    X(G, 9, "driver E2")                                                                                               \
    X(F, 0, "driver E2")

/* Pins without a signal that are pulled up, so that a part beside them rests. */
#define BOARD_PULLED_UP(X)

/* The STEP pins are no channels of TIM2 and TIM5: class 2, stm32_gpio_step.c. */
#define BOARD_STEP_CLASS 2

/* What the loader of the board has of the flash; the image begins after it. */
#define BOARD_LOADER_BYTES 0x8000

/* The crystal is said to start too slowly for the chip's own loader by USB (README.md, Flashing): no dfu-util. */
#define BOARD_SLOW_CRYSTAL 1

#define BOARD_PACKAGE "LQFP144"
#define BOARD_CRYSTAL_MHZ 8U
#define BOARD_USART 3

/* The supply at the part: the lowest in good order (3.3 V less 5 %, as the accuracy of the board's regulator is not
 * known); level of the voltage detector below which the flash is not written; bytes written at a time; level of the
 * brown-out reset that `board options` sets (3 is the highest). stm32_supply.c checks that they fit to each other. */
#define BOARD_SUPPLY_MIN_MV 3135U
#define BOARD_DETECT_LEVEL 6U
#define BOARD_FLASH_BYTES 4U
#define BOARD_BROWN_OUT_LEVEL 3U

/* The level at the pin that means 1: 1 high, 0 low. A switch pulls an input low; a jumper that is ON closes to
 * ground. */
#define BOARD_STEP_LEVEL 1U
#define BOARD_DIR_LEVEL 1U
#define BOARD_ENABLE_LEVEL 0U
#define BOARD_BI_LEVEL 0U
#define BOARD_BO_LEVEL 1U
#define BOARD_LED_LEVEL 1U
#define BOARD_S1_LEVEL 0U

/* What the drivers of the motors need at least: STEP high, STEP low, DIR before and after a rising edge of STEP. These
 * are more than what modules with A4988, DRV8825 or TMC2209 need. */
#define BOARD_STEP_HIGH_NS 2500U
#define BOARD_STEP_LOW_NS 2500U
#define BOARD_DIR_SETUP_NS 5000U
#define BOARD_DIR_HOLD_NS 5000U

#endif
