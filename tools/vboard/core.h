/*
 * The private peripherals of the core at E0000000: SysTick (PM0214 section 4.5), the cycle counter of DWT (ARMv7-M
 * C1.8), and the way to NVIC, SCB and the identification of the part (DBGMCU, RM0090 section 38.6).
 */
#ifndef CORE_H
#define CORE_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "nvic.h"
#include "scb.h"

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

struct core_wires {
    struct clock *clock;
    struct nvic *nvic;
    struct scb *scb;
    uint32_t idcode; /* DBGMCU_IDCODE */
};

struct core {
    struct core_wires wires;
    struct systick systick;
    struct dwt dwt;
    struct debug debug;
};

/* DBGMCU_IDCODE of revision A, which names itself as an STM32F2 does (errata ES0182). */
#define CORE_IDCODE_A UINT32_C(0x20006411)

void core_init(struct core *core, struct core_wires wires);
void core_reset(struct core *core);
bool core_read(struct core *core, uint32_t address, uint32_t *value);
bool core_write(struct core *core, uint32_t address, uint32_t value, uint32_t mask);

#endif
