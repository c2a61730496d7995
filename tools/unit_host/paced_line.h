/*
 * One unit that follows a real clock and is spoken to in bytes of its line, for who has neither sockets nor files, as
 * the worker of a page: modules for WebAssembly export these functions.
 *
 * Real time is the caller's, in ns from any moment, and does not go back. What the unit stores is kept until it ends.
 */
#ifndef PACED_LINE_H
#define PACED_LINE_H

#include <stdbool.h>
#include <stdint.h>

#include "unit_kind.h"

enum {
    PACED_LINE_BYTES_MAX = 8192 /* of those that wait for the unit, or for the caller */
};

struct paced_line;

/* A unit after power-on with an erased flash, on whose line a byte takes so long; 350 kB of the heap. Null: there is
 * not memory enough. */
struct paced_line *paced_line_begin(const struct unit_kind *kind, uint32_t byte_ticks, uint64_t real_ns);

/* Lets the unit run as far as the clock has come, a slice at most. True: it is behind yet, call again. If it is more
 * than SERVE_LAG_MS_MAX behind, nobody has called for so long: its time has stood, and goes on from where it is. */
bool paced_line_follow(struct paced_line *paced, uint64_t real_ns);

/* Where bytes are to be put that the unit is to hear, PACED_LINE_BYTES_MAX; and gives it so many of them, after those
 * that are on the line. What does not fit in with these is lost, as on a line that nobody listens to. */
uint8_t *paced_line_bytes(struct paced_line *paced);
void paced_line_hear(struct paced_line *paced, uint32_t count);

/* What it has said since the last call stands where paced_line_said tells, until the next paced_line_follow. */
const uint8_t *paced_line_said(const struct paced_line *paced);
uint32_t paced_line_take_said(struct paced_line *paced);

/* Gives an input from 1 a level now, as files and orders have it (unit_kind.h). */
void paced_line_set_input(struct paced_line *paced, uint32_t input, bool level);

/* The real time, of all so far, in which the unit's time stood. */
uint64_t paced_line_stood_ns(const struct paced_line *paced);

#endif
