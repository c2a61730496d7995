/*
 * The conditions that the part runs in, as its data sheet calls them: HCLK with the dividers of the buses, the supply,
 * and the wait states of the flash. Those who set them look at the limits of all together.
 */
#ifndef CONDITIONS_H
#define CONDITIONS_H

#include <stdint.h>

#include "clock.h"
#include "report.h"

struct conditions {
    struct clock *clock;
    struct report *report;
    uint32_t pclk1_divider; /* cycles of HCLK in one of APB1, APB2 */
    uint32_t pclk2_divider;
    uint32_t timer1_divider; /* cycles of HCLK in one of the timers' clock on APB1; 0: no clock yet */
    uint32_t timer2_divider; /* the same on APB2 */
    uint32_t supply_mv;
    unsigned flash_latency; /* of FLASH_ACR */
};

/* Ends the run if the conditions are outside the limits. */
void conditions_check(struct conditions *conditions);

#endif
