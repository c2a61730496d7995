/*
 * The seam to the clock.
 */
#ifndef HAL_TIME_H
#define HAL_TIME_H

#include <stdint.h>

/* The unit's time in ticks (base_tick.h), never going back and never wrapping; it may begin at any value. Its low 32
 * bits are the counter that hal_step compares with. Main, plan and tick interrupt. */
uint64_t hal_time_now(void);

#endif
