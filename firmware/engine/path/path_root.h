/*
 * The root of base_wide.h, with divisions that the processor makes itself. Pure function; main or plan interrupt.
 */
#ifndef PATH_ROOT_H
#define PATH_ROOT_H

#include <stdint.h>

#include "base_wide.h"

/* The square root of value, rounded to the nearest whole number; value < 2^126. */
uint64_t path_root(struct wide value);

#endif
