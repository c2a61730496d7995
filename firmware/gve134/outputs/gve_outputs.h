/*
 * Outputs: port 0, the relay, the spindle's speed and the LEDs.
 *
 * Comes in: what commands write, what the EEPROM says of the relay and the brake, and what the unit is doing. Goes out:
 * outputs of the board, PWM, LEDs. BO1 is the relay, BO5 to BO8 are OUT0 to OUT3. Main only; 40 bytes.
 */
#ifndef GVE_OUTPUTS_H
#define GVE_OUTPUTS_H

#include <stdbool.h>
#include <stdint.h>

#include "../../io/io.h"
#include "../memory/gve_memory.h"

enum {
    GVE_SPINDLE_MAX = 1000, /* thousandths */
};

/* What the unit is doing, as LEDs and relay show it. */
struct gve_doing {
    bool locked; /* no motion after a fault */
    bool inta;
    bool moves;
    uint8_t inputs; /* as io.h has them */
};

struct gve_outputs {
    struct io *io;
    uint64_t free_tick; /* from when on the time to the release of the brake counts; TICK_NEVER: it is not released */
    uint64_t data_tick; /* the LED Data is lit until then */
    uint8_t port;       /* active at 0 */
    uint8_t leds;       /* as they are shown */
};

/* All outputs off, spindle 0, LEDs dark. The brake's time begins where the unit is not locked. */
void gve_outputs_init(struct gve_outputs *outputs, struct io *io, bool locked, uint64_t now_ticks);

/* Writes the port; the PWM stays. */
void gve_outputs_write(struct gve_outputs *outputs, uint8_t port);

/* Spindle at so many thousandths; 0 also switches OUT0 off, others on. */
void gve_outputs_spindle(struct gve_outputs *outputs, uint32_t permille);

/* The lock has gone: the brake's time begins. */
void gve_outputs_unlock(struct gve_outputs *outputs, uint64_t now_ticks);

/* A byte has come or gone on the line. */
void gve_outputs_note_data(struct gve_outputs *outputs, uint64_t now_ticks);

/* Shows all of it. Returns when to call again at the latest. */
uint64_t gve_outputs_poll(struct gve_outputs *outputs, const struct gve_memory *memory, const struct gve_doing *doing,
                          uint64_t now_ticks);

#endif
