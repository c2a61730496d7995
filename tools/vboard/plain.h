/*
 * Blocks that are little more than registers here: power control (RM0090 chapter 5), with its voltage detector, and
 * system configuration (chapter 9), of which exti.c has the part that puts pins on lines.
 */
#ifndef PLAIN_H
#define PLAIN_H

#include <stdbool.h>
#include <stdint.h>

struct board;

enum { PLAIN_EXTICRS = 4 };

struct plain {
    uint32_t pwr_cr;
    uint32_t supply_mv; /* a reset leaves it */
    uint32_t syscfg_pmc;
    uint16_t exticr[PLAIN_EXTICRS];
};

/* The supply voltage at power-on. */
enum { PLAIN_SUPPLY_MV = 3300 };

void plain_reset(struct board *board);
bool pwr_read(struct board *board, unsigned instance, uint32_t offset, uint32_t *value);
bool pwr_write(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask);
bool syscfg_read(struct board *board, unsigned instance, uint32_t offset, uint32_t *value);
bool syscfg_write(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask);

#endif
