/*
 * Reset and clock control (RM0090 chapter 7): oscillators with start-up times, a crystal that may be missing or fail,
 * PLL, dividers, clock enables, causes of resets. A clock tree outside the limits of the part ends the run.
 */
#ifndef RCC_H
#define RCC_H

#include <stdbool.h>
#include <stdint.h>

struct board;

enum {
    RCC_PLLCFGR = 0x04,
    RCC_CFGR = 0x08,
    RCC_AHB1ENR = 0x30,
    RCC_APB1ENR = 0x40,
    RCC_APB2ENR = 0x44,
    RCC_WORDS = 0x90 / 4,
};

#define RCC_PLLCFGR_HSE (UINT32_C(1) << 22) /* the PLL runs from the crystal */

/* Sources of the system clock, as in SW and SWS. */
enum rcc_source {
    RCC_SOURCE_HSI,
    RCC_SOURCE_HSE,
    RCC_SOURCE_PLL,
};

/* Why the part was reset; the flags of RCC_CSR follow from it. */
enum reset_cause {
    RESET_NONE,
    RESET_POWER,
    RESET_SOFTWARE,
    RESET_WATCHDOG,
    RESET_PIN,
    RESET_BROWN_OUT, /* the supply was too low, but not so low that the RAM forgets */
    RESET_HELD,      /* the supply is too low: the part stands still */
    RESET_CAUSES,
};

/* The clock enables: AHB1, APB1, APB2. */
enum {
    RCC_ENABLES = 3
};

struct rcc {
    uint32_t word[RCC_WORDS]; /* the registers as written, without the ready and status bits */
    uint64_t hse_ready_ps;    /* NEVER: off or missing */
    uint64_t hsi_ready_ps;
    uint64_t pll_ready_ps;
    uint64_t lsi_ready_ps;
    uint64_t hse_gone_ps; /* when what was switched off is seen to be off */
    uint64_t pll_gone_ps;
    struct {
        uint32_t bits;  /* that were set last */
        uint64_t cycle; /* from then on what they stand for can be accessed */
    } enabled[RCC_ENABLES];
    unsigned source; /* enum rcc_source */
    bool crystal_failed;
    bool css_flag;
    uint32_t pclk1_divider; /* cycles of HCLK in one of APB1, APB2 */
    uint32_t pclk2_divider;
    uint32_t timer1_divider; /* cycles of HCLK in one of the timers' clock on APB1 */
    uint32_t reset_flags;
};

void rcc_reset(struct board *board, enum reset_cause cause);

bool rcc_read(struct board *board, unsigned instance, uint32_t offset, uint32_t *value);
bool rcc_write(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask);

/* Whether the bit of a clock enable register is set; offset 0 is what has no such bit. */
bool rcc_clock_is_on(const struct rcc *rcc, uint32_t offset, unsigned bit);

/* Whether it is so, and was set so long ago that the peripheral takes an access. */
bool rcc_clock_has_come(const struct board *board, uint32_t offset, unsigned bit);

/* Lets the part run from the PLL at 60 MHz, from the crystal or the internal oscillator. */
void rcc_run_from_pll(struct board *board, bool from_crystal);

/* Starts the low-speed oscillator, as the watchdog does. */
void rcc_start_lsi(struct board *board);

/* Lets the whole board run with the clocks that the registers ask for. */
void rcc_apply(struct board *board);

/* Ends the run if the clock tree, or the wait states of the flash with it, is outside the limits. */
void rcc_check_limits(struct board *board);

void rcc_event(struct board *board, uint64_t cycle);
void rcc_crystal_event(struct board *board, uint64_t cycle);

#endif
