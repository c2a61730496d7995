/*
 * External interrupts (RM0090 chapter 12): edges at the pins that SYSCFG_EXTICR has put on the 16 lines (section 9.2)
 * become interrupts, and so do changes of the voltage detector. Not modelled: events, other lines.
 */
#ifndef EXTI_H
#define EXTI_H

#include <stdbool.h>
#include <stdint.h>

#include "nvic.h"
#include "report.h"

enum {
    EXTI_LINES = 16,
    EXTI_PORTS = 9, /* A to I */
};

struct exti_wires {
    struct nvic *nvic;
    struct report *report;
    bool mask_first; /* --exti-mask-first */
};

struct exti {
    struct exti_wires wires;
    uint32_t imr;
    uint32_t rtsr;
    uint32_t ftsr;
    uint32_t swier;
    uint32_t pending;
    uint16_t level;              /* of the lines */
    uint16_t pins[EXTI_PORTS];   /* levels of the ports, as the program can see them */
    uint16_t routed[EXTI_PORTS]; /* lines that the port with this number has */
};

void exti_init(struct exti *exti, struct exti_wires wires);
void exti_reset(struct exti *exti);

bool exti_read(void *model, uint32_t offset, uint32_t *value);
bool exti_write(void *model, uint32_t offset, uint32_t value, uint32_t mask);

/* SYSCFG_EXTICR says which port has each line: four bits a line. A line whose level changes with it has an edge. */
void exti_route(struct exti *exti, uint64_t ports);

/* The output of the voltage detector has changed. */
void exti_follow_detector(struct exti *exti, bool low);

/* The pins of a port as the program can see them, which have changed perhaps. */
void exti_follow(struct exti *exti, unsigned port, uint16_t levels);

#endif
