#include "step_channel_private.h"

#include <stddef.h>

#include "hal_step.h"

/* Keeps the position of the pulse. */
static void channel_turn(struct step_channel *channel, uint64_t pulse)
{
    channel->origin += INT64_C(2) * channel->direction * (int64_t)pulse;
    channel->direction = (int8_t)-channel->direction;
}

void step_channel_turn_over(struct step_channel *channel)
{
    channel->turned = step_cursor_pulse(&channel->cursor);
    channel_turn(channel, channel->turned);
}

/* After the cursor has gone back: a turn that it has gone back over is yet to come. */
static void channel_turn_back(struct step_channel *channel)
{
    if (step_cursor_pulse(&channel->cursor) <= channel->turned && channel->turned != 0) {
        channel_turn(channel, channel->turned);
        channel->turned = 0;
    }
}

/* A cursor on the segment that another stands on; it ends with `pulse`. */
static void cursor_end_with(struct step_cursor *cursor, uint32_t tail, uint64_t pulse)
{
    if (cursor->tail == tail && pulse < cursor->end) {
        cursor->left -= (uint32_t)(cursor->end - pulse);
        cursor->end = pulse;
    }
}

/* Drops what is queued after pulse `pulse`, which is the one laid last or a later one. A way back that leads over the
 * present segment from the one before finds its end in the queue. */
static void channel_truncate(struct step_channel *channel, uint64_t pulse)
{
    struct step_cursor *cursor = &channel->cursor;
    uint32_t head = cursor->tail;
    if (pulse < cursor->end && head != atomic_load_explicit(&channel->taken, memory_order_relaxed)) {
        channel->queue[(head - 1U) % STEP_QUEUE_SEGMENTS].steps -= (uint32_t)(cursor->end - pulse);
    }
    cursor_end_with(&channel->kept[0], head, pulse);
    cursor_end_with(&channel->kept[1], head, pulse);
    cursor_end_with(cursor, head, pulse);
    for (uint64_t keep = pulse - cursor->end; keep > 0; head++) {
        struct step_segment *segment = &channel->queue[head % STEP_QUEUE_SEGMENTS];
        segment->steps = keep < segment->steps ? (uint32_t)keep : segment->steps;
        keep -= segment->steps;
    }
    channel->pushed = pulse;
    atomic_store_explicit(&channel->head, head, memory_order_relaxed);
}

/* Takes back what is laid after `at`, or what of it can still be taken back: the cursor then stands on the last pulse
 * that stays. True if there was any. */
static bool channel_take_back(struct step_channel *channel, const struct step_cursor *at)
{
    uint64_t laid = step_cursor_pulse(&channel->cursor);
    uint64_t pulse = step_cursor_pulse(at);
    unsigned back = pulse < laid ? hal_step_take_back(channel->motor, (unsigned)(laid - pulse)) : 0;
    if (back != 0) {
        channel->cursor = *at;
        step_channel_follow(&channel->cursor, channel, laid - back);
        if (step_cursor_pulse(&channel->kept[channel->young]) > laid - back) {
            channel->kept[channel->young] = channel->cursor;
        }
        channel_turn_back(channel);
    }
    return back != 0;
}

bool step_channel_replace(struct step_channel *channel, const struct step_cursor *at,
                          const struct step_segment *segments, unsigned count)
{
    hal_step_hold();
    uint32_t taken = atomic_load_explicit(&channel->taken, memory_order_relaxed);
    bool in_time =
        step_channel_is_running(channel) && !channel->closed && at->tail - taken + count <= STEP_QUEUE_SEGMENTS;
    in_time = in_time && step_channel_count(channel) < step_cursor_pulse(at);
    bool back = in_time && channel_take_back(channel, at);
    in_time = in_time && step_cursor_pulse(&channel->cursor) <= step_cursor_pulse(at);
    if (in_time) {
        channel_truncate(channel, step_cursor_pulse(at));
        for (unsigned i = 0; i < count; i++) {
            step_channel_append(channel, &segments[i]);
        }
    }
    if (back || in_time) {
        hal_step_run(channel->motor);
    }
    hal_step_release();
    return in_time;
}

/* From the pulse that the cursor stands on. */
static void channel_slow_down(struct step_channel *channel, int32_t accel, uint64_t until)
{
    struct step_cursor *cursor = &channel->cursor;
    uint64_t pulse = step_cursor_pulse(cursor);
    cursor->generator.accel = -accel;
    cursor->end = until > pulse ? until : pulse;
    cursor->left = (uint32_t)(cursor->end - pulse);
    channel->pushed = cursor->end;
    atomic_store_explicit(&channel->head, cursor->tail, memory_order_relaxed);
    channel->closed = true;
    step_channel_keep_nothing(channel);
}

bool step_channel_brake(struct step_channel *channel, int32_t accel, uint64_t until, struct step_cursor *at)
{
    hal_step_hold();
    bool running = step_channel_is_running(channel);
    if (running) {
        (void)channel_take_back(channel, at);
        *at = channel->cursor;
        channel_slow_down(channel, accel, until);
        hal_step_run(channel->motor);
    }
    hal_step_release();
    return running;
}

/* The generator goes on along the segment, `laid` of whose pulses have been laid. */
static void channel_join(struct step_channel *channel, const struct step_segment *segment, uint32_t laid)
{
    struct step_cursor *cursor = &channel->cursor;
    step_generator_join(&cursor->generator, segment, laid);
    cursor->end = step_cursor_pulse(cursor) - laid + segment->steps;
    cursor->left = segment->steps - laid;
    channel->pushed = cursor->end;
    step_channel_keep_nothing(channel);
    if (segment->marked) {
        atomic_store_explicit(&channel->marked, true, memory_order_relaxed);
    }
}

void step_channel_replace_brake(struct step_channel *channel, const struct step_cursor *at,
                                const struct step_segment *segment)
{
    hal_step_hold();
    channel->closed = false;
    uint32_t laid = (uint32_t)(step_cursor_pulse(&channel->cursor) - step_cursor_pulse(at));
    if (laid > 0U || !step_channel_is_running(channel)) {
        channel_join(channel, segment, laid);
    } else {
        channel_truncate(channel, step_cursor_pulse(&channel->cursor));
        step_channel_append(channel, segment);
    }
    atomic_store_explicit(&channel->running, true, memory_order_relaxed);
    hal_step_run(channel->motor);
    hal_step_release();
}

/* The tick of a pulse that has been made, and that none follows; `way` leads to it, or else it is the one before. */
static uint32_t channel_tick_of(const struct step_channel *channel, uint64_t pulse, struct step_cursor *way)
{
    if (pulse < step_cursor_pulse(way)) {
        return way->generator.tick - way->generator.interval;
    }
    step_channel_follow(way, channel, pulse);
    return way->generator.tick;
}

/* No pulse follows, and nothing is queued. */
static void channel_end_at(struct step_channel *channel, uint64_t pulse)
{
    struct step_cursor *cursor = &channel->cursor;
    cursor->end = pulse;
    cursor->left = 0;
    channel->pushed = pulse;
    atomic_store_explicit(&channel->head, cursor->tail, memory_order_relaxed);
    step_channel_keep_nothing(channel);
    channel_turn_back(channel);
}

void step_channel_halt(struct step_channel *channel)
{
    hal_step_hold();
    struct step_cursor *cursor = &channel->cursor;
    unsigned waiting = step_channel_is_running(channel) ? hal_step_waiting(channel->motor) : 0;
    unsigned back = waiting != 0 ? hal_step_take_back(channel->motor, waiting) : 0;
    uint64_t pulse = step_cursor_pulse(cursor) - back;
    struct step_cursor way = *step_channel_base(channel, pulse);
    channel_end_at(channel, pulse);
    channel->closed = true;
    if (waiting != 0) {
        hal_step_run(channel->motor);
    }
    hal_step_release();
    if (back != 0) {
        cursor->generator.tick = channel_tick_of(channel, pulse, &way);
    }
}

/* The cursor goes back to the last pulse that is laid. */
static void channel_go_back(struct step_channel *channel)
{
    uint64_t laid = step_cursor_pulse(&channel->cursor) - channel->recalled;
    if (channel->recalled != 0) {
        channel->cursor = *step_channel_base(channel, laid);
        step_channel_follow(&channel->cursor, channel, laid);
        channel->kept[channel->young] = channel->cursor;
        channel_turn_back(channel);
    }
    channel->recalled = 0;
}

void step_channel_thaw_held(struct step_channel *channel)
{
    channel_go_back(channel);
    channel->frozen = false;
    if (step_channel_is_running(channel)) {
        hal_step_run(channel->motor);
    }
}

/* Whether the queue has a place for what comes after a pulse instead of what has been pushed. */
static bool channel_has_room_after(const struct step_channel *channel, uint64_t pulse)
{
    uint32_t count = channel->cursor.tail - atomic_load_explicit(&channel->taken, memory_order_relaxed);
    uint32_t tail = channel->cursor.tail;
    for (uint64_t end = channel->cursor.end; end < pulse; tail++) {
        end += channel->queue[tail % STEP_QUEUE_SEGMENTS].steps;
        count++;
    }
    return count < (uint32_t)STEP_QUEUE_SEGMENTS;
}

bool step_channel_freeze(struct step_channel *channel, uint64_t back)
{
    hal_step_hold();
    uint64_t pulse = channel->pushed - back;
    uint64_t laid = step_cursor_pulse(&channel->cursor);
    uint32_t much = pulse < laid ? (uint32_t)(laid - pulse) : 0;
    bool room = channel_has_room_after(channel, pulse);
    channel->recalled = much != 0 ? hal_step_take_back(channel->motor, much) : 0;
    channel->until = pulse;
    channel->frozen = true;
    bool in_time = room && channel->recalled == much;
    if (!in_time) {
        step_channel_thaw_held(channel);
    }
    hal_step_release();
    return in_time;
}

void step_channel_recall(struct step_channel *channel, uint64_t back, const struct step_segment *segment, bool backward)
{
    hal_step_hold();
    channel_go_back(channel);
    channel_truncate(channel, channel->pushed - back);
    if (segment != NULL) {
        channel->turn = backward;
        step_channel_append(channel, segment);
        atomic_store_explicit(&channel->running, true, memory_order_relaxed);
    }
    hal_step_release();
}
