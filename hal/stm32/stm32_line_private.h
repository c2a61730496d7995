/*
 * What both lines, stm32_line_half.c and stm32_line_full.c, have in common: two rings whose counts wrap with 32 bits.
 * Each count is written on one side only: of what was received, `in` where bytes come and `out` by main; of what is
 * sent the other way round.
 */
#ifndef STM32_LINE_PRIVATE_H
#define STM32_LINE_PRIVATE_H

#include <assert.h>

#include "hal_line.h"
#include "image.h"
#include "stm32_line.h"
#include "stm32_pins.h"
#include "stm32_private.h"

enum {
    /* Powers of two. Half duplex: 66 ms of a full line; full duplex: what may come while the flash is written. */
    RECEIVED_MAX = IMAGE_LINE_FULL_DUPLEX ? 512 : 128,
    SENDING_MAX = 64,
    TIME_PLACE = IMAGE_LINE_FULL_DUPLEX ? 16 : 0
};

/* The time of a byte, in units of 2^TIME_PLACE ticks: full duplex it is not known better than to a millisecond. */
#if IMAGE_LINE_FULL_DUPLEX
typedef uint16_t stm32_line_time;
#else
typedef uint32_t stm32_line_time;
#endif

enum {
    RECEIVED_BROKEN = 0x100,
};

struct stm32_line {
    stm32_line_time received_time[RECEIVED_MAX];
    uint16_t received[RECEIVED_MAX]; /* a byte, and whether it is broken */
    uint8_t sending[SENDING_MAX];
    volatile uint32_t received_in;
    volatile uint32_t received_out;
    volatile uint32_t sending_in;
    volatile uint32_t sending_out;
};
extern struct stm32_line stm32_line;

/* What BRR holds: clocks of the bus in a bit, of which there are 16 samples (RM0090 30.3.4). */
#define STM32_LINE_DIVIDER(hz, bd) (((hz) + (bd) / 2U) / (bd))

/* Keeps a byte as number `in`; returns the number of the next one. One too many is lost, and the one before it broken.
 */
static inline uint32_t stm32_line_keep(uint32_t in, uint32_t tick, uint8_t value, bool broken)
{
    if (in - stm32_line.received_out == (uint32_t)RECEIVED_MAX) {
        stm32_line.received[(in - 1U) % RECEIVED_MAX] |= (uint16_t)RECEIVED_BROKEN;
        return in;
    }
    stm32_line.received_time[in % RECEIVED_MAX] = (stm32_line_time)(tick >> (uint32_t)TIME_PLACE);
    stm32_line.received[in % RECEIVED_MAX] = (uint16_t)(value | (broken ? (unsigned)RECEIVED_BROKEN : 0U));
    return in + 1U;
}

/* The oldest ones, for hal_line_read and hal_line_read_run. */
bool stm32_line_take(struct hal_line_byte *byte);
bool stm32_line_take_run(struct hal_line_run *run, uint8_t last);

#endif
