#include <assert.h>

#include "base_tick.h"
#include "group_private.h"
#include "hal_run.h"
#include "hal_step.h"
#include "hal_time.h"

enum {
    /* From the plan's begin to the place: what planning takes, and the lead of the step output. */
    LEAD_TICKS = PATH_EARLY_US_MAX * TICKS_PER_US,
    LEAD_TICKS_MAX = 8 * LEAD_TICKS,
    LOOK_TICKS = TICKS_PER_US * 2 / 3, /* more for each section that is looked at, with another speed or not */
    REACH_TICKS = TICK_HZ,             /* a place that is further ahead waits until the motors are nearer */
    PATIENCE_TICKS = 500 * TICKS_PER_US,
    GO_ON_TICKS = 370 * TICKS_PER_US, /* so much is handed over after the place at once */
    FIRST_TICKS = 4 * TICKS_PER_MS,   /* and the first segment of each axis, if it is due by then */
    THAW_TICKS = 90 * TICKS_PER_US,   /* the motors go on so long before it: the last segment may be on its way */
};

/* Thaws the motors before `motor`, all at once: each lays its next pulse before one of them lays what is farther ahead.
 */
static void thaw(struct group *group, unsigned motor)
{
    hal_step_hold();
    while (motor-- > 0) {
        if (group->channel[motor] != NULL) {
            step_channel_thaw_held(group->channel[motor]);
        }
    }
    hal_step_release();
}

/* All motors or none. */
static bool freeze(struct group *group, const uint64_t back[PATH_AXES])
{
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        if (group->channel[motor] != NULL && !step_channel_freeze(group->channel[motor], back[group->axis[motor]])) {
            thaw(group, motor);
            return false;
        }
    }
    return true;
}

/* What is frozen is dropped, and the first segment that the path now has instead comes after what stays. */
static void recall(struct group *group, const uint64_t back[PATH_AXES], uint64_t until_tick)
{
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        struct path_segment next;
        bool moves = path_moves(&group->path, axis) && path_next(&group->path, axis, until_tick, &next);
        for (unsigned left = group->motors[axis]; left != 0; left &= left - 1U) {
            unsigned motor = group_lowest(left);
            step_channel_recall(group->channel[motor], back[axis], moves ? &next.segment : NULL,
                                moves && next.backward);
        }
    }
}

/* Hands all over that is due before a place, in turns, as far as there is room; until `end_tick` at most. */
static void feed_until(struct group *group, uint64_t tick, uint64_t end_tick)
{
    bool fed = true;
    while (fed) {
        fed = false;
        for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
            if (!path_moves(&group->path, axis)) {
                continue;
            }
            if (hal_time_now() >= end_tick) {
                return;
            }
            fed = group_feed_axis(group, axis, tick) || fed;
        }
    }
}

static bool is_in(const struct group *group, enum axis_state state)
{
    return (enum axis_state)atomic_load_explicit(&group->state, memory_order_acquire) == state;
}

/* Of the sections from a count on: those before are over when it counts. */
static void take_speeds(struct group *group, uint32_t first)
{
    for (uint32_t section = first; section != group->path.end; section++) {
        path_take_speed(&group->path, section);
    }
    group->speeds_wait = false;
}

static uint64_t go_on_of(const struct group *group)
{
    return group->manner.go_on_ticks != 0 ? group->manner.go_on_ticks : (uint64_t)GO_ON_TICKS;
}

/* All that is to come after the place is frozen. Laying it would take the time in which its first segments, which may
 * be short, are planned: so that waits until they are there, or the place is near. */
static void plan_from(struct group *group, const struct path_place *place, const uint64_t back[PATH_AXES])
{
    if (is_in(group, AXIS_BRAKING)) {
        path_stop(&group->path, place);
    } else {
        if (group->speeds_wait) {
            take_speeds(group, place->section);
        }
        path_change(&group->path, place);
    }
    uint64_t tick = place->entry.time.high;
    uint64_t until_tick = tick + go_on_of(group);
    recall(group, back, tick + (uint64_t)FIRST_TICKS);
    feed_until(group, until_tick, tick - (uint64_t)THAW_TICKS);
    thaw(group, UNIT_MOTORS);
    feed_until(group, until_tick, TICK_NEVER);
}

enum change {
    CHANGED,
    RESTS, /* it comes to rest before a change can take effect */
    LATER, /* its queues are full, and end before that, or it is far ahead */
};

/* Hands over what is due before a place, if need be; false if there is no room for all of it, or it is far ahead: 32
 * bits of a tick could take a pulse of minutes ahead for past. */
static bool reach(struct group *group, const struct path_place *place, uint64_t back[PATH_AXES])
{
    if (place->entry.time.high > hal_time_now() + (uint64_t)REACH_TICKS) {
        return false;
    }
    if (path_back(&group->path, place, back)) {
        return true;
    }
    feed_until(group, place->entry.time.high + 2U, TICK_NEVER);
    return path_back(&group->path, place, back);
}

/* How long planning takes where no section is looked at. */
static uint64_t least_lead_of(const struct group *group)
{
    return group->manner.lead_ticks != 0 ? group->manner.lead_ticks : (uint64_t)LEAD_TICKS;
}

/* How long planning takes at most. */
static uint64_t lead_of(const struct group *group)
{
    uint64_t sections = group->path.end - group->path.first;
    uint64_t each = is_in(group, AXIS_BRAKING) ? 0 : (uint64_t)LOOK_TICKS;
    return least_lead_of(group) + sections * each;
}

/* With which a stop brakes; 0: with that of the sections. */
static uint32_t accel_of(const struct group *group)
{
    bool fault = is_in(group, AXIS_BRAKING) && group_cause(group) == AXIS_CAUSE_FAULT;
    return fault ? group->manner.fault_accel : 0;
}

/* The first place that leaves time enough. */
static bool find(struct group *group, uint64_t lead, struct path_place *place)
{
    struct path_wish wish = {
        .tick = hal_time_now() + lead,
        .patience_ticks = group->manner.between_steps ? (uint64_t)PATIENCE_TICKS : TICK_NEVER / 2U,
        .early_ticks = group->manner.between_steps ? least_lead_of(group) : 0U,
        .accel = accel_of(group),
    };
    bool found = path_find(&group->path, &wish, place);
    if (found && wish.accel != 0 && !path_can_rest(&group->path, place)) {
        wish.accel = 0;
        found = path_find(&group->path, &wish, place);
    }
    return found;
}

/* Plans anew from the first place that leaves time enough; where it is too late to take back what lies after it, from
 * one that is twice as far ahead. */
static enum change change(struct group *group)
{
    for (uint64_t lead = lead_of(group); lead <= (uint64_t)LEAD_TICKS_MAX; lead *= 2U) {
        struct path_place place;
        uint64_t back[PATH_AXES];
        if (!find(group, lead, &place)) {
            return RESTS;
        }
        if (!reach(group, &place, back)) {
            return LATER;
        }
        if (freeze(group, back)) {
            plan_from(group, &place, back);
            return CHANGED;
        }
    }
    return LATER;
}

/* Nothing is left to stop where it rests by itself; vectors that came too late to join wait. */
static void plan_stop(struct group *group)
{
    enum axis_cause cause = group_cause(group);
    if (change(group) == LATER) {
        return;
    }
    hal_step_hold();
    if (group_cause(group) == cause) { /* a fault that has come meanwhile is to be planned yet */
        (void)axis_state_enter(&group->state, AXIS_PLANNED);
    }
    hal_step_release();
}

/* While a stop is yet to be planned all goes on as before, and it may be taken back: speeds wait for that. */
void group_plan(struct group *group)
{
    bool moves = is_in(group, AXIS_MOVING);
    if (is_in(group, AXIS_BRAKING)) {
        plan_stop(group);
    } else if (moves && (path_lags(&group->path) || group->speeds_wait)) {
        moves = change(group) != RESTS;
    }
    if (group->speeds_wait && !moves && !is_in(group, AXIS_BRAKING)) {
        take_speeds(group, group->path.first);
    }
}

void group_plan_isr(struct group *group)
{
    if (is_in(group, AXIS_BRAKING)) {
        plan_stop(group);
    }
}

bool group_stop_isr(struct group *group, enum axis_cause cause)
{
    bool harder = cause == AXIS_CAUSE_FAULT && group_cause(group) != AXIS_CAUSE_FAULT;
    if (harder) {
        (void)axis_state_enter(&group->state, AXIS_RESUME);
    }
    bool stops = axis_state_enter(&group->state, AXIS_STOP);
    if (stops) {
        atomic_store_explicit(&group->cause, (unsigned)cause, memory_order_relaxed);
    }
    return stops;
}

bool group_stop(struct group *group, enum axis_cause cause)
{
    hal_run_hold_plan();
    hal_step_hold();
    bool stops = group_stop_isr(group, cause);
    hal_step_release();
    if (stops) {
        plan_stop(group);
    }
    hal_run_release_plan();
    return stops;
}

/* What takes time comes first, while a stop can be planned. */
void group_set_speeds(struct group *group, const struct group_speeds *speeds)
{
    for (uint32_t section = group->path.first; section != group->path.end; section++) {
        path_ready_speed(&group->path, section, speeds->of(speeds->context, section));
    }
    hal_run_hold_plan();
    group->speeds_wait = true;
    group_plan(group);
    hal_run_release_plan();
}

/* The stop has been taken back, but for one that has come since. */
static void forget_cause(struct group *group)
{
    hal_step_hold();
    if (is_in(group, AXIS_MOVING)) {
        atomic_store_explicit(&group->cause, AXIS_CAUSE_NONE, memory_order_relaxed);
    }
    hal_step_release();
}

/* The tick interrupt may stop it at any time: then that counts. */
bool group_resume(struct group *group)
{
    hal_run_hold_plan();
    bool planned = is_in(group, AXIS_STOPPING);
    hal_step_hold();
    bool resumes = (group_cause(group) != AXIS_CAUSE_FAULT) && axis_state_enter(&group->state, AXIS_RESUME);
    hal_step_release();
    if (resumes && planned && change(group) != CHANGED) {
        (void)axis_state_enter(&group->state, AXIS_HALT);
        resumes = false;
    }
    if (resumes) {
        forget_cause(group);
    }
    hal_run_release_plan();
    return resumes;
}
