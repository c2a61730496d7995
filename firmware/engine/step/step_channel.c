#include "step_channel.h"

#include <assert.h>

#include "base_tick.h"
#include "hal_step.h"

static_assert((STEP_QUEUE_SEGMENTS & (STEP_QUEUE_SEGMENTS - 1)) == 0, "the ring's counters wrap with its size");

/* No pulse is taken back where they come faster: half of that goes by until the last of four motors
 * has its turn. */
enum {
    BACK_INTERVAL_TICKS = 40 * TICKS_PER_US
};

static const struct step_segment *queue_slot(const struct step_channel *channel, uint32_t count)
{
    return &channel->queue[count % STEP_QUEUE_SEGMENTS];
}

/* Moves a cursor to the first pulse of the next segment in the queue. False if there is none. */
static inline bool cursor_begin_segment(struct step_cursor *cursor, const struct step_channel *channel, uint32_t head)
{
    if (cursor->tail == head) {
        return false;
    }
    const struct step_segment *segment = queue_slot(channel, cursor->tail);
    cursor->before_residual = cursor->generator.residual;
    cursor->before_slope = cursor->generator.slope;
    cursor->before_accel = cursor->generator.accel;
    step_generator_load(&cursor->generator, segment);
    cursor->first = (uint32_t)cursor->end + 1U;
    cursor->end += segment->steps;
    cursor->left = segment->steps - 1U;
    cursor->tail++;
    return true;
}

static bool cursor_advance(struct step_cursor *cursor, const struct step_channel *channel, uint32_t head)
{
    if (cursor->left == 0) {
        return cursor_begin_segment(cursor, channel, head);
    }
    cursor->left--;
    (void)step_generator_next(&cursor->generator);
    return true;
}

void step_channel_init(struct step_channel *channel, unsigned motor)
{
    *channel = (struct step_channel){.direction = 1, .motor = (uint8_t)motor};
}

void step_channel_begin(struct step_channel *channel, uint32_t tick, bool backward)
{
    channel->origin = step_channel_position(channel);
    step_generator_start(&channel->cursor.generator, tick);
    channel->cursor.end = 0;
    channel->cursor.left = 0;
    channel->closed = false;
    channel->direction = backward ? -1 : 1;
    atomic_store_explicit(&channel->marked, false, memory_order_relaxed);
    hal_step_set_direction(channel->motor, backward);
}

uint32_t step_channel_room(const struct step_channel *channel)
{
    uint32_t head = atomic_load_explicit(&channel->head, memory_order_relaxed);
    uint32_t taken = atomic_load_explicit(&channel->taken, memory_order_acquire);
    return STEP_QUEUE_SEGMENTS - (head - taken);
}

static void channel_push(struct step_channel *channel, const struct step_segment *segment)
{
    uint32_t head = atomic_load_explicit(&channel->head, memory_order_relaxed);
    channel->queue[head % STEP_QUEUE_SEGMENTS] = *segment;
    atomic_store_explicit(&channel->head, head + 1U, memory_order_release);
}

bool step_channel_push(struct step_channel *channel, const struct step_segment *segment)
{
    hal_step_hold();
    bool open = !channel->closed;
    if (open) {
        channel_push(channel, segment);
    }
    hal_step_release();
    return open;
}

void step_channel_run(struct step_channel *channel)
{
    hal_step_hold();
    atomic_store_explicit(&channel->running, true, memory_order_relaxed);
    if ((step_channel_next(channel) & STEP_CHANNEL_ARM) != 0) {
        hal_step_arm(channel->motor, channel->cursor.generator.tick);
    }
    hal_step_release();
}

bool step_channel_is_running(const struct step_channel *channel)
{
    return atomic_load_explicit(&channel->running, memory_order_acquire);
}

/* Whether there is a pulse in the move before the one that a cursor stands on, and a change there
 * leaves time. */
static bool cursor_can_go_back(const struct step_cursor *cursor)
{
    return step_cursor_pulse(cursor) > 1U && cursor->generator.interval >= (uint32_t)BACK_INTERVAL_TICKS;
}

static void cursor_go_back(struct step_cursor *cursor)
{
    bool first = (uint32_t)step_cursor_pulse(cursor) == cursor->first;
    step_generator_back(&cursor->generator);
    if (first) {
        cursor->generator.residual = cursor->before_residual;
        cursor->generator.slope = cursor->before_slope;
        cursor->generator.accel = cursor->before_accel;
    }
    cursor->left++;
}

bool step_channel_find_pulse(const struct step_channel *channel, uint32_t since, struct step_cursor *cursor)
{
    hal_step_hold();
    bool running = step_channel_is_running(channel);
    *cursor = channel->cursor;
    hal_step_release();
    uint32_t before = cursor->generator.tick - cursor->generator.interval;
    if (running && cursor_can_go_back(cursor) && tick_is_before(since, before)) {
        cursor_go_back(cursor);
    }
    return running;
}

/* No pulse that has been made came after a tick to come, so the pulse found first is the armed
 * one. */
bool step_channel_look_ahead(const struct step_channel *channel, uint32_t tick, struct step_cursor *cursor)
{
    bool running = step_channel_find_pulse(channel, tick, cursor);
    uint32_t head = atomic_load_explicit(&channel->head, memory_order_relaxed);
    while (running && tick_is_before(cursor->generator.tick, tick)) {
        running = cursor_advance(cursor, channel, head);
    }
    return running;
}

/* Drops what is queued after pulse `pulse`, which is the armed one or a later one. */
static void channel_truncate(struct step_channel *channel, uint64_t pulse)
{
    struct step_cursor *cursor = &channel->cursor;
    uint32_t head = cursor->tail;
    if (pulse <= cursor->end) {
        cursor->left -= (uint32_t)(cursor->end - pulse);
        cursor->end = pulse;
    }
    for (uint64_t keep = pulse - cursor->end; keep > 0; head++) {
        struct step_segment *segment = &channel->queue[head % STEP_QUEUE_SEGMENTS];
        segment->steps = keep < segment->steps ? (uint32_t)keep : segment->steps;
        keep -= segment->steps;
    }
    atomic_store_explicit(&channel->head, head, memory_order_relaxed);
}

bool step_channel_replace(struct step_channel *channel, const struct step_cursor *at,
                          const struct step_segment *segments, unsigned count)
{
    hal_step_hold();
    bool in_time = step_channel_is_running(channel) && !channel->closed &&
                   step_cursor_pulse(&channel->cursor) <= step_cursor_pulse(at) &&
                   at->tail - channel->cursor.tail + count <= STEP_QUEUE_SEGMENTS;
    if (in_time) {
        channel_truncate(channel, step_cursor_pulse(at));
        for (unsigned i = 0; i < count; i++) {
            channel_push(channel, &segments[i]);
        }
    }
    hal_step_release();
    return in_time;
}

/* Takes the armed pulse back if it is the one after `pulse`. */
static bool channel_go_back(struct step_channel *channel, uint64_t pulse)
{
    bool back = step_cursor_pulse(&channel->cursor) == pulse + 1U && cursor_can_go_back(&channel->cursor) &&
                hal_step_disarm(channel->motor);
    if (back) {
        cursor_go_back(&channel->cursor);
    }
    return back;
}

bool step_channel_brake(struct step_channel *channel, int32_t accel, uint64_t until, struct step_cursor *at)
{
    bool back = false;
    hal_step_hold();
    bool running = step_channel_is_running(channel);
    if (running) {
        back = channel_go_back(channel, step_cursor_pulse(at));
        *at = channel->cursor;
        uint64_t pulse = step_cursor_pulse(at);
        channel->cursor.generator.accel = -accel;
        channel->cursor.end = until > pulse ? until : pulse;
        channel->cursor.left = (uint32_t)(channel->cursor.end - pulse);
        atomic_store_explicit(&channel->head, channel->cursor.tail, memory_order_relaxed);
        channel->closed = true;
    }
    hal_step_release();
    if (back) {
        step_channel_run(channel);
    }
    return running;
}

/* The generator goes on along the segment, `made` of whose pulses have been made or armed. */
static void channel_join(struct step_channel *channel, const struct step_segment *segment, uint32_t made)
{
    struct step_cursor *cursor = &channel->cursor;
    step_generator_join(&cursor->generator, segment, made);
    cursor->end = step_cursor_pulse(cursor) - made + segment->steps;
    cursor->left = segment->steps - made;
    if (segment->marked) {
        atomic_store_explicit(&channel->marked, true, memory_order_relaxed);
    }
}

void step_channel_replace_brake(struct step_channel *channel, const struct step_cursor *at,
                                const struct step_segment *segment)
{
    hal_step_hold();
    channel->closed = false;
    uint32_t made = (uint32_t)(step_cursor_pulse(&channel->cursor) - step_cursor_pulse(at));
    bool begun = made > 0U;
    bool rests = !step_channel_is_running(channel);
    if (begun || rests) {
        channel_join(channel, segment, made);
    } else {
        channel_truncate(channel, step_cursor_pulse(&channel->cursor));
        channel_push(channel, segment);
    }
    hal_step_release();
    if (rests) {
        step_channel_run(channel);
    }
}

void step_channel_halt(struct step_channel *channel)
{
    hal_step_hold();
    if (step_channel_is_running(channel)) {
        channel_truncate(channel, step_cursor_pulse(&channel->cursor));
        if (hal_step_disarm(channel->motor)) {
            channel->cursor.end--;
            channel->cursor.generator.tick -= channel->cursor.generator.interval;
            atomic_store_explicit(&channel->running, false, memory_order_relaxed);
        }
    } else {
        atomic_store_explicit(&channel->head, channel->cursor.tail, memory_order_relaxed);
    }
    channel->closed = true;
    hal_step_release();
}

uint64_t step_channel_pulses(const struct step_channel *channel)
{
    hal_step_hold();
    uint64_t pulses = step_cursor_pulse(&channel->cursor) - (step_channel_is_running(channel) ? 1U : 0U);
    hal_step_release();
    return pulses;
}

int64_t step_channel_position(const struct step_channel *channel)
{
    return channel->origin + channel->direction * (int64_t)step_channel_pulses(channel);
}

void step_channel_set_position(struct step_channel *channel, int64_t position_steps)
{
    channel->origin += position_steps - step_channel_position(channel);
}

uint32_t step_channel_end_tick(const struct step_channel *channel)
{
    return channel->cursor.generator.tick;
}

bool step_channel_take_mark(struct step_channel *channel)
{
    return atomic_exchange_explicit(&channel->marked, false, memory_order_relaxed);
}

unsigned step_channel_next_segment(struct step_channel *channel)
{
    uint32_t head = atomic_load_explicit(&channel->head, memory_order_acquire);
    uint32_t tail = channel->cursor.tail;
    if (!cursor_begin_segment(&channel->cursor, channel, head)) {
        atomic_store_explicit(&channel->running, false, memory_order_release);
        return STEP_CHANNEL_WAKE;
    }
    if (queue_slot(channel, tail)->marked) {
        atomic_store_explicit(&channel->marked, true, memory_order_relaxed);
    }
    atomic_store_explicit(&channel->taken, tail + 1U, memory_order_release);
    return STEP_CHANNEL_ARM | STEP_CHANNEL_WAKE;
}

bool step_channel_pulse_isr(struct step_channel *channel)
{
    unsigned next = step_channel_next(channel);
    if ((next & STEP_CHANNEL_ARM) != 0) {
        hal_step_arm(channel->motor, channel->cursor.generator.tick);
    }
    return (next & STEP_CHANNEL_WAKE) != 0;
}
