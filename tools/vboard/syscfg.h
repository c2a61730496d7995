/*
 * System configuration (RM0090 chapter 9), which is little more than registers here: it puts pins on the lines of EXTI,
 * and SRAM1 at address 0.
 */
#ifndef SYSCFG_H
#define SYSCFG_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "exti.h"
#include "memory.h"

enum {
    SYSCFG_EXTICRS = 4
};

struct syscfg {
    struct exti *exti;
    struct memory *memory;
    struct clock *clock;
    uint32_t memrmp;
    uint32_t pmc;
    uint16_t exticr[SYSCFG_EXTICRS];
};

void syscfg_reset(struct syscfg *syscfg);
bool syscfg_read(void *model, uint32_t offset, uint32_t *value);
bool syscfg_write(void *model, uint32_t offset, uint32_t value, uint32_t mask);

#endif
