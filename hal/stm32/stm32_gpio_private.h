/*
 * The step output of class 2, for STEP pins that no channel of TIM2 or TIM5 has: an interrupt writes the pins. Its
 * state and the inner functions of its two files: stm32_gpio_step.c makes and lays pulses, stm32_gpio_setup.c does all
 * else. It stands in the place of stm32_step.c and stm32_step_setup.c where BOARD_STEP_CLASS is 2.
 *
 *   priority 0  TIM2   the edges: at a match of channel 1, which has no pin, all that are due are made. Held off by
 *                      PRIMASK only, for less than 1 us
 *   priority 1  TIM5   lays pulses into a ring a motor; pended by the edges, the timer itself is not used. Held off by
 *                      BASEPRI, hal_step_hold, for up to some 30 us
 *
 * So nothing that takes long holds an edge off, but other edges do: four motors whose edges fall together are served
 * one after the other. An edge is never early; how late the latest was is kept. Pulses that have not risen can all be
 * taken back, as nothing but the ring knows of them.
 */
#ifndef STM32_GPIO_PRIVATE_H
#define STM32_GPIO_PRIVATE_H

#include <assert.h>

#include "base_limits.h"
#include "hal_step.h"
#include "stm32_pins.h"
#include "stm32_private.h"
#include "stm32_step_times.h"
#include "stm32f4.h"

enum {
    /* What the class promises of an edge: a pulse that rises later counts as late. */
    LATE_TICKS = 4 * TICKS_PER_US,

    /* A turn of DIR is an edge, too: after the rising edge of a pulse, and with its own lateness before the next one.
     */
    TURN_HOLD_TICKS = TICKS_OF_NS(BOARD_DIR_HOLD_NS),
    TURN_US = (TURN_HOLD_TICKS + SETUP_TICKS + 2 * LATE_TICKS) / TICKS_PER_US,

    /* More is laid while the last pulse is so far ahead, up to the horizon; so many at a time. */
    LEAD_TICKS = 60 * TICKS_PER_US,
    HORIZON_TICKS = 512 * TICKS_PER_US,
    RUN_TICKS = 20 * TICKS_PER_US, /* what main lays */
    LAY_MAX = 8,
    AGAIN_TICKS = 5 * TICKS_PER_US, /* from a look at a ring in which nothing can be laid yet to the next one */

    SPIN_TICKS = TICKS_PER_US / 2, /* for an edge that is so near the interrupt does not end */
    SOON_TICKS = 48,
    STUCK_TICKS = 5 * TICKS_PER_MS,
    CHANGE_TICKS = 60 * TICKS_PER_US, /* the first lead for a change of speed */

    RING_PULSES = 64,
    WAITING_MAX = RING_PULSES - LAY_MAX,
    REFILL_IRQ = TIM5_IRQ,
    PRIORITY_PLACE = 4, /* four bits of priority, at the top of a byte; PM0214 4.3.7 */
};

static_assert(IMAGE_STEP_HIGH_NS == 0U, "an interrupt cannot make the width of a pulse that the unit promises");
static_assert(BOARD_DIR_HOLD_NS >= 1U, "BOARD_DIR_HOLD_NS must be 1 or more: an interrupt turns DIR after the pulse");
static_assert(!IMAGE_STEP_HALF, "an interrupt makes each pulse before it knows the next one");
static_assert((RING_PULSES & (RING_PULSES - 1)) == 0, "pulses are counted modulo the ring");

/* What the edges write is read by all others with the interrupt of edges held off, or is one word. */
struct stm32_gpio_channel {
    volatile uint32_t *pin;       /* BSRR of its port */
    uint32_t high_bits;           /* what that takes for a rising edge; 0: disconnected */
    uint32_t low_bits;            /* and for a falling one */
    volatile uint32_t laid;       /* pulses, modulo 2^32 */
    volatile uint32_t made;       /* of those */
    volatile bool pending;        /* an edge is to come: */
    volatile bool high;           /* a falling one */
    uint32_t edge_tick;           /* then */
    volatile uint32_t risen_tick; /* when the last pulse made has risen */
    uint32_t last_tick;           /* of the last pulse laid */
    uint32_t due_tick;            /* the refill has something to do for it then */
    volatile uint32_t *direction; /* BSRR of the port of DIR */
    uint32_t turn_bits;           /* what that takes for the turn to come */
    uint32_t turned;              /* DIR turns before this pulse, as `made` counts, */
    volatile bool turns;          /* if it does; more is laid after that */
    bool turns_next;              /* and that is the edge to come */
    bool active;                  /* pulses have been laid, and the client has not said that none is left */
    bool backward;                /* DIR with the pulse laid last */
    bool connected;
    bool falling;  /* the active edge of STEP falls */
    bool reversed; /* the levels of DIR are the other way round */
    struct hal_step_pulse ring[RING_PULSES];
};

struct stm32_gpio {
    struct hal_client client;
    bool may_move;
    bool called;          /* the refill has been, and has not come yet */
    uint32_t refill_tick; /* when it is called */
    uint32_t held_before; /* BASEPRI */
    struct stm32_gpio_channel channel[UNIT_MOTORS];
};
extern struct stm32_gpio stm32_gpio;

/* What BSRR takes for the level of DIR that a motor is to have. */
uint32_t stm32_gpio_direction_bits(unsigned motor);

/* The latest edge that there was. */
extern uint32_t stm32_step_worst_ticks;

/* The refill. */
void stm32_step_refill_interrupt(void);

#endif
