/*
 * The independent watchdog (RM0090 chapter 21), on the low-speed oscillator.
 */
#ifndef IWDG_H
#define IWDG_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "rcc.h"
#include "report.h"
#include "reset.h"

struct iwdg_wires {
    struct clock *clock;
    struct report *report;
    struct reset *reset;
    struct rcc *rcc; /* whose oscillator it starts */
    uint64_t lsi_hz;
};

struct iwdg {
    struct iwdg_wires wires;
    bool started;
    bool unlocked;
    uint32_t prescaler;        /* PR */
    uint32_t reload;           /* RLR */
    uint64_t prescaler_end_ps; /* PVU is set until then */
    uint64_t reload_end_ps;    /* and RVU */
    uint64_t refreshes;
    uint64_t refreshed_ps;
    uint64_t longest_ps; /* between two refreshes */
};

void iwdg_init(struct iwdg *iwdg, struct iwdg_wires wires);
void iwdg_reset(struct iwdg *iwdg);

/* The prescaler has been set to its most, and the watchdog stands, so that this is not taken over before it runs. */
void iwdg_leave_slow(struct iwdg *iwdg);

bool iwdg_read(void *model, uint32_t offset, uint32_t *value);
bool iwdg_write(void *model, uint32_t offset, uint32_t value, uint32_t mask);

#endif
