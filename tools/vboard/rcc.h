/*
 * Reset and clock control (RM0090 chapter 7): oscillators with start-up times, a crystal that may be missing or fail,
 * PLL, dividers, clock enables, causes of resets. A clock tree outside the limits of the part ends the run.
 */
#ifndef RCC_H
#define RCC_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "conditions.h"
#include "memory.h"
#include "nvic.h"
#include "report.h"
#include "reset.h"

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

/* The clock enables: AHB1, APB1, APB2. */
enum {
    RCC_ENABLES = 3
};

/* What the rest of the board does when the clocks change or registers of RCC reset it. */
struct rcc_outlet {
    void *board;
    void (*hold)(void *board); /* before and after a change of the clocks */
    void (*release)(void *board);
    void (*stop)(void *board);                                  /* the processor has no clock any more */
    void (*reset)(void *board, uint32_t offset, uint32_t bits); /* peripherals, by the bits of a reset register */
};

struct rcc_wires {
    struct clock *clock;
    struct report *report;
    struct nvic *nvic;
    struct conditions *conditions;
    struct memory *memory;
    struct rcc_outlet outlet;
    uint64_t crystal_hz;
    bool has_crystal;
};

struct rcc {
    struct rcc_wires wires;
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
    uint32_t reset_flags;
};

void rcc_init(struct rcc *rcc, struct rcc_wires wires);
void rcc_reset(struct rcc *rcc, enum reset_cause cause);

bool rcc_read(void *model, uint32_t offset, uint32_t *value);
bool rcc_write(void *model, uint32_t offset, uint32_t value, uint32_t mask);

/* Whether the bit of a clock enable register is set; offset 0 is what has no such bit. */
bool rcc_clock_is_on(const struct rcc *rcc, uint32_t offset, unsigned bit);

/* Whether it is so, and was set so long ago that the peripheral takes an access. */
bool rcc_clock_has_come(const struct rcc *rcc, uint32_t offset, unsigned bit);

/* Whether a reset register keeps it in reset: it takes no access then. */
bool rcc_is_held(const struct rcc *rcc, uint32_t offset, unsigned bit);

/* Lets the part run from the PLL at 60 MHz, which runs from the crystal if there is one. */
void rcc_run_from_pll(struct rcc *rcc);

/* Whether the low-speed oscillator runs. */
bool rcc_lsi_runs(const struct rcc *rcc);

/* Starts the low-speed oscillator, as the watchdog does. */
void rcc_start_lsi(struct rcc *rcc);

/* Lets the whole board run with the clocks that the registers ask for. */
void rcc_apply(struct rcc *rcc);

#endif
