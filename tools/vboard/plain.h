/*
 * A block that is little more than registers here: system configuration (RM0090 chapter 9), of which exti.c has the
 * part that puts pins on lines.
 */
#ifndef PLAIN_H
#define PLAIN_H

#include <stdbool.h>
#include <stdint.h>

struct board;

enum {
    PLAIN_EXTICRS = 4
};

struct plain {
    uint32_t syscfg_pmc;
    uint16_t exticr[PLAIN_EXTICRS];
};

void plain_reset(struct board *board);
bool syscfg_read(struct board *board, unsigned instance, uint32_t offset, uint32_t *value);
bool syscfg_write(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask);

#endif
