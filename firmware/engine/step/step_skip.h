/*
 * Skips pulses of a segment: for whoever looks for a pulse that comes later, where walking there takes too long. Four
 * motors at 200 000 steps/s that stop on one edge have 100 pulses to go each.
 */
#ifndef STEP_SKIP_H
#define STEP_SKIP_H

#include <stdbool.h>
#include <stdint.h>

#include "step_generator.h"

/* So many at once at most; 1, and nobody skips, where the build says so as the image is to be small. */
#ifndef STEP_SKIP_MAX
#define STEP_SKIP_MAX 8U
#endif

/* Moves on by so many pulses at once, from 1 to STEP_SKIP_MAX, which the segment must have left. All but the interval,
 * which is their mean, is then as if step_generator_next had been called for each. False, and nothing is changed, where
 * they come more than 40 us apart, or where one look does not find the tick. */
bool step_skip(struct step_generator *generator, uint32_t pulses);

#endif
