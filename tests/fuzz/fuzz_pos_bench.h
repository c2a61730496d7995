/*
 * A whole positioning unit for the fuzzer, on the host machine, with what holds at any time:
 *
 * the motors' steps are those at the pins; pulses come only while the axis shows that it moves, 5 us less 2 ticks
 * apart, and DIR has stood before them; no axis goes on towards an active limit; no pulse leads a referenced axis
 * further out of its software limits; a bus that is silent for WATCHDOG leaves no axis taken but faulty ones; every
 * request gets what the contract says, judged by what stood before it: an exception, the result of an instruction, and
 * nothing else changed; a word that has been executed is not executed again.
 */
#ifndef FUZZ_POS_BENCH_H
#define FUZZ_POS_BENCH_H

#include <stdbool.h>
#include <stdint.h>

#include "host_machine.h"
#include "positioning.h"

enum {
    FUZZ_POS_PULSES_MAX = 1500,
    FUZZ_POS_PASSES_MAX = 1500,
    FUZZ_POS_HEARD_MAX = 512,
    FUZZ_POS_BYTE_TICKS = 800, /* the line is quicker than it should be, so that frames take no time */
};

/* What stood before a pass. */
struct fuzz_pos_axis {
    struct pos_order order;
    struct pos_frame frame;
    uint32_t feed;
    uint16_t error;
    uint8_t state;
    bool waits;
    bool busy;
    bool permitted;
    bool armed;
};

struct fuzz_pos_before {
    struct pos_registers registers;
    struct fuzz_pos_axis axes[POS_AXES];
    uint32_t counts[MODBUS_COUNTS_TOTAL];
    uint32_t flash_operations;
    bool damaged;
    bool other;
};

struct fuzz_pos {
    struct pos_unit unit;
    struct host_machine machine;
    struct fuzz_pos_before before;
    int64_t pin[UNIT_MOTORS];         /* pulses at the pins since the start */
    uint64_t pulse_tick[UNIT_MOTORS]; /* of the last one; 0: none */
    uint64_t turn_tick[UNIT_MOTORS];  /* of the last change of DIR; 0: none */
    uint64_t input_tick;              /* of the last change of an input */
    uint32_t passes;
    uint64_t heard_tick;              /* the end of the last frame to this unit that an independent reader found good */
    uint32_t executed;                /* requests that have got no exception */
    uint32_t stores;                  /* those of them that stored all settings */
    uint8_t sent[FUZZ_POS_HEARD_MAX]; /* by the unit, since the harness has read it */
    uint32_t sent_count;
    uint64_t hash;
};

/* The unit with an erased flash, just switched on at one of four epochs. */
struct fuzz_pos *fuzz_pos_begin(unsigned epoch);

/* Off and on. */
void fuzz_pos_restart(struct fuzz_pos *fuzz, enum hal_board_cause cause, bool crystal);

/* Time goes by, less if the run is over. */
void fuzz_pos_run(struct fuzz_pos *fuzz, uint64_t ticks);

bool fuzz_pos_is_over(const struct fuzz_pos *fuzz);

/* Whether all settings of two units are the same. */
bool fuzz_pos_same_settings(const struct pos_registers *a, const struct pos_registers *b);

#endif
