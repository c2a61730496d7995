/*
 * The real step driver, of the image of a board, with a main that does what a list in the flash says: it fills step
 * channels, holds interrupts off, waits, halts, and notes how things are. Put in from outside are the acts; what was
 * noted stands in `notes`; what the pins have shown is known to the virtual board. Built with the image (target
 * step_acts_image).
 */
#include <stddef.h>

#include "driver.h"
#include "hal_board.h"
#include "hal_step.h"
#include "stm32_private.h"
#include "stm32f4.h"

enum {
    ACTS = 1500,
    NOTES = 400,
    STREAMS = 8,
};

enum what {
    ACTS_END,
    ACT_BEGIN,   /* of a move, backward if `steps` is 1 */
    ACT_PUSH,    /* a segment, as soon as there is room; marked if `marked` is 1 */
    ACT_RUN,     /* the channel */
    ACT_HALT,    /* the channel */
    ACT_REST,    /* until the channel rests */
    ACT_WAIT,    /* until `tick` */
    ACT_HOLD,    /* all interrupts off */
    ACT_RELEASE, /* and on again */
    ACT_CONNECT, /* STEP and DIR if `steps` is 1 */
    ACT_DIRECT,  /* DIR, backward if `steps` is 1 */
    ACT_QUIET,   /* the clock of the milliseconds stands still from now on */
    ACT_NOTE,
    ACT_REPLACE, /* what comes after the first pulse that is due `tick` from now or later by a segment; notes that */
    ACT_TURN,    /* what is pushed goes backward if `steps` is 1 */
    ACT_FREEZE,  /* the last `steps` pulses; notes whether it was in time */
    ACT_RECALL,  /* what is frozen, and go on with a segment, if `steps` is not 0, backward if `marked` is 1 */
};

struct act {
    uint32_t what;  /* and motor << 8, marked << 16 */
    uint32_t tick;  /* of the counter */
    uint64_t slope; /* as in struct step_segment, like the others */
    uint32_t pace_ticks;
    uint32_t steps;
};

struct note {
    uint32_t tick;
    uint32_t running;
    uint32_t pulses;  /* with interrupts on */
    uint32_t told;    /* main, since the last note */
    uint32_t stuck;   /* as the watchdog asks for */
    uint32_t asks;    /* requests to streams: of TIM2, and of TIM5 in the upper half */
    uint32_t streams; /* that are enabled, a bit each */
    uint32_t marked;  /* a marked segment has begun since the last note */
    uint32_t waiting;
};

extern const struct act acts[ACTS];
const struct act acts[ACTS] = {{.what = ACTS_END}};

extern struct note notes[NOTES];
struct note notes[NOTES];

void acts_done(void);

static unsigned noted;
static uint64_t frozen;

__attribute__((noinline)) void acts_done(void)
{
    __asm__ volatile("nop" ::: "memory");
}

static void wait_until(uint32_t tick)
{
    while ((int32_t)(TIM2_CNT - tick) < 0) {
        stm32_watchdog_main_lives();
    }
}

static void push(struct step_channel *channel, const struct act *act)
{
    const struct step_segment segment = {.slope = act->slope,
                                         .tick = act->tick,
                                         .pace_ticks = act->pace_ticks,
                                         .steps = act->steps,
                                         .marked = act->what >> 16 != 0};
    while (step_channel_room(channel) == 0) {
    }
    (void)step_channel_push(channel, &segment);
}

static void freeze(struct step_channel *channel, const struct act *act)
{
    frozen = act->steps;
    notes[noted++] = (struct note){.running = step_channel_freeze(channel, frozen), .tick = TIM2_CNT};
}

static void recall(struct step_channel *channel, const struct act *act)
{
    const struct step_segment segment = {
        .slope = act->slope, .tick = act->tick, .pace_ticks = act->pace_ticks, .steps = act->steps};
    step_channel_recall(channel, frozen, act->steps != 0 ? &segment : NULL, act->what >> 16 != 0);
    hal_step_hold();
    step_channel_thaw_held(channel);
    hal_step_release();
}

static void rest(const struct step_channel *channel)
{
    while (step_channel_is_running(channel)) {
        stm32_watchdog_main_lives();
    }
}

static uint32_t enabled_streams(void)
{
    uint32_t streams = 0;
    for (unsigned i = 0; i < STREAMS; i++) {
        streams |= (DMA_CR(DMA1_STREAM(i)) & DMA_CR_EN) << i;
    }
    return streams;
}

static void note(struct step_channel *channel)
{
    uint32_t mask = stm32_mask();
    notes[noted] = (struct note){
        .tick = TIM2_CNT,
        .running = step_channel_is_running(channel),
        .told = stm32_event_take(),
        .stuck = stm32_step_is_stuck(),
        .asks = TIM_DIER(TIM2_BASE) >> 9 | TIM_DIER(TIM5_BASE) >> 9 << 16,
        .streams = enabled_streams(),
        .marked = step_channel_take_mark(channel),
        .waiting = hal_step_waiting(channel->motor),
    };
    stm32_unmask(mask);
    notes[noted].pulses = mask == 0 ? (uint32_t)step_channel_pulses(channel) : 0;
    noted++;
}

/* Notes whether it was in time, the pulse that is the last on the old way, and its tick. */
static void replace(struct step_channel *channel, const struct act *act)
{
    struct step_cursor at = {.end = 0};
    bool replaced = false;
    if (step_channel_look_ahead(channel, TIM2_CNT + act->tick, &at)) {
        const struct step_segment segment = {.slope = act->slope,
                                             .tick = at.generator.tick + act->pace_ticks,
                                             .pace_ticks = act->pace_ticks,
                                             .steps = act->steps};
        replaced = step_channel_replace(channel, &at, &segment, 1);
    }
    notes[noted++] =
        (struct note){.running = replaced, .pulses = (uint32_t)step_cursor_pulse(&at), .tick = at.generator.tick};
}

static void do_channel(const struct act *act, unsigned motor)
{
    struct step_channel *channel = &channels[motor];
    switch (act->what & 0xFFU) {
    case ACT_BEGIN:
        step_channel_begin(channel, act->tick, act->steps != 0);
        break;
    case ACT_PUSH:
        push(channel, act);
        break;
    case ACT_RUN:
        step_channel_run(channel);
        break;
    case ACT_HALT:
        step_channel_halt(channel);
        break;
    case ACT_REST:
        rest(channel);
        break;
    case ACT_NOTE:
        note(channel);
        break;
    case ACT_REPLACE:
        replace(channel, act);
        break;
    case ACT_TURN:
        step_channel_turn(channel, act->steps != 0);
        break;
    case ACT_FREEZE:
        freeze(channel, act);
        break;
    case ACT_RECALL:
        recall(channel, act);
        break;
    default:
        break;
    }
}

static void do_driver(const struct act *act, unsigned motor)
{
    switch (act->what & 0xFFU) {
    case ACT_WAIT:
        wait_until(act->tick);
        break;
    case ACT_HOLD:
        hal_step_hold();
        break;
    case ACT_RELEASE:
        hal_step_release();
        break;
    case ACT_CONNECT:
        hal_step_connect(motor, act->steps != 0);
        break;
    case ACT_DIRECT:
        hal_step_set_direction(motor, act->steps != 0);
        break;
    case ACT_QUIET:
        STK_CTRL = 0;
        break;
    default:
        break;
    }
}

int main(void)
{
    const struct act *act = acts;
    __asm__ volatile("" : "+r"(act)); /* as in the flash, not as the compiler knows it */
    hal_board_init();
    driver_start();
    for (; act->what != ACTS_END; act++) {
        do_channel(act, act->what >> 8 & 0xFFU);
        do_driver(act, act->what >> 8 & 0xFFU);
    }
    acts_done();
    for (;;) {
        hal_board_idle(0);
    }
}
