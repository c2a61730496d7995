/*
 * The waveform file (IEEE 1364 value change dump): one-bit wires and reals, no vectors, timescale 1 ns.
 *
 * Wires: m1_step, m1_dir, m1_led ... m4_led, bi1 ... bi8, bo1 ... bo8. Reals: m1_position (steps), m1_speed (steps/s)
 * ... m4_speed. The speed changes at each pulse of a move to 1 / (time since the pulse before, or since the start of
 * the move) and goes to 0 at the end of the move, and where the pulse before did not reach the pin.
 */
#ifndef VCD_H
#define VCD_H

#include <stdint.h>

#include "base_limits.h"
#include "outfile.h"
#include "timeline.h"

struct vcd {
    struct outfile *file;
    uint64_t written_ns;               /* the time that was written last */
    uint64_t milli_speed[UNIT_MOTORS]; /* the speed that was written last */
    uint8_t inputs;
    uint8_t outputs;
};

/* Writes the head: all wires and reals at 0. */
void vcd_begin(struct vcd *vcd, struct outfile *file);

/* Writes what an event changes; events come in order of time. */
void vcd_put(struct vcd *vcd, const struct timeline_event *event);

/* Ends the file with the time up to which it is known that nothing more happens. */
void vcd_end(struct vcd *vcd, uint64_t end_tick);

#endif
