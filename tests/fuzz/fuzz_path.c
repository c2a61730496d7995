/*
 * Random chains of vectors, changed, stopped, gone on with and added to at any time: a path never leaves its bounds,
 * and what holds of every path holds of this one.
 *
 *   pulses of an axis come in the order of time, no nearer than the top speed lets them, one for each step, its way
 *   all axes are at the end of a vector at the same tick, one more or less
 *   an axis that turns leaves DIR its time
 *   a change takes back what comes after it and nothing else; it is never refused when what comes before it is there
 *   a path stands where its rest is, every axis as far as that
 *   the speeds at the borders can be braked to and reached, and are no higher than the borders allow
 *   another time of the unit at the start moves everything by the difference, also where the counter wraps
 *
 * Whether each pulse is at its exact tick is for the exact reference to say (tests/property/test_paths.py).
 * Input: time at the start, turn_us, start speed, ring; then operations of a byte each, with their operands after:
 *   low 3 bits 0, 1  up to 32 times one more vector      2  start or go on      3  time goes by
 *   4  stop      5  another speed      6  a vector more, which the path is changed for      7  sections are dropped
 */
#include <string.h>

#include "fuzz_stream.h"
#include "fuzz_vectors.h"
#include "path.h"
#include "step_generator.h"

enum {
    RING_MAX = 16,
    VECTORS_MAX = 100,
    OPERATIONS_MAX = 64,
    KEPT_MAX = 1024, /* pulses of an axis */
    SEGMENTS_MAX = 800,
    PULSES_MAX = 300, /* of a segment; if it has more they are not made one by one */
    INTERVAL_TICKS_MIN = TICK_HZ / STEP_SPEED_MAX - 2,
    SIZE_TIME_BITS = 40,
};

/* What takes longer is not waited for: 400 years. */
static const uint64_t FOREVER_TICKS = UINT64_C(1) << 60;

/* The pulses of an axis. */
struct train {
    struct step_generator generator;
    uint64_t tick[KEPT_MAX]; /* of the last ones */
    uint32_t kept;
    uint64_t last;    /* a time that the last pulse is not before */
    uint32_t section; /* in which it is */
    uint32_t made;    /* there */
    int64_t position;
    bool backward; /* the last pulse */
    bool lost;     /* when that was is not known */
};

struct bench {
    struct path path;
    struct path_section ring[RING_MAX];
    struct path_vector vector[VECTORS_MAX]; /* all, by their count */
    uint64_t border[VECTORS_MAX];           /* when the first axis was at the end of each; 0: none was */
    struct train train[PATH_AXES];
    uint64_t epoch;
    uint64_t now;
    uint64_t started; /* when the path left its stand last */
    uint64_t digest;
    uint32_t segments;
    bool moves;
    bool exhausted;
    bool slower;           /* since it left its stand it was given a lower speed, or less brake */
    bool braked_otherwise; /* a stop had an acceleration of its own */
};

static struct bench bench;

static uint32_t steps_of(uint32_t section, unsigned axis)
{
    int32_t steps = bench.vector[section].steps[axis];
    return (uint32_t)(steps < 0 ? -steps : steps);
}

static uint32_t length_of(uint32_t section)
{
    uint32_t length = 0;
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        length = steps_of(section, axis) > length ? steps_of(section, axis) : length;
    }
    return length;
}

static void mix(uint64_t value)
{
    bench.digest = (bench.digest ^ value) * UINT64_C(0x100000001B3);
}

/* The pulse is the last one in its vector: the others are there at the same time. */
static void meet_border(uint32_t section, uint64_t tick)
{
    uint64_t *border = &bench.border[section];
    FUZZ_REQUIRE(*border == 0 || (tick <= *border + 1U && *border <= tick + 1U));
    *border = tick;
}

/* Where an axis pauses before it turns, that the vector lasts long enough is the caller's. */
static void require_turn(const struct train *train, unsigned axis, uint64_t tick, bool backward)
{
    if (train->kept == 0 || backward == train->backward || bench.braked_otherwise) {
        return;
    }
    bool stood = bench.path.start_speed != 0 && bench.started >= train->last;
    bool paused = steps_of(train->section - 1U, axis) == 0;
    FUZZ_REQUIRE(stood || paused || tick - train->last + 1U >= (uint64_t)bench.path.turn_us * TICKS_PER_US);
}

static void make_pulse(unsigned axis, uint64_t tick, bool backward)
{
    struct train *train = &bench.train[axis];
    FUZZ_REQUIRE(tick >= train->last + (train->kept > 0 ? INTERVAL_TICKS_MIN : 0));
    require_turn(train, axis, tick, backward);
    if (train->kept == KEPT_MAX) {
        train->kept = KEPT_MAX / 2;
        memmove(train->tick, train->tick + KEPT_MAX / 2, sizeof train->tick / 2);
    }
    train->tick[train->kept++] = tick;
    train->last = tick;
    train->made++;
    train->position += backward ? -1 : 1;
    train->backward = backward;
    if (train->made == steps_of(train->section, axis)) {
        meet_border(train->section, tick);
    }
    mix(tick - bench.epoch);
}

/* The vector in which the next pulse of an axis is. */
static void enter(unsigned axis)
{
    struct train *train = &bench.train[axis];
    while (train->made == steps_of(train->section, axis)) {
        train->section++;
        train->made = 0;
        FUZZ_REQUIRE(train->section != bench.path.known);
    }
}

/* All further pulses of a segment, if they are not too many. */
static void make_others(unsigned axis, const struct path_segment *next)
{
    struct train *train = &bench.train[axis];
    uint32_t steps = next->segment.steps;
    if (steps > PULSES_MAX) {
        train->made += steps - 1U;
        train->position += (int64_t)(steps - 1U) * (next->backward ? -1 : 1);
        train->kept = 0;
        train->lost = true;
        return;
    }
    for (uint32_t i = 1; i < steps; i++) {
        uint32_t before = train->generator.tick;
        make_pulse(axis, train->last + (uint32_t)(step_generator_next(&train->generator) - before), next->backward);
    }
}

/* The pulse before this one, as the generator needs it. */
static void guess_before(struct train *train, const struct step_segment *segment)
{
    uint64_t interval = segment->slope > 0 ? STEP_QUANTA / segment->slope : 1U;
    train->generator.tick = segment->tick - (uint32_t)(interval < 1U << 27U ? interval : 1U << 27U);
    train->lost = false;
}

static void take_segment(unsigned axis, const struct path_segment *next)
{
    struct train *train = &bench.train[axis];
    enter(axis);
    FUZZ_REQUIRE(next->segment.steps > 0 && (uint32_t)next->tick == next->segment.tick);
    FUZZ_REQUIRE(next->segment.steps <= steps_of(train->section, axis) - train->made);
    FUZZ_REQUIRE(next->backward == (bench.vector[train->section].steps[axis] < 0));
    if (train->lost) {
        guess_before(train, &next->segment);
    }
    step_generator_load(&train->generator, &next->segment);
    make_pulse(axis, next->tick, next->backward);
    make_others(axis, next);
}

static void hand_over(uint64_t until_tick)
{
    struct path_segment next;
    uint64_t end = bench.epoch + FOREVER_TICKS;
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        while (!bench.exhausted && path_next(&bench.path, axis, until_tick < end ? until_tick : end, &next)) {
            take_segment(axis, &next);
            bench.segments++;
            bench.exhausted = bench.segments == SEGMENTS_MAX;
        }
    }
}

/* Of what has been laid since the last change: before that the plan is not seen forward. */
static void require_plan(void)
{
    const struct path *path = &bench.path;
    bool slower = bench.slower;
    uint32_t origin = path->origin.section;
    uint32_t first = origin < path->first ? path->first : origin;
    for (uint32_t i = first; i + 1U < path->laid && path->start_speed == 0 && !path->stopping; i++) {
        const struct path_section *section = &path->ring[i % path->size];
        const struct path_section *after = &path->ring[(i + 1U) % path->size];
        FUZZ_REQUIRE(section->exit2 <= after->exit2 + after->gain2);
        FUZZ_REQUIRE(after->exit2 <= section->exit2 + after->gain2);
        FUZZ_REQUIRE(slower || section->exit2 <= section->speed2);
        FUZZ_REQUIRE(slower || (section->exit2 <= after->speed2 && section->exit2 <= after->border2));
        FUZZ_REQUIRE(slower || i + 2U != path->known || after->exit2 == 0);
    }
}

/* Pulses of an axis up to a place, from the beginning of its vector. */
static uint32_t pulses_up_to(const struct path_place *place, unsigned axis)
{
    const struct path_vector *vector = &bench.vector[place->section];
    unsigned __int128 way = (unsigned __int128)place->entry.place.high << 64U | place->entry.place.low;
    way = way * steps_of(place->section, axis) / length_of(place->section);
    return (uint32_t)(way / (PATH_GRAINS_PER_ACCEL * (place->accel != 0 ? place->accel : vector->accel)));
}

static void require_rest(void)
{
    const struct path_place *rest = &bench.path.rest;
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        int64_t position = 0;
        for (uint32_t i = 0; i < rest->section; i++) {
            position += bench.vector[i].steps[axis];
        }
        if (rest->entry.place.high != 0 || rest->entry.place.low != 0) {
            int64_t part = pulses_up_to(rest, axis);
            position += bench.vector[rest->section].steps[axis] < 0 ? -part : part;
        }
        FUZZ_REQUIRE(bench.train[axis].position == position);
        FUZZ_REQUIRE(bench.train[axis].last <= rest->entry.time.high + 1U);
    }
}

/* To the end, or the rest; false if that is too far away. */
static bool settle(void)
{
    hand_over(UINT64_MAX);
    if (bench.exhausted || !path_is_laid(&bench.path) ||
        bench.path.rest.entry.time.high > bench.epoch + FOREVER_TICKS) {
        bench.exhausted = true;
        return false;
    }
    if (bench.moves) {
        require_rest();
        uint64_t stands = bench.path.rest.entry.time.high + 1U;
        bench.now = bench.now > stands ? bench.now : stands;
    }
    bench.moves = false;
    return true;
}

static void do_start(struct fuzz_stream *stream)
{
    uint64_t tick = fuzz_take_size(stream, SIZE_TIME_BITS);
    if (!settle()) {
        return;
    }
    bool left = bench.path.rest.section != bench.path.end;
    bool starts = path_start(&bench.path, bench.now + tick);
    FUZZ_REQUIRE(starts == left);
    bench.moves = bench.moves || starts;
    bench.started = starts ? bench.now + tick : bench.started;
    bench.slower = bench.slower && !starts;
    require_plan();
}

/* The vector with the last pulse that an axis has made, or its first one. */
static uint32_t last_section(unsigned axis)
{
    uint32_t section = bench.train[axis].section;
    bool begins = bench.train[axis].made == 0;
    while (section > 0 && (begins || steps_of(section, axis) == 0)) {
        section--;
        begins = false;
    }
    return section;
}

/* What comes after a place is not made. */
static void go_back(const struct path_place *place, unsigned axis, uint64_t back)
{
    struct train *train = &bench.train[axis];
    uint64_t time = place->entry.time.high;
    for (; back > 0; back--) {
        if (train->kept > 0) {
            FUZZ_REQUIRE(train->tick[train->kept - 1U] + 1U >= time);
            train->kept--;
        }
        while (train->made == 0) {
            FUZZ_REQUIRE(train->section > place->section);
            train->section--;
            train->made = steps_of(train->section, axis);
        }
        train->made--;
        train->position += bench.vector[train->section].steps[axis] < 0 ? 1 : -1;
        train->last = train->kept > 0 ? train->tick[train->kept - 1U] : bench.epoch;
    }
    FUZZ_REQUIRE(train->kept == 0 || train->last <= time + 2U);
    train->backward = bench.vector[last_section(axis)].steps[axis] < 0;
    train->generator.tick = (uint32_t)train->last;
    train->lost = train->lost || train->kept == 0;
}

static void take_back(const struct path_place *place, const uint64_t back[PATH_AXES])
{
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        if (back[axis] > KEPT_MAX) {
            bench.exhausted = true;
            return;
        }
        go_back(place, axis, back[axis]);
    }
    memset(&bench.border[place->section], 0, (VECTORS_MAX - place->section) * sizeof bench.border[0]);
}

static void forget_made(void)
{
    uint32_t first = bench.path.first;
    while (first != bench.path.laid && bench.border[first] != 0 && bench.border[first] + 2U < bench.now &&
           (bench.moves ? first + 1U < bench.path.laid : first < bench.path.rest.section)) {
        first++;
    }
    path_drop(&bench.path, first);
}

static void add(struct fuzz_stream *stream)
{
    struct path *path = &bench.path;
    bool full = path->end - path->first == path->size;
    if (full || path->end == VECTORS_MAX) {
        FUZZ_REQUIRE(!full || !path_add(path, &bench.vector[0]));
        return;
    }
    bench.vector[path->end] = fuzz_take_vector(stream);
    bool added = path_add(path, &bench.vector[path->end]);
    FUZZ_REQUIRE(added);
}

static void set_speeds(struct fuzz_stream *stream, uint32_t first)
{
    uint32_t speed = fuzz_take_limited(stream, PATH_SPEED_MAX);
    bench.slower = true;
    bool all = (fuzz_take_byte(stream) & 1U) != 0;
    for (uint32_t i = first; i != (all ? bench.path.end : first + 1U); i++) {
        path_ready_speed(&bench.path, i, speed);
        path_take_speed(&bench.path, i);
        bench.vector[i].speed = speed;
    }
}

static void stop(const struct path_place *place, uint64_t back[PATH_AXES])
{
    bool done = path_back(&bench.path, place, back);
    FUZZ_REQUIRE(done);
    path_stop(&bench.path, place);
    if (place->accel == 0) {
        return;
    }
    bench.slower = true;
    bench.braked_otherwise = true;
    for (uint32_t i = place->section; i != bench.path.end; i++) {
        bench.vector[i].accel = place->accel;
    }
}

static void change(struct fuzz_stream *stream, unsigned kind, const struct path_place *place, uint64_t back[PATH_AXES])
{
    if (kind == 5) {
        set_speeds(stream, place->section);
    } else {
        add(stream);
    }
    bool done = path_back(&bench.path, place, back);
    FUZZ_REQUIRE(done);
    path_change(&bench.path, place);
}

/* Some time from now on, or about the border up to which the path has been laid. */
static uint64_t take_moment(struct fuzz_stream *stream, bool at_border)
{
    uint64_t later = fuzz_take_size(stream, SIZE_TIME_BITS);
    uint64_t border = bench.path.next.time.high + later % 4U;
    return at_border && bench.moves && border >= bench.now + 2U ? border - 2U : bench.now + later;
}

/* 4: a stop, 5: another speed, 6: another vector. */
static void do_change(struct fuzz_stream *stream, unsigned kind, unsigned operand)
{
    struct path_place place;
    uint64_t back[PATH_AXES];
    struct path_wish wish = {.tick = take_moment(stream, (operand & 8U) != 0)};
    wish.patience_ticks = (operand & 1U) != 0 ? UINT64_MAX / 4U : fuzz_take_size(stream, SIZE_TIME_BITS) - 1U;
    wish.accel = kind == 4 && (operand & 4U) != 0 ? fuzz_take_limited(stream, PATH_ACCEL_MAX) : 0;
    if (!bench.moves || wish.tick > bench.epoch + FOREVER_TICKS || !path_find(&bench.path, &wish, &place)) {
        return;
    }
    uint64_t ahead = (operand & 2U) != 0 ? fuzz_take_size(stream, SIZE_TIME_BITS) : 0;
    FUZZ_REQUIRE(place.entry.time.high + 1U >= wish.tick && place.section < bench.path.end);
    FUZZ_REQUIRE(place.entry.speed2 <= (uint64_t)PATH_SPEED_MAX * PATH_SPEED_MAX);
    hand_over(place.entry.time.high + 2U + ahead);
    if (bench.exhausted || place.entry.time.high >= bench.epoch + FOREVER_TICKS) {
        return;
    }
    if (kind == 4) {
        stop(&place, back);
    } else {
        change(stream, kind, &place, back);
    }
    take_back(&place, back);
    require_plan();
}

static void do_operation(struct fuzz_stream *stream)
{
    uint8_t operation = fuzz_take_byte(stream);
    unsigned operand = operation / 8U;
    switch (operation % 8U) {
    case 0:
    case 1:
        for (unsigned i = 0; i <= operand; i++) {
            add(stream);
        }
        require_plan();
        break;
    case 2:
        do_start(stream);
        break;
    case 3:
        bench.now += fuzz_take_size(stream, SIZE_TIME_BITS);
        hand_over(bench.now + fuzz_take_size(stream, SIZE_TIME_BITS));
        break;
    case 7:
        forget_made();
        break;
    default:
        do_change(stream, operation % 8U, operand);
        break;
    }
}

/* One run at a time of the unit; returns what all such runs have in common. */
static uint64_t run(struct fuzz_stream stream, uint64_t epoch)
{
    memset(&bench, 0, sizeof bench);
    bench.epoch = epoch;
    bench.now = epoch;
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        bench.train[axis].last = epoch;
        step_generator_start(&bench.train[axis].generator, (uint32_t)epoch);
    }
    uint8_t form = fuzz_take_byte(&stream);
    uint32_t turn_us = (form & 1U) != 0 ? 12 : 1U + fuzz_take_pair(&stream) % PATH_TURN_US_MAX;
    path_init(&bench.path, bench.ring, 2U << (form / 64U), turn_us);
    if ((form & 2U) != 0) {
        path_set_start_speed(&bench.path, fuzz_take_limited(&stream, PATH_SPEED_MAX));
    }
    for (unsigned i = 0; i < OPERATIONS_MAX && !fuzz_stream_is_over(&stream) && !bench.exhausted; i++) {
        do_operation(&stream);
    }
    if (!bench.exhausted) {
        (void)settle();
    }
    return bench.digest;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_stream stream = fuzz_stream_of(data, size);
    uint64_t before_wrap = fuzz_take_size(&stream, SIZE_TIME_BITS);
    uint64_t digest = run(stream, 0);
    uint64_t shifted = run(stream, (UINT64_C(1) << (32U + before_wrap % 29U)) - before_wrap % (UINT64_C(1) << 32U));
    FUZZ_REQUIRE(digest == shifted);
    return 0;
}
