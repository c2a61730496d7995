/*
 * The real step driver, of the image of a board, with another main, that tries its edges of time over and over, at
 * phases that a generator of random numbers chooses. A train of pulses begins, far ahead, just in time or late; perhaps
 * the channel is halted somewhere in it. What the channels have counted stands in `take_back_report`; what the pins
 * have shown is known to the virtual board. Built with the image (target take_back_image).
 */
#include "driver.h"
#include "hal_board.h"
#include "step_scale.h"
#include "stm32f4.h"

enum {
    FEED_TRIALS = 100,
    REST_TICKS = 2000, /* after the last pulse, until nothing has to be done for it */
};

struct take_back_setting {
    uint32_t trials; /* of all motors */
    uint32_t seed;
    uint32_t lead_ticks; /* to the first pulse, and up to `lead_varied` - 1 more */
    uint32_t lead_varied;
    uint32_t pace_ticks; /* from a pulse to the next, and up to 255 more */
    uint32_t pulses;
    uint32_t halt_ticks; /* not 0: the channel is halted within so many ticks from the begin */
    uint32_t together;   /* of motors that begin together, 1 to 4 */
};

struct take_back_report {
    uint32_t pulses[UNIT_MOTORS]; /* that the channels have counted */
};

/* Put in from outside. */
extern const struct take_back_setting take_back_setting;
const struct take_back_setting take_back_setting = {.trials = 1};

extern struct take_back_report take_back_report;
struct take_back_report take_back_report;

void take_back_done(void);

__attribute__((noinline)) void take_back_done(void)
{
    __asm__ volatile("nop" ::: "memory");
}

/* As in the flash, not as the compiler knows it. */
static const struct take_back_setting *setting(void)
{
    const struct take_back_setting *found = &take_back_setting;
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

static void start(struct step_channel *channel, uint32_t now, uint32_t edge, uint32_t pace_ticks)
{
    const struct step_segment segment = {
        .slope = STEP_QUANTA / pace_ticks, .tick = edge, .pace_ticks = pace_ticks, .steps = setting()->pulses};
    step_channel_begin(channel, now, false);
    (void)step_channel_push(channel, &segment);
    step_channel_run(channel);
}

static void halt_somewhere(unsigned first, uint32_t now, uint32_t random)
{
    wait_until(now + random % setting()->halt_ticks);
    wait_cycles(random >> 8);
    for (unsigned i = 0; i < setting()->together; i++) {
        step_channel_halt(&channels[(first + i) % UNIT_MOTORS]);
    }
}

static void try_train(unsigned first, uint32_t *state)
{
    uint32_t now = TIM2_CNT;
    uint32_t random = next_random(state);
    uint32_t edge = now + setting()->lead_ticks + random % setting()->lead_varied;
    for (unsigned i = 0; i < setting()->together; i++) {
        start(&channels[(first + i) % UNIT_MOTORS], now, edge, setting()->pace_ticks + (random >> 8));
    }
    if (setting()->halt_ticks != 0) {
        halt_somewhere(first, now, next_random(state));
    }
    for (unsigned i = 0; i < setting()->together; i++) {
        struct step_channel *channel = &channels[(first + i) % UNIT_MOTORS];
        while (step_channel_is_running(channel)) {
        }
        take_back_report.pulses[channel->motor] += (uint32_t)step_channel_pulses(channel);
    }
    wait_until(TIM2_CNT + REST_TICKS);
}

int main(void)
{
    uint32_t state = setting()->seed;
    hal_board_init();
    driver_start();
    for (uint32_t trial = 0; trial < setting()->trials; trial++) {
        try_train(trial, &state);
        if (trial % FEED_TRIALS == 0) {
            hal_board_idle(0);
        }
    }
    take_back_done();
    for (;;) {
        hal_board_idle(0);
    }
}
