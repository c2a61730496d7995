#include "gve_queue_private.h"

#include "base_wide.h"

static void set_phase(struct gve_queue *queue, enum gve_home_phase phase)
{
    atomic_store_explicit(&queue->home.phase, (uint8_t)phase, memory_order_relaxed);
}

static bool has_reached(const struct gve_queue *queue)
{
    return atomic_load_explicit(&queue->home.reached, memory_order_acquire);
}

static int64_t position_of(const struct gve_queue *queue)
{
    return step_channel_position(&queue->channel[queue->home.order.axis]);
}

/* A motion of the axis alone, as a vector of one speed. */
static void begin_phase(struct gve_queue *queue, enum gve_home_phase phase, int32_t way, uint32_t speed, uint8_t inputs)
{
    struct gve_vector vector = {.speed = speed, .brake = GVE_SPEED_TOP, .accel = queue->modal.accel};
    vector.steps[queue->home.order.axis] = way;
    queue->home.begin_steps = position_of(queue);
    atomic_store_explicit(&queue->home.reached, false, memory_order_relaxed);
    atomic_store_explicit(&queue->home.ended, false, memory_order_relaxed);
    set_phase(queue, phase);
    gve_queue_add(queue, &vector, gve_speeds_limit(&vector, GVE_FACTOR_ONE, queue->modal.limit), PATH_SPEED_MAX);
    gve_queue_start(queue, inputs);
}

static void leave_switch(struct gve_queue *queue, uint8_t inputs)
{
    const struct gve_home_order *order = &queue->home.order;
    begin_phase(queue, GVE_HOME_FROM_SWITCH, order->way > 0 ? -order->way_back : order->way_back, order->speed_back,
                inputs);
}

static void finish(struct gve_queue *queue, enum gve_home_result result)
{
    queue->home.result = (uint8_t)result;
    queue->inta = result != GVE_HOME_DONE;
    set_phase(queue, GVE_HOME_NONE);
}

void gve_queue_home(struct gve_queue *queue, const struct gve_home_order *order, uint8_t inputs)
{
    queue->home.order = *order;
    queue->home.result = (uint8_t)GVE_HOME_RUNS;
    if (gve_guards_switch(&queue->guards, inputs, order->axis)) {
        leave_switch(queue, inputs);
    } else {
        begin_phase(queue, GVE_HOME_TO_SWITCH, order->way, order->speed, inputs);
    }
}

enum gve_home_result gve_queue_home_result(const struct gve_queue *queue)
{
    return (enum gve_home_result)queue->home.result;
}

/* The switch let go between the pulse made last then and the next one: back to the place of that one. */
static void go_back(struct gve_queue *queue, uint8_t inputs)
{
    struct gve_home *home = &queue->home;
    int64_t forward = home->order.way > 0 ? -1 : 1;
    int64_t made = (home->place_steps - home->begin_steps) * forward;
    int64_t way = home->place_steps + forward - position_of(queue);
    if (made >= home->order.way_back) {
        finish(queue, GVE_HOME_NOT_FOUND);
    } else if (way == 0) {
        finish(queue, GVE_HOME_DONE);
    } else {
        begin_phase(queue, GVE_HOME_BACK, (int32_t)way, home->order.speed_back, inputs);
    }
}

void gve_home_follow(struct gve_queue *queue, bool stopped, uint8_t inputs)
{
    enum gve_home_phase phase = gve_home_phase(queue);
    bool reached = has_reached(queue);
    group_forget(&gve_queue_chain(queue)->group);
    if (stopped || atomic_load_explicit(&queue->home.ended, memory_order_relaxed)) {
        finish(queue, GVE_HOME_STOPPED);
    } else if (phase == GVE_HOME_BACK) {
        finish(queue, GVE_HOME_DONE);
    } else if (!reached) {
        finish(queue, GVE_HOME_NOT_FOUND);
    } else if (phase == GVE_HOME_TO_SWITCH) {
        leave_switch(queue, inputs);
    } else {
        go_back(queue, inputs);
    }
}

bool gve_home_sense_isr(struct gve_queue *queue, uint8_t inputs)
{
    struct gve_home *home = &queue->home;
    enum gve_home_phase phase = gve_home_phase(queue);
    if (phase != GVE_HOME_TO_SWITCH && phase != GVE_HOME_FROM_SWITCH) {
        return false;
    }
    bool wanted = phase == GVE_HOME_TO_SWITCH;
    if (gve_guards_switch(&queue->guards, inputs, home->order.axis) != wanted ||
        !group_stop_isr(&gve_queue_chain(queue)->group, AXIS_CAUSE_LIMIT)) {
        return false;
    }
    home->place_steps = step_channel_position(&queue->channel[home->order.axis]);
    atomic_store_explicit(&home->reached, true, memory_order_release);
    return true;
}

bool gve_home_end_isr(struct gve_queue *queue)
{
    const struct group *group = gve_queue_group(queue);
    return group_is_stopping(group) && group_cause(group) == AXIS_CAUSE_LIMIT &&
           !atomic_exchange_explicit(&queue->home.ended, true, memory_order_relaxed);
}

uint16_t gve_home_mask(const struct gve_queue *queue, uint16_t active)
{
    unsigned own = gve_home_phase(queue) == GVE_HOME_NONE ? 0U : 1U << queue->home.order.axis;
    return (uint16_t)(active & ~own);
}
