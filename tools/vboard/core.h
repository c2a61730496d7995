/*
 * The private peripherals of the core at E0000000: SysTick (PM0214 section 4.5), the cycle counter of DWT (ARMv7-M
 * C1.8), and the way to NVIC, SCB and the identification of the part (DBGMCU, RM0090 section 38.6).
 */
#ifndef CORE_H
#define CORE_H

#include <stdbool.h>
#include <stdint.h>

struct board;

struct systick {
    bool enabled;
    bool interrupt;
    bool undivided; /* CLKSOURCE: HCLK, else HCLK / 8 */
    bool counted;   /* COUNTFLAG */
    uint32_t load;
    uint32_t value; /* at `anchor` */
    uint64_t anchor_cycle;
};

struct dwt {
    bool counting;
    uint32_t value; /* at `anchor`, while counting less it */
    uint64_t anchor_cycle;
};

struct debug {
    uint32_t cr;
    uint32_t freeze[2];
};

struct core {
    struct systick systick;
    struct dwt dwt;
    struct debug debug;
};

/* Errata ES0182: revision A has no prefetch that works, and names itself as an STM32F2 does. */
bool core_is_revision_a(const struct board *board);

void core_reset(struct board *board);
bool core_read(struct board *board, uint32_t address, uint32_t *value);
bool core_write(struct board *board, uint32_t address, uint32_t value, uint32_t mask);
void systick_event(struct board *board, uint64_t cycle);

#endif
