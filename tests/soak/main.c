/*
 * rkm04-soak: a long time in the life of a unit, under the judge.
 *
 *     rkm04-soak [--minutes N] [--seed N] [--epoch N] [--twice]
 *
 * Four motors run programs that never end while a master talks, repeats, disturbs and turns inputs; all by chance, from
 * the seed; the timer begins anywhere, unless an epoch is given. At the end the judge must be silent, the unit's
 * counters and positions must be what was sent and seen, the canaries around the unit must live, and the process must
 * not have grown. `--twice` does it again from another epoch of the timer and wants the same pulses, events and bytes
 * at the same times. Prints what was done. Exit status 0: all that holds, 1: not, 2: the call is wrong.
 */
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#include "base_tick.h"
#include "soak_line.h"
#include "soak_master.h"

enum {
    STATUS_GOOD = 0,
    STATUS_BAD = 1,
    STATUS_WRONG = 2,
    MINUTES = 10,
    SEED = 20261121,
    TENTHS = 10,
    GROWTH_KB_MAX = 512, /* of the process: its libraries' own doings */
};

/* The sanitizer's shadow of the memory grows with what is touched. */
#ifdef __has_feature
#define GROWTH_TELLS (!__has_feature(address_sanitizer))
#else
#define GROWTH_TELLS true
#endif

#define MINUTE_TICKS (UINT64_C(60) * TICK_HZ)
#define EPOCH_SPREAD UINT64_C(0x12345678B) /* neighbouring seconds lie far apart in 32 bits */
#define OTHER_EPOCH ((UINT64_C(5) << 32U) - UINT64_C(30) * TICK_HZ)

struct call {
    uint64_t minutes;
    uint64_t seed;
    uint64_t epoch;
    bool twice;
};

static struct soak_unit soak;
static struct soak_master master;

static bool read_number(const char *text, uint64_t *number)
{
    char *end = NULL;
    errno = 0;
    *number = text != NULL ? strtoull(text, &end, 0) : 0;
    return text != NULL && end != text && *end == '\0' && errno == 0;
}

static bool read_call(struct call *call, char **arguments)
{
    *call = (struct call){.minutes = MINUTES, .seed = SEED, .epoch = (uint64_t)time(NULL) * EPOCH_SPREAD >> 2U};
    for (; *arguments != NULL; arguments++) {
        uint64_t *number = strcmp(*arguments, "--minutes") == 0 ? &call->minutes
                           : strcmp(*arguments, "--seed") == 0  ? &call->seed
                           : strcmp(*arguments, "--epoch") == 0 ? &call->epoch
                                                                : NULL;
        call->twice = call->twice || strcmp(*arguments, "--twice") == 0;
        if (number == NULL ? strcmp(*arguments, "--twice") != 0 : !read_number(*++arguments, number)) {
            return false;
        }
    }
    return call->minutes > 0;
}

static long resident_kb(void)
{
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? usage.ru_maxrss : 0;
}

/* Before anything can fail. */
static void print_call(const struct call *call)
{
    printf("seed %" PRIu64 ", %" PRIu64 " min of unit time, epoch %" PRIu64 "\n", call->seed, call->minutes,
           call->epoch);
    (void)fflush(stdout);
}

static void print_done(long grown_kb)
{
    const struct soak_tally *tally = &master.tally;
    uint64_t pulses = 0;
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        pulses += soak.pulses[i];
    }
    printf("pulses %" PRIu64 ", moves %" PRIu64 ", run-time errors %" PRIu64 ", passes of main %" PRIu64 "\n", pulses,
           soak.moves, soak.errors, soak.passes);
    printf("requests %" PRIu64 ", answers %" PRIu64 ", repeats %" PRIu64 ", broadcasts %" PRIu64 ", programs %" PRIu64
           ", full memory %" PRIu64 ", input edges %" PRIu64 "\n",
           tally->requests, tally->answers, tally->repeats, tally->broadcasts, tally->programs, tally->full,
           tally->edges);
    printf("foreign frames %" PRIu64 ", damaged frames %" PRIu64 ", bursts of noise %" PRIu64 ", broken bytes %" PRIu64
           "\n",
           tally->foreign, tally->damaged, tally->noise, tally->broken);
    printf("flash operations %" PRIu32 ", process grown by %ld kB, digest %016" PRIx64 "\n",
           soak.machine.flash_operations, grown_kb, soak_unit_digest(&soak));
}

static bool is_lawful(void)
{
    if (master.trouble != NULL) {
        printf("broken at tick %" PRIu64 ": %s\n", master.trouble_tick, master.trouble);
    }
    return soak.judge.complaints == 0 && master.trouble == NULL;
}

static bool run(const struct call *call)
{
    uint64_t end = call->minutes * MINUTE_TICKS;
    long resident = 0;
    print_call(call);
    soak_unit_begin(&soak, call->epoch);
    soak_master_begin(&master, &soak, call->seed);
    while (soak.machine.now < end && master.trouble == NULL && soak.judge.complaints == 0) {
        soak_master_act(&master);
        resident = soak.machine.now < end / TENTHS || resident == 0 ? resident_kb() : resident;
    }
    soak_master_end(&master);
    (void)judge_unit_end(&soak.judged, soak.machine.now, stdout, "judge: ");
    long grown_kb = resident_kb() - resident;
    soak_require(&master, soak.machine.late_steps == 0, "no step is late");
    soak_require(&master, soak_unit_is_whole(&soak), "what is around the unit and what never changes is as it was");
    soak_require(&master, !GROWTH_TELLS || grown_kb <= GROWTH_KB_MAX, "the process does not grow");
    print_done(grown_kb);
    return is_lawful();
}

int main(int count, char **arguments)
{
    struct call call;
    (void)count;
    if (!read_call(&call, arguments + 1)) {
        (void)fputs("call: rkm04-soak [--minutes N] [--seed N] [--epoch N] [--twice]\n", stderr);
        return STATUS_WRONG;
    }
    bool good = run(&call);
    if (good && call.twice) {
        uint64_t digest = soak_unit_digest(&soak);
        call.epoch += OTHER_EPOCH;
        good = run(&call);
        if (soak_unit_digest(&soak) != digest) {
            puts("another epoch of the timer gives another run");
            good = false;
        }
    }
    return good ? STATUS_GOOD : STATUS_BAD;
}
