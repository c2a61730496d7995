/*
 * The real step driver, of the image of a board, with another main, that tries its edges of time over and over, at
 * phases that a generator of random numbers chooses: an edge is armed, and the channel halted somewhere around it; or
 * an edge is armed shortly before its time, and a second one follows so soon that the interrupt comes just in time for
 * it, or too late. What the channels have counted stands in `disarm_report`; what the pins have shown is known to the
 * virtual board. Built with the image (target disarm_image).
 */
#include "hal_board.h"
#include "hal_run.h"
#include "step_channel.h"
#include "step_scale.h"
#include "stm32f4.h"

enum {
    AHEAD_TICKS = 700,  /* of an edge when its move begins: it is armed by then */
    VARIED_TICKS = 256, /* what comes on top of the lead of an edge that is armed just in time, or late */
    AROUND_TICKS = 192, /* halts begin in so many ticks before the edge; the first third of them is in time */
    REST_TICKS = 300,   /* after the edge, until its interrupt is over */
    FEED_TRIALS = 1000,
};

struct disarm_setting {
    uint32_t trials; /* of all motors */
    uint32_t seed;
    uint32_t lead_ticks; /* 0: edges are taken back; else two follow each other, the first one after that */
    uint32_t pace_ticks; /* from the first one to the second, and up to 255 more */
};

struct disarm_report {
    uint32_t pulses[UNIT_MOTORS]; /* that the channels have counted */
};

/* Put in from outside. */
extern const struct disarm_setting disarm_setting;
const struct disarm_setting disarm_setting = {.trials = 1};

extern struct disarm_report disarm_report;
struct disarm_report disarm_report;

void disarm_done(void);

static struct step_channel channels[UNIT_MOTORS];

static bool step_isr(void *context, unsigned motor)
{
    (void)context;
    return step_channel_pulse_isr(&channels[motor]);
}

static void tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
}

static void plan_isr(void *context)
{
    (void)context;
}

__attribute__((noinline)) void disarm_done(void)
{
    __asm__ volatile("nop" ::: "memory");
}

/* As in the flash, not as the compiler knows it. */
static const struct disarm_setting *setting(void)
{
    const struct disarm_setting *found = &disarm_setting;
    __asm__ volatile("" : "+r"(found));
    return found;
}

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525U + 1013904223U;
    return *state >> 16; /* 16 bits */
}

static void wait_until(uint32_t tick)
{
    while ((int32_t)(TIM2_CNT - tick) < 0) {
    }
}

/* So many cycles more, one by one. */
static void wait_cycles(uint32_t cycles)
{
    switch (cycles % 8U) {
#define CASE(n)                                                                                                        \
    case n:                                                                                                            \
        __asm__ volatile("nop");                                                                                       \
        __attribute__((fallthrough));
        CASE(7)
        CASE(6)
        CASE(5)
        CASE(4)
        CASE(3)
        CASE(2)
        CASE(1)
#undef CASE
    default:
        break;
    }
}

static void start(struct step_channel *channel, uint32_t now, uint32_t edge, uint32_t pace_ticks, uint32_t steps)
{
    const struct step_segment segment = {
        .slope = STEP_QUANTA / pace_ticks, .tick = edge, .pace_ticks = pace_ticks, .steps = steps};
    step_channel_begin(channel, now, false);
    (void)step_channel_push(channel, &segment);
    step_channel_run(channel);
}

static void try_halt(struct step_channel *channel, uint32_t random)
{
    uint32_t now = TIM2_CNT;
    uint32_t edge = now + AHEAD_TICKS;
    start(channel, now, edge, TICK_HZ, 1);
    wait_until(edge - 1U - random % AROUND_TICKS);
    wait_cycles(random >> 8);
    step_channel_halt(channel);
    wait_until(edge + REST_TICKS);
}

static void try_two(struct step_channel *channel, uint32_t random)
{
    uint32_t now = TIM2_CNT;
    uint32_t edge = now + setting()->lead_ticks + random % VARIED_TICKS;
    start(channel, now, edge, setting()->pace_ticks + (random >> 8), 2);
    while (step_channel_is_running(channel)) {
    }
    wait_until(TIM2_CNT + REST_TICKS);
}

int main(void)
{
    static struct hal_client client = {.step_isr = step_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    uint32_t state = setting()->seed;
    hal_board_init();
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        step_channel_init(&channels[motor], motor);
        client.channel[motor] = &channels[motor];
    }
    hal_run_start(&client);
    for (uint32_t trial = 0; trial < setting()->trials; trial++) {
        struct step_channel *channel = &channels[trial % UNIT_MOTORS];
        uint32_t random = next_random(&state);
        if (setting()->lead_ticks != 0) {
            try_two(channel, random);
        } else {
            try_halt(channel, random);
        }
        disarm_report.pulses[channel->motor] += (uint32_t)step_channel_pulses(channel);
        if (trial % FEED_TRIALS == 0) {
            hal_board_idle(0);
        }
    }
    disarm_done();
    for (;;) {
        hal_board_idle(0);
    }
}
