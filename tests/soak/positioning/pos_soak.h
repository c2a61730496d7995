/*
 * A positioning unit on the host machine, and the master of its soak test: how they talk, and what the pins show.
 */
#ifndef POS_SOAK_H
#define POS_SOAK_H

#include <stdbool.h>
#include <stdint.h>

#include "host_machine.h"
#include "positioning.h"

enum {
    POS_SOAK_FRAME_MAX = 256,
    POS_SOAK_CYCLE_MS = 15,     /* of the master: a request in each */
    POS_SOAK_RATE_MAX = 100000, /* steps/s */
    POS_SOAK_WORDS_MAX = 16,
};

/* A motor as its pins show it: with the backlash of its axis between it and the position. */
struct pos_soak_motor {
    int64_t position; /* steps */
    int64_t slack;
    int64_t backlash; /* steps */
    uint64_t pulses;
    uint64_t last_tick;
};

struct pos_soak {
    struct host_machine machine;
    struct pos_unit unit;
    struct pos_soak_motor motors[UNIT_MOTORS];
    struct host_line_byte script[POS_SOAK_FRAME_MAX];
    uint8_t request[POS_SOAK_FRAME_MAX];
    uint32_t request_length;
    uint8_t heard[POS_SOAK_FRAME_MAX];
    uint32_t heard_count;
    uint64_t requests;
    uint64_t since_start;   /* requests of the present start of the unit */
    uint64_t closest_ticks; /* between two pulses of a motor */
    const char *trouble;    /* the first promise that was broken; null: none */
    uint64_t trouble_tick;
};

/* Switches a fresh unit on, at an epoch of the timer, with the line at 19 200 Bd. One at a time. */
void pos_soak_begin(struct pos_soak *soak, uint64_t epoch);

/* Turns the power off and on; the line is at 115 200 Bd from then on. */
void pos_soak_restart(struct pos_soak *soak);

/* A promise is broken unless the condition holds. */
void pos_soak_require(struct pos_soak *soak, bool good, const char *promise);

/* Writes registers (function 16), within so many ms. */
void pos_soak_write(struct pos_soak *soak, uint16_t first, uint32_t count, const uint16_t *words, uint32_t within_ms);

/* Writes registers and reads others in one request (function 23), in one cycle of the master. */
void pos_soak_write_and_read(struct pos_soak *soak, uint16_t first, uint32_t count, const uint16_t *words,
                             uint16_t from, uint32_t wanted);

/* Reads registers (function 4), in one cycle of the master. */
void pos_soak_read(struct pos_soak *soak, uint16_t from, uint32_t wanted);

/* Registers of the last answer. */
uint16_t pos_soak_word(const struct pos_soak *soak, uint32_t index);
uint32_t pos_soak_long(const struct pos_soak *soak, uint32_t index);

/* Lets time go by. */
void pos_soak_run(struct pos_soak *soak, uint32_t ms);

#endif
