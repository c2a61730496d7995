/*
 * How a run without end is told from others inside engine/motion: by its steps. It would end after
 * 35 years at 16 000 steps/s.
 */
#ifndef MOTION_ENDLESS_H
#define MOTION_ENDLESS_H

#include <stdint.h>

#define MOTION_ENDLESS_STEPS (UINT64_C(1) << 44)

#endif
