/*
 * The waveform file of a simulation.
 *
 * Wires: m1_step, m1_dir, m1_led ... m4_led, bi1 ... bi8, bo1 ... bo8; of a unit that has names for its LEDs these in
 * place of m1_led ... m4_led. Wires have the levels of the pins. Reals: m1_position (steps), m1_speed (steps/s) ...
 * m4_speed; pwm (per cent) where there is one. The speed changes at each pulse of a move to 1 / (time since the pulse
 * before, or since the start of the move) and goes to 0 at the end of the move, and where the pulse before did not
 * reach the pin.
 */
#ifndef WAVES_H
#define WAVES_H

#include <stdint.h>

#include "base_limits.h"
#include "outfile.h"
#include "timeline.h"
#include "unit_kind.h"
#include "vcd.h"

/* What the pins of a motor show. */
struct waves_pins {
    bool high; /* a pulse is being made */
    bool backward;
    bool falling; /* STEP is high at rest */
    bool turned;  /* DIR is high forward */
};

struct waves {
    struct vcd vcd;
    const struct unit_kind *kind;
    struct waves_pins pins[UNIT_MOTORS];
    uint64_t milli_speed[UNIT_MOTORS]; /* the speed that was written last */
    uint8_t inputs;
    uint8_t outputs;
};

/* Writes the head: inputs as they are at the start, all other wires and reals at 0. */
void waves_begin(struct waves *waves, struct outfile *file, const struct unit_kind *kind);

/* Writes what an event changes; events come in order of time. */
void waves_put(struct waves *waves, const struct timeline_event *event);

/* Ends the file with the time up to which it is known that nothing more happens. */
void waves_end(struct waves *waves, uint64_t end_tick);

#endif
