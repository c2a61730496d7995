/*
 * Units of time: seconds and nanoseconds of people and files, ticks of the unit. Pure, except for the real clock.
 */
#ifndef UNITS_H
#define UNITS_H

#include <stdint.h>

#define NS_PER_SECOND UINT64_C(1000000000)

/* The nearest tick, the nearest nanosecond; exact for 20 years and more. */
uint64_t units_ticks_of_ns(uint64_t ns);
uint64_t units_ns_of_ticks(uint64_t ticks);

/* Speed for an interval between two pulses, in thousandths of a step/s, rounded to the nearest. */
uint64_t units_milli_speed(uint64_t interval_ticks);

/* Real time, ns from some moment; only differences mean anything. */
uint64_t units_real_ns(void);

#endif
