/*
 * A waveform file (IEEE 1364 value change dump): one-bit wires and reals, no vectors, timescale 1 ns. A signal is a
 * number from 0 on, which the file has as one printable character from '!' on.
 *
 * First vcd_begin, vcd_declare for each signal, vcd_begin_values, the first value of each, vcd_end_values; then, in
 * order of time, vcd_put_time and what changes.
 */
#ifndef VCD_H
#define VCD_H

#include <stdbool.h>
#include <stdint.h>

#include "outfile.h"

#define VCD_SIGNALS_MAX ('~' - '!')

struct vcd {
    struct outfile *file;
    uint64_t written_ns; /* the time that was written last */
};

enum vcd_type {
    VCD_WIRE,
    VCD_REAL,
};

/* A name in three parts: m, 1, _step. */
struct vcd_name {
    const char *before;
    unsigned number; /* 0: none */
    const char *after;
};

/* The program that writes it, as rkm04-host, of the unit rkm04, which is the scope of all signals. */
void vcd_begin(struct vcd *vcd, struct outfile *file, const char *program);
void vcd_declare(struct vcd *vcd, enum vcd_type type, unsigned signal, struct vcd_name name);
void vcd_begin_values(struct vcd *vcd);
void vcd_end_values(struct vcd *vcd);

/* Time in the file never goes back: what comes too late stands at the time written last. */
void vcd_put_time(struct vcd *vcd, uint64_t ns);

void vcd_put_wire(struct vcd *vcd, unsigned signal, bool level);

/* A real that is a whole number, or one in thousandths. */
void vcd_put_whole(struct vcd *vcd, unsigned signal, int64_t value);
void vcd_put_milli(struct vcd *vcd, unsigned signal, uint64_t milli);

#endif
