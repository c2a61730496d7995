/*
 * Paths of four axes, pulse by pulse: what the tests against the exact reference are made of.
 *
 * Comes in on standard input: cases of whole numbers, one case a line,
 *
 *     epoch  turn_us  start_speed  ring  n {d1 d2 d3 d4 speed accel extent2 border}*n  known
 *     c {kind tick patience value accel}*c  stride  ahead
 *
 * with the unit's time at the start, n vectors of which `known` are there at the start, and c changes, each at a tick
 * from the start (path_find), in rising order. kind 0: stop, and go on `value` ticks after the rest; 1: `value` is the
 * speed of all vectors from there on; 2: `value` more vectors are added, and the path is changed for them; 3: they are
 * added and join by themselves, while everything up to the tick has been handed over; 4: `value` is the speed of the
 * one vector there; 5: stop; 6: go on `value` ticks after the rest, or not at all if nothing is left, whatever `tick`
 * is; 7: `value` is the speed of all vectors after the one there. What is changed while it brakes does not stop any
 * more. A change is planned when pulses up to `ahead` ticks after its place have been handed over. Goes out, a line a
 * case, times from the start: for each change that took effect its ordinal from 0, its section, step
 * + grains/grains of a step, speed2 and tick, and of a stop when the path went on (-1: it did not), as
 * `o:s:k+g/n:q:t:b` | the pulses of each axis in four fields, ticks, negative ones for negative steps; with stride > 1
 * only every stride-th pulse, the first two of a segment and its last one, as `count:tick` | segments of each axis.
 * Exit status 2: the input is no such thing; 3: a promise was broken.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "path.h"
#include "step_generator.h"

enum {
    RING_MAX = 1024,
    VECTORS_MAX = 4096,
    CHANGES_MAX = 512
};

enum kind {
    KIND_STOP,
    KIND_SPEED,
    KIND_ADD,
    KIND_JOIN,
    KIND_SECTION,
    KIND_BRAKE,
    KIND_GO,
    KIND_LATER,
    KINDS
};

struct change {
    uint64_t tick;
    uint64_t patience;
    uint64_t value;
    uint64_t accel; /* of a stop; 0: that of the vectors */
    unsigned kind;
};

/* The pulses of an axis; the last ones may be void after a change. */
struct train {
    struct step_generator generator;
    int64_t *ticks; /* from the epoch; negative: backward */
    uint64_t count;
    uint64_t room;
    uint64_t last; /* tick of the last pulse, or of the start */
    uint64_t segments;
};

struct probe {
    struct path path;
    struct path_section ring[RING_MAX];
    struct path_vector vector[VECTORS_MAX];
    struct change change[CHANGES_MAX];
    struct train train[PATH_AXES];
    uint64_t epoch;
    uint32_t turn_us;
    uint32_t start_speed;
    uint32_t ring_size;
    uint32_t vectors;
    uint32_t known;
    uint32_t changes;
    uint64_t stride;
    uint64_t ahead;
};

static void refuse(const char *what, int status)
{
    (void)fprintf(stderr, "path-probe: %s\n", what);
    exit(status);
}

static uint64_t read_number(uint64_t max)
{
    uint64_t number;
    if (scanf("%" SCNu64, &number) != 1 || number > max) {
        refuse("a number is missing or too large", 2);
    }
    return number;
}

static int32_t read_steps(void)
{
    int32_t steps;
    if (scanf("%" SCNd32, &steps) != 1) {
        refuse("steps are missing", 2);
    }
    return steps;
}

static void read_vector(struct path_vector *vector)
{
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        vector->steps[axis] = read_steps();
    }
    vector->speed = (uint32_t)read_number(PATH_SPEED_MAX);
    vector->accel = (uint32_t)read_number(PATH_ACCEL_MAX);
    vector->extent2 = read_number(UINT64_MAX);
    vector->border_speed = (uint32_t)read_number(UINT32_MAX);
}

/* False at the end of the input. */
static bool read_case(struct probe *probe)
{
    if (scanf(" ") == EOF || feof(stdin)) {
        return false;
    }
    probe->epoch = read_number(UINT64_MAX);
    probe->turn_us = (uint32_t)read_number(PATH_TURN_US_MAX);
    probe->start_speed = (uint32_t)read_number(PATH_SPEED_MAX);
    probe->ring_size = (uint32_t)read_number(RING_MAX);
    probe->vectors = (uint32_t)read_number(VECTORS_MAX);
    for (unsigned i = 0; i < probe->vectors; i++) {
        read_vector(&probe->vector[i]);
    }
    probe->known = (uint32_t)read_number(probe->vectors);
    probe->changes = (uint32_t)read_number(CHANGES_MAX);
    for (unsigned i = 0; i < probe->changes; i++) {
        probe->change[i].kind = (unsigned)read_number(KINDS - 1);
        probe->change[i].tick = read_number(UINT64_MAX);
        probe->change[i].patience = read_number(UINT64_MAX);
        probe->change[i].value = read_number(UINT64_MAX);
        probe->change[i].accel = read_number(PATH_ACCEL_MAX);
    }
    probe->stride = read_number(UINT64_MAX);
    probe->ahead = read_number(UINT64_MAX);
    return true;
}

static void train_keep(struct train *train, int64_t tick)
{
    if (train->count == train->room) {
        train->room = train->room != 0 ? 2U * train->room : 1024U;
        train->ticks = realloc(train->ticks, train->room * sizeof train->ticks[0]);
        if (train->ticks == NULL) {
            refuse("no memory", 2);
        }
    }
    train->ticks[train->count] = tick;
}

static void make_pulse(struct probe *probe, struct train *train, uint64_t tick, bool backward, bool told)
{
    int64_t since = (int64_t)(tick - probe->epoch);
    if (probe->stride == 1U) {
        train_keep(train, backward ? -since : since);
    }
    train->count++;
    train->last = tick;
    if (probe->stride > 1U && (told || train->count % probe->stride == 0)) {
        (void)printf("%" PRIu64 ":%" PRId64 " ", train->count, backward ? -since : since);
    }
}

/* Puts the generator on a pulse of a cruise, counted from 0, where it would come by itself: within half a tick's way of
 * the step. */
static uint64_t jump_to(struct train *train, const struct path_segment *path_segment, uint32_t pulse)
{
    struct step_generator *generator = &train->generator;
    const struct step_segment *segment = &path_segment->segment;
    uint64_t unused = 0;
    uint64_t way = wide_divide(wide_multiply(pulse, STEP_QUANTA), segment->slope, &unused);
    generator->tick = segment->tick + (uint32_t)way;
    step_generator_join(generator, segment, pulse + 1U);
    while (wide_to_signed(generator->residual + (segment->slope >> 1U)) < 0) {
        generator->residual += segment->slope;
        generator->tick++;
    }
    while (wide_to_signed(generator->residual + (segment->slope >> 1U) - segment->slope) >= 0) {
        generator->residual -= segment->slope;
        generator->tick--;
    }
    return path_segment->tick + (uint32_t)(generator->tick - segment->tick);
}

/* Of a cruise of which not all pulses are told, those alone are made: its first two have been. */
static void make_some(struct probe *probe, struct train *train, const struct path_segment *path_segment)
{
    uint64_t end = train->count + path_segment->segment.steps - 2U;
    uint64_t begin = end - path_segment->segment.steps;
    while (train->count < end) {
        uint64_t next = (train->count / probe->stride + 1U) * probe->stride;
        train->count = (next < end ? next : end) - 1U;
        uint64_t tick = jump_to(train, path_segment, (uint32_t)(train->count - begin));
        make_pulse(probe, train, tick, path_segment->backward, train->count + 1U == end);
    }
}

/* Makes all pulses of a segment; the first two and the last one are always told. */
static void make_segment(struct probe *probe, struct train *train, const struct path_segment *path_segment)
{
    const struct step_segment *segment = &path_segment->segment;
    if ((uint32_t)path_segment->tick != segment->tick || segment->steps == 0) {
        refuse("a segment contradicts itself", 3);
    }
    train->segments++;
    step_generator_load(&train->generator, segment);
    make_pulse(probe, train, path_segment->tick, path_segment->backward, true);
    for (uint32_t i = 1; i < segment->steps; i++) {
        uint32_t before = train->generator.tick;
        uint64_t tick = train->last + (uint32_t)(step_generator_next(&train->generator) - before);
        make_pulse(probe, train, tick, path_segment->backward, i == 1U || i + 1U == segment->steps);
        if (i == 1U && probe->stride > 1U && segment->accel == 0) {
            make_some(probe, train, path_segment);
            break;
        }
    }
}

static void hand_over(struct probe *probe, unsigned axis, uint64_t until_tick)
{
    struct path_segment segment;
    while (path_next(&probe->path, axis, until_tick, &segment)) {
        make_segment(probe, &probe->train[axis], &segment);
    }
}

static void hand_over_all(struct probe *probe, uint64_t until_tick)
{
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        hand_over(probe, axis, until_tick);
    }
}

static void add(struct probe *probe, uint64_t count)
{
    for (; count > 0 && probe->path.end != probe->vectors; count--) {
        if (!path_add(&probe->path, &probe->vector[probe->path.end])) {
            refuse("the ring is full", 2);
        }
    }
}

/* A train goes back to the pulse before those that are void. */
static void train_go_back(struct probe *probe, struct train *train, uint64_t back)
{
    if (back > train->count || probe->stride != 1U) {
        refuse("more pulses are void than were made", 3);
    }
    train->count -= back;
    int64_t since = train->count > 0 ? train->ticks[train->count - 1U] : 0;
    train->last = probe->epoch + (uint64_t)(since < 0 ? -since : since);
    train->generator.tick = (uint32_t)train->last;
}

static void go_on(struct probe *probe, uint64_t delay)
{
    hand_over_all(probe, UINT64_MAX);
    struct wide rest = probe->path.rest.entry.time;
    uint64_t tick = rest.high + (rest.low != 0 ? 1U : 0U) + delay;
    bool goes_on = path_start(&probe->path, tick);
    (void)printf(":%" PRId64, goes_on ? (int64_t)(tick - probe->epoch) : -1);
}

static void tell_change(const struct probe *probe, unsigned ordinal, const struct path_place *place)
{
    const struct wide *at = &place->entry.place;
    uint64_t per_step = place->accel != 0
                            ? PATH_GRAINS_PER_ACCEL * place->accel
                            : path_section_grains_per_step(&probe->ring[place->section % probe->ring_size]);
    uint64_t rest = 0;
    uint64_t step = wide_divide(*at, per_step, &rest);
    (void)printf(" %u:%" PRIu32 ":%" PRIu64 "+%" PRIu64 "/%" PRIu64 ":%" PRIu64 ":%" PRIu64, ordinal, place->section,
                 step, rest, per_step, place->entry.speed2, place->entry.time.high - probe->epoch);
}

static void join(struct probe *probe, unsigned ordinal)
{
    const struct change *change = &probe->change[ordinal];
    hand_over_all(probe, probe->epoch + change->tick);
    bool laid = path_is_laid(&probe->path);
    struct path_place place = {.section = probe->path.laid, .entry = probe->path.next};
    if (!laid) {
        tell_change(probe, ordinal, &place);
        add(probe, change->value);
    }
}

/* What is handed over when a change is planned. */
static void hand_over_ahead(struct probe *probe, const struct path_place *place)
{
    hand_over_all(probe, place->entry.time.high + 2U + probe->ahead);
}

static void set_speeds(struct probe *probe, const struct change *change, uint32_t section)
{
    for (uint32_t i = section; i != probe->path.end; i++) {
        bool there = i == section;
        if (change->kind == KIND_SPEED || change->kind == (there ? KIND_SECTION : KIND_LATER)) {
            path_ready_speed(&probe->path, i, (uint32_t)change->value);
            path_take_speed(&probe->path, i);
        }
    }
}

static void make_change(struct probe *probe, unsigned ordinal)
{
    const struct change *change = &probe->change[ordinal];
    struct path_place place;
    uint64_t back[PATH_AXES];
    const struct path_wish wish = {
        .tick = probe->epoch + change->tick, .patience_ticks = change->patience, .accel = (uint32_t)change->accel};
    if (!path_find(&probe->path, &wish, &place)) {
        return;
    }
    hand_over_ahead(probe, &place);
    tell_change(probe, ordinal, &place);
    if (change->kind == KIND_ADD) {
        add(probe, change->value);
    }
    set_speeds(probe, change, place.section);
    bool stops = change->kind == KIND_STOP || change->kind == KIND_BRAKE;
    if (!path_back(&probe->path, &place, back)) {
        refuse("a change was refused", 3);
    }
    if (stops) {
        path_stop(&probe->path, &place);
    } else {
        path_change(&probe->path, &place);
    }
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        train_go_back(probe, &probe->train[axis], back[axis]);
    }
    if (change->kind == KIND_STOP) {
        go_on(probe, change->value);
    }
}

static void go(struct probe *probe, unsigned ordinal)
{
    (void)printf(" %u:0:0+0/1:0:0", ordinal);
    go_on(probe, probe->change[ordinal].value);
}

static void change(struct probe *probe, unsigned ordinal)
{
    switch (probe->change[ordinal].kind) {
    case KIND_JOIN:
        join(probe, ordinal);
        break;
    case KIND_GO:
        go(probe, ordinal);
        break;
    default:
        make_change(probe, ordinal);
        break;
    }
}

static void run_case(struct probe *probe)
{
    path_init(&probe->path, probe->ring, probe->ring_size, probe->turn_us);
    path_set_start_speed(&probe->path, probe->start_speed);
    add(probe, probe->known);
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        struct train *train = &probe->train[axis];
        train->count = 0;
        train->segments = 0;
        train->last = probe->epoch;
        step_generator_start(&train->generator, (uint32_t)probe->epoch);
    }
    if (!path_start(&probe->path, probe->epoch)) {
        refuse("no vector", 2);
    }
    for (unsigned i = 0; i < probe->changes; i++) {
        change(probe, i);
    }
    (void)printf("| ");
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        hand_over(probe, axis, UINT64_MAX);
        for (uint64_t i = 0; probe->stride == 1U && i < probe->train[axis].count; i++) {
            (void)printf("%" PRId64 " ", probe->train[axis].ticks[i]);
        }
        (void)printf("| ");
    }
}

int main(void)
{
    static struct probe probe;
    while (read_case(&probe)) {
        run_case(&probe);
        for (unsigned axis = 0; axis < PATH_AXES; axis++) {
            (void)printf("%" PRIu64 " ", probe.train[axis].segments);
        }
        (void)printf("\n");
    }
    return 0;
}
