/*
 * External interrupts (RM0090 chapter 12): edges at the pins that SYSCFG_EXTICR has put on the 16 lines (section 9.2)
 * become interrupts. Not modelled: events, and the lines of other blocks.
 */
#ifndef EXTI_H
#define EXTI_H

#include <stdbool.h>
#include <stdint.h>

#include "gpio.h"

struct board;

struct exti {
    uint32_t imr;
    uint32_t rtsr;
    uint32_t ftsr;
    uint32_t swier;
    uint32_t pending;
    uint16_t level;              /* of the lines */
    uint16_t routed[GPIO_PORTS]; /* lines that the port with this number has */
};

void exti_reset(struct board *board);

bool exti_read(struct board *board, unsigned instance, uint32_t offset, uint32_t *value);
bool exti_write(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask);

/* SYSCFG_EXTICR says which port has each line: four bits a line. A line whose level changes with it has an edge. */
void exti_route(struct board *board, uint64_t ports);

/* The pins of a port have changed, or what the program can see of them. */
void exti_follow(struct board *board, unsigned port);

#endif
