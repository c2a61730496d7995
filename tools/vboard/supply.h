/*
 * The supply voltage over time, and what watches it: the voltage detector of PWR (RM0090 5.2.3, 5.4), power-on,
 * power-down and brown-out reset (5.2.1, 5.2.2) with the thresholds of the data sheet DS8626, table "embedded reset and
 * power control block characteristics". The voltage goes in steps of a millivolt.
 */
#ifndef SUPPLY_H
#define SUPPLY_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "conditions.h"
#include "exti.h"
#include "flash.h"
#include "report.h"
#include "reset.h"

enum {
    SUPPLY_POINTS_MAX = 16
};

/* Where in its range of the data sheet every threshold of the part lies. */
enum supply_corner {
    SUPPLY_LOW,
    SUPPLY_TYPICAL,
    SUPPLY_HIGH,
};

struct supply_wires {
    struct clock *clock;
    struct report *report;
    struct reset *reset;
    struct conditions *conditions; /* which get the voltage */
    struct flash *flash;
    struct exti *exti;
};

struct supply {
    struct supply_wires wires;
    struct {
        uint64_t ps;
        uint32_t mv;
    } point[SUPPLY_POINTS_MAX]; /* sorted by time; straight lines between them */
    unsigned points;
    enum supply_corner corner;
    uint32_t least_mv;   /* of the whole run */
    bool held;           /* in reset: the supply is too low, or was a moment ago */
    bool forgotten;      /* it has been so low that the RAM forgets */
    uint64_t release_ps; /* NEVER: not yet good again */
    uint32_t pwr_cr;
    bool low;            /* what the voltage detector says */
    uint64_t settled_ps; /* it can be believed from then on */
    unsigned brown_outs; /* resets by it */
};

void supply_init(struct supply *supply, struct supply_wires wires);

/* Reads the voltages, null for 3.3 V all the time. False after a complaint. */
bool supply_open(struct supply *supply, const char *text, enum supply_corner corner);

void supply_reset(struct supply *supply);

bool pwr_read(void *model, uint32_t offset, uint32_t *value);
bool pwr_write(void *model, uint32_t offset, uint32_t value, uint32_t mask);

#endif
