/*
 * A measure of one axis of the positioning unit, with feeds, holds and a limit at given ticks: its pulses, and where
 * the path was planned anew. What the tests against the exact curve are made of.
 *
 * Comes in on standard input: cases of whole numbers, one case a line,
 *
 *     epoch  steps micrometres start_feed error_accel  len accel  n {tick kind value mp}*n  back  end
 *
 * of axis 1, with n events in the order of time, ticks from the start. kind 0: POS_CONTROL with a feed and mp; 1: the
 * input LIMIT_PLUS has the level `value`, LIMIT_MINUS if the way is negative. The case ends when the axis rests after
 * the last event, or at the tick `end`. With `back` other than 0 the axis is taken again then, and makes a measure of
 * so many micrometres with the highest feed, whose pulses are not told. Goes out, for each case a line
 *
 *     STATUS ERROR  steps before `back`, steps after  late pulses  tick of the end  m {seen step grain grains tick}*m p
 *
 * with m places at which the path left a stand or was planned anew, step + grain/grains and the tick when it is there,
 * and the tick of the pass that saw it; then p ticks of pulses, 64 bits each as the host has them, negative for
 * backward. Exit status 2: the input is no such thing; 3: a promise was broken.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base_tick.h"
#include "base_wide.h"
#include "host_machine.h"
#include "path_lay.h"
#include "positioning.h"

enum {
    AXIS = 1,
    EVENTS_MAX = 4096,
    PLACES_MAX = 8192,
    LIMIT_INPUT = 1,
    AHEAD_TICKS = 512 * TICKS_PER_US,
    BEGIN_TICKS = TICKS_PER_MS,
    BACK_ACCEL = 65535,
    RATIO = 30, /* STEPS, MICROMETRES; these are numbers of registers, less 100 for the axis */
    START_FEED = 38,
    ERROR_ACCEL = 40,
    LIMIT_MINUS = 46,
    LIMIT_PLUS = 47,
};

enum kind {
    KIND_CONTROL,
    KIND_LIMIT,
    KINDS
};

struct event {
    uint64_t tick;
    unsigned kind;
    uint32_t value;
    int mp;
};

/* Of the path: a place of its section, and when it is there. */
struct place {
    uint64_t seen;
    uint64_t step;
    uint64_t grain;
    uint64_t grains;
    uint64_t tick;
};

struct probe {
    struct host_machine machine;
    struct pos_unit unit;
    struct event events[EVENTS_MAX];
    uint32_t count;
    struct place places[PLACES_MAX];
    uint32_t place_count;
    int64_t *ticks;
    uint64_t pulses;
    uint64_t room;
    int64_t position;
    bool told; /* pulses are kept */
    int64_t back_um;
    uint64_t end;
};

static struct probe probe;

static _Noreturn void refuse(const char *what, int status)
{
    (void)fprintf(stderr, "pos-feeds-probe: %s\n", what);
    exit(status);
}

static int64_t read_number(int64_t min, int64_t max)
{
    int64_t number = 0;
    if (scanf("%" SCNd64, &number) != 1 || number < min || number > max) {
        refuse("a number is missing or out of its range", 2);
    }
    return number;
}

/* ---- what is seen ---------------------------------------------------------------------------------------------- */

static void on_step(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    (void)motor;
    probe.position += backward ? -1 : 1;
    if (!probe.told) {
        return;
    }
    if (probe.pulses == probe.room) {
        probe.room = probe.room != 0U ? 2U * probe.room : 1024U;
        probe.ticks = realloc(probe.ticks, probe.room * sizeof probe.ticks[0]);
        if (probe.ticks == NULL) {
            refuse("no memory", 2);
        }
    }
    probe.ticks[probe.pulses++] = backward ? -(int64_t)tick : (int64_t)tick;
}

/* The linker puts these in place of the path's own: each time it is planned from a place. */
bool __real_path_start(struct path *path, uint64_t start_tick);
void __real_path_change(struct path *path, const struct path_place *from);
void __real_path_stop(struct path *path, const struct path_place *from);
bool __wrap_path_start(struct path *path, uint64_t start_tick);
void __wrap_path_change(struct path *path, const struct path_place *from);
void __wrap_path_stop(struct path *path, const struct path_place *from);

static void see_plan(const struct path *path)
{
    const struct path_place *origin = &path->origin;
    struct place *place = &probe.places[probe.place_count];
    if (!probe.told) {
        return;
    }
    place->seen = probe.machine.now;
    place->grains = path_lay_grains(path, origin);
    place->step =
        (uint64_t)origin->section * INT32_MAX + wide_divide(origin->entry.place, place->grains, &place->grain);
    place->tick = origin->entry.time.high - probe.machine.epoch;
    if (++probe.place_count == (uint32_t)PLACES_MAX) {
        refuse("there are too many places", 2);
    }
}

bool __wrap_path_start(struct path *path, uint64_t start_tick)
{
    bool starts = __real_path_start(path, start_tick);
    see_plan(path);
    return starts;
}

void __wrap_path_change(struct path *path, const struct path_place *from)
{
    __real_path_change(path, from);
    see_plan(path);
}

void __wrap_path_stop(struct path *path, const struct path_place *from)
{
    __real_path_stop(path, from);
    see_plan(path);
}

static uint64_t pass(void *context)
{
    (void)context;
    return positioning_poll(&probe.unit);
}

static void run_until(uint64_t tick)
{
    host_machine_run(&probe.machine, tick, pass, NULL, NULL);
}

/* ---- a case ---------------------------------------------------------------------------------------------------- */

static void set(unsigned offset, uint32_t count, const uint16_t *words)
{
    if (positioning_write(&probe.unit, 100U * AXIS + offset, count, words) != MODBUS_EXCEPTION_NONE) {
        refuse("a setting is refused", 2);
    }
}

static void read_long(uint16_t *words, int64_t min, int64_t max)
{
    uint64_t value = (uint64_t)read_number(min, max);
    words[0] = (uint16_t)(value >> 16U & 0xFFFFU);
    words[1] = (uint16_t)(value & 0xFFFFU);
}

static void set_limit(bool negative)
{
    const uint16_t input[] = {LIMIT_INPUT};
    set(negative ? LIMIT_MINUS : LIMIT_PLUS, 1, input);
}

static void set_up(void)
{
    host_machine_init(&probe.machine, (uint64_t)read_number(0, INT64_MAX));
    probe.machine.ahead_ticks = AHEAD_TICKS;
    probe.machine.listener = (struct host_listener){.step = on_step};
    host_machine_select(&probe.machine);
    memset(&probe.unit, 0, sizeof probe.unit);
    positioning_init(&probe.unit);
    positioning_start(&probe.unit);
    uint16_t words[4];
    read_long(&words[0], 1, INT32_MAX);
    read_long(&words[2], 1, INT32_MAX);
    set(RATIO, 4, words);
    read_long(words, 0, UINT32_MAX);
    set(START_FEED, 2, words);
    read_long(words, 0, UINT16_MAX);
    set(ERROR_ACCEL, 1, &words[1]);
}

static void measure(int64_t len_um, uint16_t accel)
{
    if (pos_init(&probe.unit, AXIS, 0) != POS_OK ||
        pos_mode(&probe.unit, NULL, (int32_t)len_um, accel, AXIS) != POS_OK) {
        refuse("a measure is refused", 3);
    }
}

static void read_events(void)
{
    probe.count = (uint32_t)read_number(0, EVENTS_MAX);
    for (uint32_t i = 0; i < probe.count; i++) {
        struct event *event = &probe.events[i];
        event->tick = (uint64_t)read_number(BEGIN_TICKS, INT64_MAX);
        event->kind = (unsigned)read_number(0, KINDS - 1);
        event->value = (uint32_t)read_number(0, UINT32_MAX);
        event->mp = (int)read_number(0, 1);
    }
    probe.back_um = read_number(-INT32_MAX, INT32_MAX);
    probe.end = (uint64_t)read_number(BEGIN_TICKS, INT64_MAX);
}

static void play(void)
{
    for (uint32_t i = 0; i < probe.count; i++) {
        const struct event *event = &probe.events[i];
        run_until(event->tick);
        if (event->kind == KIND_LIMIT) {
            host_machine_set_input(&probe.machine, LIMIT_INPUT, event->value != 0U);
        } else {
            (void)pos_control(&probe.unit, NULL, event->value, event->mp, AXIS);
        }
        if (i + 1U == probe.count || probe.events[i + 1U].tick != event->tick) {
            run_until(event->tick + 1U);
        }
    }
}

static bool is_at_rest(void *context)
{
    (void)context;
    return positioning_is_idle(&probe.unit);
}

static void run_to_rest(uint64_t end)
{
    host_machine_run(&probe.machine, end, pass, is_at_rest, NULL);
}

static void tell(unsigned status, unsigned error, int64_t before, uint64_t rest_tick)
{
    (void)printf("%u %u %" PRId64 " %" PRId64 " %" PRIu64 " %" PRIu64 " %" PRIu32, status, error, before,
                 probe.position, probe.machine.late_steps, rest_tick, probe.place_count);
    for (uint32_t i = 0; i < probe.place_count; i++) {
        const struct place *place = &probe.places[i];
        (void)printf(" %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64, place->seen, place->step,
                     place->grain, place->grains, place->tick);
    }
    (void)printf(" %" PRIu64 "\n", probe.pulses);
    (void)fwrite(probe.ticks, sizeof probe.ticks[0], probe.pulses, stdout);
    (void)fflush(stdout);
}

static void play_case(void)
{
    struct pos_values values;
    probe.position = 0;
    probe.pulses = 0;
    probe.place_count = 0;
    probe.told = true;
    set_up();
    int64_t len_um = read_number(-INT32_MAX, INT32_MAX);
    set_limit(len_um < 0);
    measure(len_um, (uint16_t)read_number(1, UINT16_MAX));
    read_events();
    play();
    run_to_rest(probe.end);
    pos_read(&probe.unit, AXIS, &values);
    int64_t before = probe.position;
    uint64_t rest_tick = probe.machine.now;
    probe.told = false;
    if (probe.back_um != 0) {
        measure(probe.back_um, BACK_ACCEL);
        (void)pos_control(&probe.unit, NULL, UINT32_MAX, 1, AXIS);
        run_to_rest(UINT64_MAX);
    }
    tell((unsigned)values.status.status1 << 8U | values.status.status2, (unsigned)values.error, before, rest_tick);
}

int main(void)
{
    while (scanf(" ") != EOF && !feof(stdin)) {
        play_case();
    }
    return 0;
}
