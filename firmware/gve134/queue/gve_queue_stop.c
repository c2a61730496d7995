#include "gve_queue_private.h"

#include "hal_time.h"
#include "hal_trace.h"

bool gve_queue_brake(struct gve_queue *queue, enum axis_cause cause)
{
    bool stops = group_stop(&gve_queue_chain(queue)->group, cause);
    if (stops) {
        hal_trace(hal_time_now(), 0, HAL_TRACE_STOP, cause);
    }
    return stops;
}

bool gve_queue_halt(struct gve_queue *queue)
{
    if (gve_queue_moves(queue)) {
        queue->halting = true;
        (void)gve_queue_brake(queue, AXIS_CAUSE_COMMAND);
        return false;
    }
    queue->inta = true;
    queue->intcom = true;
    return true;
}

void gve_queue_stop(struct gve_queue *queue)
{
    if (gve_queue_moves(queue)) {
        queue->stopping = true;
        (void)gve_queue_brake(queue, AXIS_CAUSE_COMMAND);
    }
}

void gve_queue_write_flags(struct gve_queue *queue, bool inta, bool intcom, uint8_t inputs)
{
    queue->inta = inta;
    queue->intcom = intcom;
    gve_queue_begin(queue, inputs);
}

static void clear(struct gve_queue *queue)
{
    queue->inta = false;
    queue->intcom = false;
    gve_guards_clear_causes(&queue->guards);
}

void gve_queue_go(struct gve_queue *queue, uint8_t inputs)
{
    clear(queue);
    gve_queue_begin(queue, inputs);
}

void gve_queue_delete(struct gve_queue *queue)
{
    clear(queue);
    queue->pause_ticks = 0;
    group_forget(&gve_queue_chain(queue)->group);
}

static void use(struct gve_queue *queue, unsigned chain)
{
    atomic_store_explicit(&queue->used, (uint8_t)chain, memory_order_relaxed);
}

bool gve_queue_keep(struct gve_queue *queue)
{
    if (queue->kept.valid) {
        return false;
    }
    queue->kept = (struct gve_kept){
        .valid = true,
        .inta = queue->inta,
        .intcom = queue->intcom,
        .cause = {gve_guards_read(&queue->guards, GVE_STATUS_CAUSE_1),
                  gve_guards_read(&queue->guards, GVE_STATUS_CAUSE_2)},
        .pause_ticks = queue->pause_ticks,
    };
    clear(queue);
    queue->pause_ticks = 0;
    use(queue, 1);
    return true;
}

bool gve_queue_restore(struct gve_queue *queue)
{
    if (!queue->kept.valid) {
        return false;
    }
    group_forget(&gve_queue_chain(queue)->group);
    use(queue, 0);
    queue->inta = queue->kept.inta;
    queue->intcom = queue->kept.intcom;
    queue->pause_ticks = queue->kept.pause_ticks;
    gve_guards_write(&queue->guards, GVE_STATUS_CAUSE_1, queue->kept.cause[0]);
    gve_guards_write(&queue->guards, GVE_STATUS_CAUSE_2, queue->kept.cause[1]);
    queue->kept.valid = false;
    return true;
}

/* No interrupt may plan a way down for channels that have been halted. */
void gve_queue_abort(struct gve_queue *queue)
{
    clear(queue);
    gve_guards_init(&queue->guards);
    atomic_store_explicit(&queue->home.phase, (uint8_t)GVE_HOME_NONE, memory_order_relaxed);
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        step_channel_halt(&queue->channel[motor]);
    }
    if (group_is_busy(gve_queue_group(queue))) {
        hal_trace(hal_time_now(), 0, HAL_TRACE_STOP, AXIS_CAUSE_ABORT);
        gve_queue_tell_end(queue, hal_time_now());
    }
}

bool gve_queue_is_quiet(const struct gve_queue *queue)
{
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        if (step_channel_is_running(&queue->channel[motor])) {
            return false;
        }
    }
    return true;
}
