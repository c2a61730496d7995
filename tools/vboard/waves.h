/*
 * The waveform file, with the signals and units of the simulator's: wires m1_step, m1_dir, m1_led, bi1, bo1 and so on,
 * reals m1_position (steps) and m1_speed (steps/s, 1 / time since the pulse before; 0 when none has come for 50 ms);
 * and one wire more, `de`, the driver of the line. Timescale 1 ns, time from power-on.
 */
#ifndef WAVES_H
#define WAVES_H

#include <stdbool.h>
#include <stdint.h>

#include "outfile.h"
#include "pins.h"
#include "vcd.h"

struct waves {
    struct outfile file;
    struct vcd vcd;
    uint64_t pulse_ns[PINS_MOTORS]; /* of the last pulse, while the speed is not 0 */
    bool is_fast[PINS_MOTORS];      /* the speed that was written last is not 0 */
};

/* All of these do nothing if the file is not open. */
void waves_begin(struct waves *waves, const bool levels[SIGNALS]);
void waves_put_wire(struct waves *waves, unsigned signal, bool level, uint64_t ns);

/* Position and speed at a pulse whose wire has just been put; `interval` in cycles of `hz`, 0 for the first one. */
void waves_put_pulse(struct waves *waves, unsigned motor, int64_t position, uint64_t hz, uint64_t interval);
void waves_end(struct waves *waves, uint64_t ns);

#endif
