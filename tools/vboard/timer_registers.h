/*
 * What the program sees of a timer (RM0090 section 18.4). The model is a struct timer.
 */
#ifndef TIMER_REGISTERS_H
#define TIMER_REGISTERS_H

#include <stdbool.h>
#include <stdint.h>

bool timer_read(void *model, uint32_t offset, uint32_t *value);
bool timer_write(void *model, uint32_t offset, uint32_t value, uint32_t mask);

/* Whether a register has 32 bits that mean something. */
bool timer_register_is_wide(const void *model, uint32_t offset);

#endif
