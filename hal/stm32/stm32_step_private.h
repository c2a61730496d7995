/*
 * The state of the step output and the inner functions of its two files: stm32_step.c lays pulses and takes them back,
 * stm32_step_setup.c does all else.
 *
 * A STEP pin is a channel of a timer in toggle mode (RM0090 18.3.8). At each match the pin changes, and the match asks
 * a stream of DMA1 for the next edge, which goes from a ring in memory into the compare register (10.3):
 *
 *      ring      rise 0 | fall 0 | rise 1 | fall 1 | never
 *                                   |        |
 *                          compare register  the stream's own: loaded when the one before went
 *
 * No code runs at an edge. After the last pulse laid comes an edge that is never, as the counter takes 25 s there. The
 * step interrupt comes while the last pulse is still LEAD_TICKS ahead, and lays what is due within HORIZON_TICKS.
 *
 * A DIR pin is a channel of TIM3 that goes to a level at a match (18.3.7), so a turn between two pulses is laid ahead
 * like they are. TIM3 counts the low half of the unit's time.
 *
 * The word that the stream has loaded is beyond recall. So what comes after it is taken back by one store; to take back
 * the edge in the compare register, too, the pin is forced low and the stream stopped. It then begins anew at the
 * ring's start.
 */
#ifndef STM32_STEP_PRIVATE_H
#define STM32_STEP_PRIVATE_H

#include <assert.h>

#include "base_limits.h"
#include "hal_step.h"
#include "stm32_private.h"
#include "stm32_step_times.h"
#include "stm32f4.h"

enum {
    /* A turn: after the rising edge of a pulse, and ahead of a look at the counter, while it is being written. */
    TURN_HOLD_TICKS = TICKS_OF_NS(BOARD_DIR_HOLD_NS) + TICKS_PER_US,
    TURN_TICKS = 2 * TICKS_PER_US,
    TURN_SETUP_TICKS = SETUP_TICKS + 4, /* TIM3 may be a tick or two off */
    TURN_US = (TICKS_OF_NS(BOARD_DIR_HOLD_NS) + SETUP_TICKS + 3 * TICKS_PER_US - 1) / TICKS_PER_US,

    /* A stop waits for the end of a pulse, with interrupts held off; the times below have room for 2.5 us of that. */
    WAIT_TICKS = WIDEST_TICKS > TICKS_OF_NS(2500U) ? WIDEST_TICKS - TICKS_OF_NS(2500U) : 0,

    /* The interrupt comes LEAD_TICKS before the last pulse laid at the latest. That leaves time for what holds it off
     * and for a portion of each of the other three motors. */
    LEAD_TICKS = 70 * TICKS_PER_US + UNIT_MOTORS * WAIT_TICKS,
    LAY_MAX = 8,
    LAY_FAST_MAX = 16,
    FAST_TICKS = 10 * TICKS_PER_US,

    /* A motor that has so much ahead gets a long portion, 14 us of work: the others, served in the order of what they
     * have ahead, have as much. */
    LONG_TICKS = 45 * TICKS_PER_US,

    ENTRY_TICKS = 25 * TICKS_PER_US, /* the interrupt serves what is not urgent for so long */

    /* What is laid can be taken back, so it may be far ahead: the more pulses at a time, the less each costs. A motor
     * that has less than NEAR_TICKS ahead is served along with others. */
    HORIZON_TICKS = 512 * TICKS_PER_US,
    NEAR_TICKS = HORIZON_TICKS / 2,

    /* With pulses of half a period two are laid ahead, but no further than that. */
    AHEAD_TICKS = 1000 * TICKS_PER_MS,
    TURN_AHEAD_TICKS = WIDEST_TICKS > HIGH_TICKS ? 2 * AHEAD_TICKS : HORIZON_TICKS,

    /* What is laid with all interrupts held off: so much that the interrupt is not due before four motors that stop
     * together have begun to brake. */
    RUN_TICKS = 2 * LEAD_TICKS,

    /* At most, from an edge until the next one is in the compare register and the one after it in the stream: four
     * streams asked at once while the processor has the bus take 40 ticks. */
    SETTLE_TICKS = 48,

    /* At most, from a look at the counter: until the first word of the ring is written, with the longest search for its
     * tick; until a stream that has been started waits for its first edge; from pulses taken back to others laid. */
    APPEND_TICKS = 10 * TICKS_PER_US,
    APPEND_LEFT_TICKS = APPEND_TICKS + TICKS_PER_US, /* where the look was at the interrupt's begin */
    START_TICKS = 2 * TICKS_PER_US,
    FAR_TICKS = 2 * LEAD_TICKS,
    REACT_TICKS = 7 * TICKS_PER_US + (UNIT_MOTORS - 1) * WAIT_TICKS,

    /* What is taken back is as far ahead as that: the pulse before it, if the stream goes on; or else itself. */
    CUT_TICKS = REACT_TICKS + APPEND_LEFT_TICKS,
    STOP_TICKS = REACT_TICKS + START_TICKS,

    /* Between late pulses: four motors that are late together must not ask for more than the streams can do. */
    CATCH_UP_TICKS = LOW_TICKS > 2 * SETTLE_TICKS ? LOW_TICKS : 2 * SETTLE_TICKS,
    GOOD_TICKS = 12, /* what a pulse that is made good takes */
    SOON_TICKS = 48, /* a compare value nearer than that may be past when it arrives */
    STUCK_TICKS = 5 * TICKS_PER_MS,

    WIDEN_TICKS = 8 * TICKS_PER_US, /* what it takes to make the pulses of a portion wide, with margin */

    /* The first lead for a change of speed; where planning takes longer, the axis tries again with twice as much. */
    CHANGE_TICKS = 60 * TICKS_PER_US,

    RING_PULSES = IMAGE_STEP_RING_PULSES,
    RING_EDGES = 2 * RING_PULSES,
    LAY_LONG_MAX = RING_PULSES >= 128 ? 32 : 24,
    /* What has been made is known modulo the ring, and the edge that is never has a place. */
    WAITING_MAX = RING_PULSES - 2 - LAY_LONG_MAX,
};
#define NEVER_TICKS (UINT32_C(1) << 31)

static_assert((RING_PULSES & (RING_PULSES - 1)) == 0, "pulses are counted modulo the ring");
static_assert(LAY_LONG_MAX >= LAY_FAST_MAX, "a long portion is at least a fast one");
static_assert(HIGH_TICKS >= SETTLE_TICKS - 6 && LOW_TICKS >= SETTLE_TICKS - 6,
              "two edges are as far apart as streams need");

/* What a channel does with its pin, RM0090 18.4.7. */
enum {
    MODE_HIGH_ON_MATCH = 1,
    MODE_LOW_ON_MATCH = 2,
    MODE_TOGGLE = 3,
    MODE_HIGH = 5,
    MODE_LOW = 4, /* forced inactive; matches are flagged, and ask for the next edge, all the same, 18.3.7 */
    MODE_MASK = 7,
};

/* A channel of a timer, which has a pin. */
struct stm32_output {
    volatile uint32_t *compare;
    volatile uint32_t *mode; /* CCMR1 or CCMR2 */
    uint32_t *modes;         /* what the register holds; two channels share it */
    uint32_t mode_one;       /* mode 1 of this channel in the register */
};

struct stm32_channel {
    uintptr_t stream;
    uintptr_t timer;
    struct stm32_output step;
    struct stm32_output direction;
    uint32_t *asks;           /* what TIM_DIER holds */
    uint32_t event;           /* its bit in TIM_SR and TIM_EGR; in TIM_DIER it is DE_PLACE further */
    volatile uint32_t *clear; /* DMA1_LIFCR or DMA1_HIFCR */
    uint32_t flags;           /* of the stream, there */
    uint32_t laid;            /* pulses since the stream was started */
    uint32_t last_tick;       /* the last pulse laid rises; at rest: HIGH_TICKS before it fell */
    uint32_t from_tick;       /* the step interrupt has something to do for it from this tick on, */
    uint32_t due_tick;        /* and at this one at the latest */
    uint32_t turn_tick;       /* while it turns: DIR changes, */
    uint32_t turned;          /* before this pulse, counted since the stream was started */
    bool active;              /* the stream runs */
    bool ends;                /* nothing is laid any more before all has been made */
    bool turns;               /* nothing is laid any more before DIR has changed, */
    bool armed;               /* which TIM3 knows of */
    bool backward;            /* DIR with the pulse laid last */
    bool connected;
    bool reversed;        /* the levels of DIR are the other way round */
    uint32_t falling_bit; /* of the channel in TIM_CCER: its output is inverted */
    struct hal_step_pulse ring[RING_PULSES];
};

enum {
    DE_PLACE = 8,
    STREAM_FLAGS = 0x3D
};

struct stm32_step {
    struct hal_client client;
    bool may_move;
    uint32_t modes[3][2]; /* of TIM2, TIM5 and TIM3 */
    uint32_t asks[2];
    struct stm32_channel channel[UNIT_MOTORS];
};
extern struct stm32_step stm32_step;

static inline void set_mode(const struct stm32_output *output, uint32_t mode)
{
    uint32_t others = *output->modes & ~(MODE_MASK * output->mode_one);
    *output->modes = others | mode * output->mode_one;
    *output->mode = *output->modes;
}

/* The level of the DIR pin: that of forward while it is not connected. */
static inline bool direction_level(const struct stm32_channel *channel)
{
    return ((channel->connected && channel->backward) != channel->reversed) == (BOARD_DIR_LEVEL == 1U);
}

/* Whether matches of the channel ask its stream for the next edge. */
static inline void set_asking(const struct stm32_channel *channel, bool asks)
{
    uint32_t bit = channel->event << DE_PLACE;
    *channel->asks = asks ? *channel->asks | bit : *channel->asks & ~bit;
    TIM_DIER(channel->timer) = *channel->asks;
}

#endif
