#include "group.h"

#include <assert.h>

#include "base_tick.h"
#include "group_private.h"
#include "hal_driver.h"
#include "hal_run.h"
#include "hal_step.h"
#include "hal_time.h"

enum {
    /* So much is handed over ahead. Vectors join without a change up to that; main has so much time between passes. */
    FEED_TICKS = 20 * TICKS_PER_MS,
    POLL_TICKS = 4 * TICKS_PER_MS,
    WAKE_SEGMENTS = STEP_QUEUE_SEGMENTS / 2,
    FEED_SLICE_TICKS = 80 * TICKS_PER_US, /* a pass goes on for so long, so that others have their turn */
    MADE_TICKS = TICKS_PER_MS, /* a section is over so long after its end: its last pulses may have been late */
};

void group_init(struct group *group, struct path_section *ring, uint32_t size)
{
    *group = (struct group){.state = AXIS_STANDING};
    path_init(&group->path, ring, size, hal_step_turn_us());
}

void group_connect(struct group *group, unsigned motor, struct step_channel *channel, unsigned axis)
{
    assert(!group_is_busy(group));
    for (unsigned i = 0; i < (unsigned)PATH_AXES; i++) {
        group->motors[i] &= (uint8_t)~(1U << motor);
    }
    if (channel != NULL) {
        group->motors[axis] |= (uint8_t)(1U << motor);
        step_channel_wake_with(channel, WAKE_SEGMENTS);
    }
    group->channel[motor] = channel;
    group->axis[motor] = (uint8_t)axis;
}

static void take_manner(struct group *group)
{
    path_set_start_speed(&group->path, group->manner.start_speed);
    path_set_before(&group->path, group->manner.before);
}

void group_set_manner(struct group *group, const struct group_manner *manner)
{
    assert(!group_is_busy(group) && group->path.first == group->path.end);
    group->manner = *manner;
    take_manner(group);
}

bool group_add(struct group *group, const struct path_vector *vector)
{
    hal_run_hold_plan();
    bool added = path_add(&group->path, vector);
    hal_run_release_plan();
    return added;
}

uint32_t group_room(const struct group *group)
{
    return group->path.size - (group->path.end - group->path.first);
}

uint32_t group_first(const struct group *group)
{
    return group->path.first;
}

uint32_t group_end(const struct group *group)
{
    return group->path.end;
}

static void hand_over(struct step_channel *channel, const struct path_segment *next)
{
    step_channel_turn(channel, next->backward);
    (void)step_channel_push(channel, &next->segment);
}

static bool has_room(const struct group *group, unsigned axis)
{
    for (unsigned left = group->motors[axis]; left != 0; left &= left - 1U) {
        unsigned motor = group_lowest(left);
        if (step_channel_room(group->channel[motor]) == 0) {
            return false;
        }
    }
    return true;
}

bool group_feed_axis(struct group *group, unsigned axis, uint64_t until_tick)
{
    struct path_segment next;
    if (!path_moves(&group->path, axis) || !has_room(group, axis) ||
        !path_next(&group->path, axis, until_tick, &next)) {
        return false;
    }
    for (unsigned left = group->motors[axis]; left != 0; left &= left - 1U) {
        unsigned motor = group_lowest(left);
        hand_over(group->channel[motor], &next);
        if (!step_channel_is_running(group->channel[motor])) {
            step_channel_run(group->channel[motor]);
        }
    }
    return true;
}

/* The first segment of an axis says how DIR is to stand from the start on. An axis without one turns later. */
static void begin_axis(struct group *group, unsigned axis, uint64_t start_tick)
{
    struct path_segment next;
    bool moves = path_next(&group->path, axis, start_tick + (uint64_t)FEED_TICKS, &next);
    for (unsigned left = group->motors[axis]; left != 0; left &= left - 1U) {
        unsigned motor = group_lowest(left);
        struct step_channel *channel = group->channel[motor];
        step_channel_begin(channel, (uint32_t)start_tick, moves ? next.backward : channel->direction < 0);
        if (moves) {
            hand_over(channel, &next);
        }
    }
}

static void run_pushed(const struct group *group)
{
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        struct step_channel *channel = group->channel[motor];
        if (channel != NULL && step_channel_room(channel) < (uint32_t)STEP_QUEUE_SEGMENTS) {
            step_channel_run(channel);
        }
    }
}

bool group_start(struct group *group, uint64_t start_tick)
{
    assert(!group_is_busy(group));
    hal_run_hold_plan();
    bool starts = path_start(&group->path, start_tick);
    if (starts) {
        hal_driver_enable();
        for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
            begin_axis(group, axis, start_tick);
        }
        atomic_store_explicit(&group->cause, AXIS_CAUSE_NONE, memory_order_relaxed);
        run_pushed(group);
        (void)axis_state_enter(&group->state, AXIS_BEGIN);
    }
    hal_run_release_plan();
    return starts;
}

/* Sections whose end has long gone by make room. */
static void drop_made(struct group *group, uint64_t now)
{
    const struct path *path = &group->path;
    uint32_t first = path->first;
    while (path->laid - first > 1U &&
           path->ring[(first + 1U) & (path->size - 1U)].entered.high + (uint64_t)MADE_TICKS < now) {
        first++;
    }
    path_drop(&group->path, first);
}

static bool all_rest(const struct group *group)
{
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        if (group->channel[motor] != NULL && step_channel_is_running(group->channel[motor])) {
            return false;
        }
    }
    return true;
}

/* All that is due up to the rest has been handed over by the time of the rest, if there was room. A path that is
 * stopped before it has left its stand is at rest already. */
static bool has_ended(const struct group *group, uint64_t now)
{
    const struct path *path = &group->path;
    bool stays = path->stopping && path->rest.entry.time.high == path->origin.entry.time.high;
    return path_is_laid(path) && (stays || path->rest.entry.time.high < now) && all_rest(group);
}

/* A stop that comes in just this moment is told as the cause, and there is nothing left to stop. */
static void end(struct group *group)
{
    path_drop(&group->path, group->path.rest.section);
    while (!axis_state_enter(&group->state, AXIS_LAST)) {
    }
}

/* A segment at a time, so that a stop need not wait. True: more may follow. */
static bool feed(struct group *group, uint64_t until_tick)
{
    bool fed = false;
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        hal_run_hold_plan();
        fed = group_feed_axis(group, axis, until_tick) || fed;
        hal_run_release_plan();
    }
    return fed;
}

static bool is_moving(const struct group *group)
{
    enum axis_state state = (enum axis_state)atomic_load_explicit(&group->state, memory_order_relaxed);
    return state > AXIS_STANDING && state < AXIS_ENDED;
}

/* The end is to be seen soon: a host may wait for it. */
static uint64_t next_poll(const struct group *group, uint64_t now)
{
    uint64_t end_tick = path_is_laid(&group->path) ? group->path.rest.entry.time.high + 1U : TICK_NEVER;
    uint64_t poll = now + (uint64_t)POLL_TICKS;
    return end_tick > now && end_tick < poll ? end_tick : poll;
}

uint64_t group_poll(struct group *group)
{
    if (!is_moving(group)) {
        return TICK_NEVER;
    }
    uint64_t begin = hal_time_now();
    hal_run_hold_plan();
    group_plan(group);
    drop_made(group, begin);
    hal_run_release_plan();
    while (feed(group, hal_time_now() + (uint64_t)FEED_TICKS)) {
        if (hal_time_now() - begin >= (uint64_t)FEED_SLICE_TICKS) {
            return begin;
        }
    }
    uint64_t now = hal_time_now();
    hal_run_hold_plan();
    if (has_ended(group, now)) {
        end(group);
    }
    hal_run_release_plan();
    return is_moving(group) ? next_poll(group, now) : now;
}

bool group_take_end(struct group *group)
{
    return axis_state_enter(&group->state, AXIS_TAKE);
}

uint64_t group_end_tick(const struct group *group)
{
    return group->path.rest.entry.time.high;
}

bool group_has_rest(const struct group *group)
{
    return group->path.rest.section != group->path.end;
}

void group_forget(struct group *group)
{
    assert(!group_is_busy(group));
    path_init(&group->path, group->path.ring, group->path.size, group->path.turn_us);
    take_manner(group);
}

uint32_t group_speed_at(struct group *group, uint32_t section, uint32_t step)
{
    hal_run_hold_plan();
    uint32_t speed = path_speed_at(&group->path, section, step);
    hal_run_release_plan();
    return speed;
}
