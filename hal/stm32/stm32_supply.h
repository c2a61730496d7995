/*
 * Thresholds of the part's supply, in millivolts: of the voltage detector by its level (PLS, RM0090 5.4.1) and of the
 * brown-out reset by its level (3 is the highest; 0: none). From the data sheet DS8626, table "embedded reset and power
 * control block characteristics"; the voltages in the reference manual are names, not thresholds. A board says in
 * board.h which it needs; stm32_supply.c checks that they fit to its supply.
 */
#ifndef STM32_SUPPLY_H
#define STM32_SUPPLY_H

/* Where a supply that comes up is good at the latest, and one that falls is told at the latest. Level 5 is left out:
 * its falling threshold has a range of 370 mV. */
#define STM32_DETECT_RISING_MAX_MV(level)                                                                              \
    ((level) == 7U ? 3210U : (level) == 6U ? 3100U : (level) == 4U ? 2820U : (level) == 3U ? 2650U : 9999U)
#define STM32_DETECT_FALLING_MIN_MV(level)                                                                             \
    ((level) == 7U ? 2950U : (level) == 6U ? 2850U : (level) == 4U ? 2590U : (level) == 3U ? 2440U : 0U)

/* Where the part starts at the latest, and is held in reset at the latest. */
#define STM32_BROWN_OUT_RISING_MAX_MV(level)                                                                           \
    ((level) == 3U ? 2970U : (level) == 2U ? 2630U : (level) == 1U ? 2330U : 0U)
#define STM32_BROWN_OUT_FALLING_MIN_MV(level)                                                                          \
    ((level) == 3U ? 2750U : (level) == 2U ? 2440U : (level) == 1U ? 2130U : 1600U)

/* What the flash needs to be written 4, 2 or 1 bytes at a time (RM0090 3.6.2). */
#define STM32_FLASH_MIN_MV(bytes) ((bytes) == 4U ? 2700U : (bytes) == 2U ? 2100U : (bytes) == 1U ? 1800U : 9999U)

/* Wait states for 168 MHz down to a voltage (RM0090 3.5.1). */
#define STM32_WAIT_STATES(mv) ((mv) >= 2700U ? 5U : (mv) >= 2400U ? 6U : 7U)

#endif
