#include "gve_queue_private.h"

#include <assert.h>
#include <stddef.h>

#include "base_tick.h"
#include "hal_run.h"
#include "hal_time.h"
#include "hal_trace.h"

enum {
    START_TICKS = 600 * TICKS_PER_US, /* group_start wants 500 us, the contract 1 ms from the CR on */
    OWN_AXIS = UNIT_MOTORS - 1,
    ACCEL_UNIT = 1000, /* A is in 1000 pulses/s^2 */
};

static_assert((uint32_t)UNIT_MOTORS == (uint32_t)PATH_AXES, "each motor has an axis");
static_assert((GVE_QUEUE_VECTORS & (GVE_QUEUE_VECTORS - 1)) == 0, "the ring of the vectors is that of the path");

static void init_chain(struct gve_queue *queue, unsigned chain, struct gve_vector *vectors, struct path_section *ring,
                       uint32_t size)
{
    queue->chain[chain].vectors = vectors;
    queue->chain[chain].size = size;
    group_init(&queue->chain[chain].group, ring, size);
}

void gve_queue_init(struct gve_queue *queue)
{
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        step_channel_init(&queue->channel[motor], motor);
        queue->latched_steps[motor] = 0;
    }
    gve_guards_init(&queue->guards);
    gve_modal_init(&queue->modal);
    queue->factor = GVE_FACTOR_ONE;
    atomic_store_explicit(&queue->used, 0, memory_order_relaxed);
    init_chain(queue, 0, queue->vectors, queue->ring, GVE_QUEUE_VECTORS);
    init_chain(queue, 1, queue->vectors_beside, queue->ring_beside, GVE_QUEUE_VECTORS_BESIDE);
    queue->kept = (struct gve_kept){.valid = false};
    queue->home = (struct gve_home){.result = GVE_HOME_DONE};
    queue->inta = false;
    queue->intcom = false;
    queue->halting = false;
    queue->stopping = false;
    queue->last_tick = 0;
    gve_queue_couple(queue, OWN_AXIS);
}

void gve_queue_couple(struct gve_queue *queue, unsigned axis)
{
    queue->coupling = (uint8_t)axis;
    for (unsigned chain = 0; chain < 2U; chain++) {
        for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
            unsigned follows = motor == (unsigned)OWN_AXIS ? axis : motor;
            group_connect(&queue->chain[chain].group, motor, &queue->channel[motor], follows);
        }
    }
}

/* ---- states --------------------------------------------------------------------------------------------------- */

bool gve_queue_moves(const struct gve_queue *queue)
{
    return group_is_busy(gve_queue_group(queue));
}

bool gve_queue_runs(const struct gve_queue *queue)
{
    return gve_queue_moves(queue) || group_has_rest(gve_queue_group(queue));
}

bool gve_queue_is_stopping(const struct gve_queue *queue)
{
    return gve_queue_moves(queue) && group_cause(gve_queue_group(queue)) != AXIS_CAUSE_NONE;
}

uint32_t gve_queue_room(const struct gve_queue *queue)
{
    return queue->kept.valid ? 0U : group_room(gve_queue_group(queue));
}

/* ---- vectors --------------------------------------------------------------------------------------------------- */

void gve_queue_add(struct gve_queue *queue, const struct gve_vector *vector, uint32_t speed, uint32_t border_speed)
{
    struct gve_chain *chain = gve_queue_chain(queue);
    struct path_vector path = {
        .speed = speed,
        .accel = vector->accel * (uint32_t)ACCEL_UNIT * STEP_ACCEL_PER_ACCEL,
        .extent2 = gve_speeds_extent2(vector),
        .border_speed = border_speed,
    };
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        path.steps[axis] = vector->steps[axis];
    }
    chain->vectors[group_end(&chain->group) & (chain->size - 1U)] = *vector;
    bool added = group_add(&chain->group, &path);
    assert(added);
    (void)added;
}

void gve_queue_enter(struct gve_queue *queue, const int32_t steps[PATH_AXES])
{
    const struct gve_chain *chain = gve_queue_chain(queue);
    struct gve_vector vector = gve_speeds_take(&queue->modal, steps);
    uint32_t border_speed = PATH_SPEED_MAX;
    if (gve_queue_runs(queue)) {
        const struct gve_vector *before = &chain->vectors[(group_end(&chain->group) - 1U) & (chain->size - 1U)];
        border_speed = gve_speeds_border(before, &vector, queue->modal.jump);
    } else {
        queue->pause_ticks = (uint64_t)queue->modal.pause_ms * TICKS_PER_MS;
    }
    gve_queue_add(queue, &vector, gve_speeds_limit(&vector, queue->factor, queue->modal.limit), border_speed);
}

void gve_queue_begin(struct gve_queue *queue, uint8_t inputs)
{
    if (!queue->inta && !gve_queue_moves(queue) && group_has_rest(gve_queue_group(queue))) {
        gve_queue_start(queue, inputs);
    }
}

static uint32_t gve134_speed_of(const void *context, uint32_t section)
{
    const struct gve_queue *queue = context;
    const struct gve_chain *chain = gve_queue_chain_of(queue);
    return gve_speeds_limit(&chain->vectors[section & (chain->size - 1U)], queue->factor, queue->taken_limit);
}

void gve_queue_change(struct gve_queue *queue, uint32_t factor, bool last)
{
    struct gve_chain *chain = gve_queue_chain(queue);
    uint32_t end = group_end(&chain->group);
    queue->factor = factor;
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        queue->taken_limit[axis] = queue->modal.limit[axis];
    }
    for (uint32_t count = group_first(&chain->group); last && count != end; count++) {
        chain->vectors[count & (chain->size - 1U)].speed = queue->modal.speed;
    }
    if (gve_home_phase(queue) == GVE_HOME_NONE) {
        group_set_speeds(&chain->group, &(struct group_speeds){.of = gve134_speed_of, .context = queue});
    }
}

/* ---- positions ------------------------------------------------------------------------------------------------- */

static void copy_positions(const struct gve_queue *queue, int64_t steps[UNIT_MOTORS])
{
    hal_step_hold();
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        steps[motor] = step_channel_position_held(&queue->channel[motor]);
    }
    hal_step_release();
}

/* A coupled A shows its axis. */
static void show_coupled(const struct gve_queue *queue, int64_t steps[UNIT_MOTORS])
{
    steps[OWN_AXIS] = steps[queue->coupling];
}

void gve_queue_positions(const struct gve_queue *queue, int64_t steps[UNIT_MOTORS])
{
    copy_positions(queue, steps);
    show_coupled(queue, steps);
}

void gve_queue_latched(const struct gve_queue *queue, int64_t steps[UNIT_MOTORS])
{
    hal_step_hold();
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        steps[motor] = queue->latched_steps[motor];
    }
    hal_step_release();
    show_coupled(queue, steps);
}

void gve_queue_set_position(struct gve_queue *queue, unsigned axis, int64_t steps)
{
    step_channel_set_position(&queue->channel[axis], steps);
}

/* ---- motion ---------------------------------------------------------------------------------------------------- */

static void tell_start(struct gve_queue *queue, uint64_t tick)
{
    gve_queue_positions(queue, queue->start_steps);
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        hal_trace(tick, motor + 1U, HAL_TRACE_MOVE, 0);
    }
}

void gve_queue_start(struct gve_queue *queue, uint8_t inputs)
{
    uint64_t tick = hal_time_now() + (uint64_t)START_TICKS;
    uint64_t paused = queue->last_tick + queue->pause_ticks;
    tick = queue->last_tick != 0 && paused > tick ? paused : tick;
    queue->pause_ticks = 0;
    tell_start(queue, tick);
    bool started = group_start(&gve_queue_chain(queue)->group, tick);
    assert(started);
    (void)started;
    gve_queue_sense(queue, inputs);
}

/* The last pulse of all axes. One that came more than 25 s before the others may be taken for a later one, but not
 * for one to come. */
static void note_last_pulse(struct gve_queue *queue, uint64_t now)
{
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        const struct step_channel *channel = &queue->channel[motor];
        uint64_t tick = tick_extend(step_channel_end_tick(channel), now);
        if (step_channel_pulses(channel) != 0 && tick <= now && tick > queue->last_tick) {
            queue->last_tick = tick;
        }
    }
}

void gve_queue_tell_end(const struct gve_queue *queue, uint64_t tick)
{
    int64_t steps[UNIT_MOTORS];
    gve_queue_positions(queue, steps);
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        hal_trace(tick, motor + 1U, HAL_TRACE_DONE, steps[motor] - queue->start_steps[motor]);
    }
}

/* The last pulse is rounded by itself, and may be a tick after the rest: onlookers are told of the end with it. */
static uint64_t end_tick(const struct gve_queue *queue)
{
    uint64_t rest_tick = group_end_tick(gve_queue_group(queue));
    return rest_tick < queue->last_tick ? queue->last_tick : rest_tick;
}

/* The axes stand. */
static void end(struct gve_queue *queue, uint8_t inputs)
{
    enum axis_cause cause = group_cause(gve_queue_group(queue));
    bool stopped = cause == AXIS_CAUSE_HIGH || cause == AXIS_CAUSE_COMMAND || queue->halting || queue->stopping;
    note_last_pulse(queue, hal_time_now());
    gve_queue_tell_end(queue, end_tick(queue));
    if (gve_home_phase(queue) != GVE_HOME_NONE) {
        gve_home_follow(queue, stopped, inputs);
    } else if (stopped) {
        queue->inta = true;
        queue->intcom = queue->intcom || queue->halting;
    } else if (group_has_rest(gve_queue_group(queue))) {
        queue->pause_ticks = (uint64_t)queue->modal.pause_ms * TICKS_PER_MS; /* they came too late to join */
    } else {
        /* the queue has run dry */
    }
    if (!gve_queue_moves(queue)) {
        queue->halting = false;
        queue->stopping = false;
    }
}

uint64_t gve_queue_poll(struct gve_queue *queue, uint8_t inputs)
{
    struct group *group = &gve_queue_chain(queue)->group;
    uint64_t wake = group_poll(group);
    if (group_take_end(group)) {
        end(queue, inputs);
        gve_queue_begin(queue, inputs);
    }
    return wake;
}

void gve_queue_plan_isr(struct gve_queue *queue)
{
    group_plan_isr(&gve_queue_chain(queue)->group);
}

unsigned gve_queue_lay_isr(struct gve_queue *queue, unsigned motor, struct hal_step_room *room)
{
    return step_channel_lay_isr(&queue->channel[motor], room);
}

/* The tick interrupt may come at any time in main, so the state is that of the group, by which both agree. */
bool gve_queue_sense_isr(struct gve_queue *queue, uint8_t inputs)
{
    struct group *group = &gve_queue_chain(queue)->group;
    uint16_t active = gve_home_mask(queue, gve_guards_active(&queue->guards, inputs));
    bool stops = gve_home_sense_isr(queue, inputs);
    bool interrupts = active != 0;
    bool brakes = interrupts && group_stop_isr(group, AXIS_CAUSE_HIGH);
    if (brakes || (interrupts && gve_home_end_isr(queue))) {
        copy_positions(queue, queue->latched_steps);
        hal_trace(hal_time_now(), 0, HAL_TRACE_STOP, AXIS_CAUSE_HIGH);
    }
    if (interrupts && group_is_stopping(group)) {
        gve_guards_add_causes(&queue->guards, active);
    }
    return stops || brakes;
}

void gve_queue_sense(struct gve_queue *queue, uint8_t inputs)
{
    if (gve_queue_sense_isr(queue, inputs)) {
        hal_run_plan();
    }
}
