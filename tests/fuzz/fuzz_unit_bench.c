#include "fuzz_unit_bench.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "base_tick.h"
#include "fuzz_host.h"
#include "fuzz_stream.h"

enum {
    COPIED_BYTES = offsetof(struct fuzz_unit, machine) + offsetof(struct host_machine, flash),
    ERASED = 0xFF,
    LINE_BYTE_TICKS = 800, /* the line is quicker than it should be, so that long answers take no time */
};

static struct fuzz_unit live;
static uint8_t fresh[FUZZ_EPOCHS][COPIED_BYTES];
static bool made;

static void on_line(void *context, uint64_t tick, uint8_t value)
{
    struct fuzz_unit *fuzz = context;
    (void)tick;
    FUZZ_REQUIRE(fuzz->sent_count < FUZZ_SENT_MAX);
    fuzz->sent[fuzz->sent_count++] = value;
}

static uint64_t main_pass(void *context)
{
    struct fuzz_unit *fuzz = context;
    fuzz->passes++;
    return judge_unit_pass(fuzz);
}

bool fuzz_unit_is_over(const struct fuzz_unit *fuzz)
{
    return fuzz->passes >= FUZZ_PASSES_MAX || fuzz->machine.pulses >= FUZZ_PULSES_MAX;
}

static bool is_over(void *context)
{
    return fuzz_unit_is_over(context);
}

static void switch_on(void)
{
    live.machine.faults.late_tick_ticks = FUZZ_LATE_TICKS;
    rkm04_init(&live.unit);
    rkm04_start(&live.unit);
}

static void make_fresh(unsigned which)
{
    memset(&live, 0, sizeof live);
    live.judged = (struct judged_unit){.unit = &live.unit, .judge = &live.judge, .machine = &live.machine};
    judge_unit_begin(&live.judged, fuzz_epoch_tick(which));
    host_machine_set_byte_ticks(&live.machine, LINE_BYTE_TICKS);
    live.machine.listener.line = on_line;
    switch_on();
    memcpy(fresh[which], &live, COPIED_BYTES);
}

struct fuzz_unit *fuzz_unit_begin(unsigned epoch)
{
    for (unsigned which = 0; !made && which < FUZZ_EPOCHS; which++) {
        make_fresh(which);
    }
    made = true;
    if (live.machine.flash_operations != 0) {
        memset(live.machine.flash, ERASED, sizeof live.machine.flash);
    }
    memcpy(&live, fresh[epoch % FUZZ_EPOCHS], COPIED_BYTES);
    host_machine_select(&live.machine);
    return &live;
}

void fuzz_unit_run(struct fuzz_unit *fuzz, uint64_t ticks)
{
    if (!fuzz_unit_is_over(fuzz)) {
        host_machine_run(&fuzz->machine, fuzz->machine.now + ticks, main_pass, is_over, fuzz);
    }
}

void fuzz_unit_restart(struct fuzz_unit *fuzz)
{
    /* What the flash has seen so far must stay known to fuzz_unit_begin. */
    uint32_t operations = fuzz->machine.flash_operations;
    judge_restart(&fuzz->judge);
    host_machine_restart(&fuzz->machine);
    switch_on();
    fuzz->machine.flash_operations += operations;
}

void fuzz_unit_end(struct fuzz_unit *fuzz)
{
    uint64_t end = fuzz_unit_is_over(fuzz) ? UINT64_MAX : fuzz->machine.now;
    FUZZ_REQUIRE(fuzz->machine.late_steps == 0);
    FUZZ_REQUIRE(judge_unit_end(&fuzz->judged, end, stderr, "judge: ") == 0);
}
