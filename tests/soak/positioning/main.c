/*
 * positioning-soak: a long time of a positioning unit that a PLC feeds.
 *
 *     positioning-soak [--minutes N] [--seed N] [--epoch N]
 *
 * Four axes go at up to 100 000 steps/s; in every cycle of 15 ms a request (function 23) at 115 200 Bd brings other
 * feeds, holds, or an instruction, and reads the fast image, all by chance, from the seed. Every request must be
 * answered in its cycle, every measure must end on the step that the contract says, and the counters of the unit must
 * be what was sent. Measures are chosen to be over when the time is; what still moves then is waited for. Prints what
 * was done. Exit status 0: all that holds, 1: not, 2: the call is wrong.
 */
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base_tick.h"
#include "pos_soak_axis.h"

enum {
    STATUS_GOOD = 0,
    STATUS_BAD = 1,
    STATUS_WRONG = 2,
    MINUTES = 10,
    CYCLES_PER_MINUTE = 60 * 1000 / POS_SOAK_CYCLE_MS,
    CYCLES_LATER_MAX = 24 * 60 * CYCLES_PER_MINUTE,
    STORE_MS = 3000,
    RATE = 31,
    RATE_115200 = 1152,
    STORE = 40,
    FAST_OUT = 500,
    FAST_OUT_WORDS = 3,
    COUNTERS = 6, /* LATE_STEPS to SILENCES */
    COUNTERS_WORDS = 22,
};

#define EPOCH_DEFAULT ((UINT64_C(1) << 32U) - UINT64_C(30) * TICK_HZ)

struct call {
    uint64_t minutes;
    uint64_t seed;
    uint64_t epoch;
};

static struct pos_soak soak;
static struct pos_soak_axis axes[UNIT_MOTORS];
static uint64_t chance;

static bool read_number(const char *text, uint64_t *number)
{
    char *end = NULL;
    errno = 0;
    *number = text != NULL ? strtoull(text, &end, 0) : 0;
    return text != NULL && end != text && *end == '\0' && errno == 0;
}

static bool read_call(struct call *call, char **arguments)
{
    *call = (struct call){.minutes = MINUTES, .seed = 1, .epoch = EPOCH_DEFAULT};
    for (; *arguments != NULL; arguments++) {
        uint64_t *number = strcmp(*arguments, "--minutes") == 0 ? &call->minutes
                           : strcmp(*arguments, "--seed") == 0  ? &call->seed
                           : strcmp(*arguments, "--epoch") == 0 ? &call->epoch
                                                                : NULL;
        if (number == NULL || !read_number(*++arguments, number)) {
            return false;
        }
    }
    return call->minutes > 0;
}

static void set_up(uint64_t epoch)
{
    const uint16_t rate[] = {RATE_115200};
    const uint16_t store[] = {1};
    pos_soak_begin(&soak, epoch);
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        pos_soak_axis_begin(&axes[i], &soak, i + 1U, &chance);
    }
    pos_soak_write(&soak, RATE, 1, rate, 2 * POS_SOAK_CYCLE_MS);
    pos_soak_write(&soak, STORE, 1, store, STORE_MS);
    pos_soak_restart(&soak);
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        pos_soak_axis_take(&axes[i]);
    }
}

static void feed(void)
{
    uint16_t words[FAST_OUT_WORDS * UNIT_MOTORS];
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        pos_soak_axis_feed(&axes[i], &words[FAST_OUT_WORDS * i]);
    }
    pos_soak_fast_image(&soak, FAST_OUT, sizeof words / sizeof words[0], words);
}

/* A request; instructions go to the axes in turn. */
static void cycle(uint64_t cycles_left)
{
    bool told = false;
    for (unsigned i = 0; i < UNIT_MOTORS && !told; i++) {
        told = pos_soak_axis_instruct(&axes[(soak.requests + i) % UNIT_MOTORS], cycles_left);
    }
    if (!told) {
        feed();
    }
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        pos_soak_axis_see(&axes[i]);
    }
}

static bool all_rest(void)
{
    bool rest = true;
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        rest = rest && axes[i].doing == POS_SOAK_RESTS;
    }
    return rest;
}

static void see_counters(void)
{
    uint64_t before = soak.since_start;
    pos_soak_read(&soak, COUNTERS, COUNTERS_WORDS);
    pos_soak_require(&soak, pos_soak_long(&soak, 0) == 0U && soak.machine.late_steps == 0U, "no pulse is late");
    pos_soak_require(&soak, pos_soak_long(&soak, 4) == before + 1U, "FRAMES are the requests");
    for (uint32_t i = 6; i < (uint32_t)COUNTERS_WORDS; i += 2U) {
        pos_soak_require(&soak, pos_soak_long(&soak, i) == 0U, "no request was broken, refused or not answered");
    }
    pos_soak_require(&soak, soak.closest_ticks + 2U >= TICK_HZ / (uint64_t)POS_SOAK_RATE_MAX,
                     "no two pulses are closer than the feed says");
}

static void print_done(void)
{
    printf("requests %" PRIu64 ", all answered; %" PRIu64 " s of unit time; two pulses at least %" PRIu64
           " ticks apart\n",
           soak.requests, soak.machine.now / TICK_HZ, soak.closest_ticks);
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        const struct pos_soak_axis *axis = &axes[i];
        printf("axis %u: pulses %" PRIu64 ", measures %" PRIu64 ", given up %" PRIu64 ", feeds %" PRIu64
               ", holds %" PRIu64 "; stands on step %" PRId64 "%s %" PRId64 " um of %" PRId64 "/%" PRId64 " steps\n",
               axis->number, soak.motors[i].pulses, axis->measures, axis->given_up, axis->feeds, axis->holds,
               soak.motors[i].position, axis->faithful ? ", which is all ways:" : ", last way:", axis->way, axis->steps,
               axis->micrometres);
    }
}

int main(int count, char **arguments)
{
    struct call call;
    (void)count;
    if (!read_call(&call, arguments + 1)) {
        (void)fputs("call: positioning-soak [--minutes N] [--seed N] [--epoch N]\n", stderr);
        return STATUS_WRONG;
    }
    printf("seed %" PRIu64 ", %" PRIu64 " min of unit time, epoch %" PRIu64 "\n", call.seed, call.minutes, call.epoch);
    (void)fflush(stdout);
    chance = call.seed;
    set_up(call.epoch);
    for (uint64_t left = call.minutes * CYCLES_PER_MINUTE; left != 0U && soak.trouble == NULL; left--) {
        cycle(left);
    }
    for (unsigned i = 0; i < CYCLES_LATER_MAX && !all_rest() && soak.trouble == NULL; i++) {
        cycle(0);
    }
    pos_soak_require(&soak, all_rest(), "every measure has an end");
    see_counters();
    if (soak.trouble != NULL) {
        printf("broken at tick %" PRIu64 ", request %" PRIu64 ": %s\n", soak.trouble_tick, soak.requests, soak.trouble);
        return STATUS_BAD;
    }
    print_done();
    return STATUS_GOOD;
}
