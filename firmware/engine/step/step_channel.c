#include "step_channel.h"

#include <assert.h>

#include "base_hint.h"
#include "base_tick.h"
#include "hal_step.h"
#include "step_lay.h"

static_assert((STEP_QUEUE_SEGMENTS & (STEP_QUEUE_SEGMENTS - 1)) == 0, "the ring's counters wrap with its size");

/* Where pulses come faster, a stop is not looked for at one that has been made: half of that goes by until the last of
 * four motors has its turn. */
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
    step_generator_load(&cursor->generator, segment);
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

static void cursor_advance_to(struct step_cursor *cursor, const struct step_channel *channel, uint64_t pulse)
{
    uint32_t head = atomic_load_explicit(&channel->head, memory_order_relaxed);
    while (step_cursor_pulse(cursor) < pulse && cursor_advance(cursor, channel, head)) {
    }
}

void step_channel_init(struct step_channel *channel, unsigned motor)
{
    *channel = (struct step_channel){.direction = 1, .motor = (uint8_t)motor};
}

/* No way leads back from where the cursor is. */
static void channel_keep_nothing(struct step_channel *channel)
{
    channel->kept[0] = channel->cursor;
    channel->kept[1] = channel->cursor;
    atomic_store_explicit(&channel->taken, channel->cursor.tail, memory_order_release);
}

void step_channel_begin(struct step_channel *channel, uint32_t tick, bool backward)
{
    channel->origin = step_channel_position(channel);
    step_generator_start(&channel->cursor.generator, tick);
    channel->cursor.end = 0;
    channel->cursor.left = 0;
    channel_keep_nothing(channel);
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
    hal_step_run(channel->motor);
    hal_step_release();
}

bool step_channel_is_running(const struct step_channel *channel)
{
    return atomic_load_explicit(&channel->running, memory_order_acquire);
}

static uint64_t channel_pulses(const struct step_channel *channel)
{
    uint64_t laid = step_cursor_pulse(&channel->cursor);
    return step_channel_is_running(channel) ? laid - hal_step_waiting(channel->motor) : laid;
}

/* The last of the places that are kept from which a way leads on to a pulse. */
static const struct step_cursor *channel_base(const struct step_channel *channel, uint64_t pulse)
{
    const struct step_cursor *young = &channel->kept[channel->young];
    return step_cursor_pulse(young) <= pulse ? young : &channel->kept[channel->young ^ 1U];
}

bool step_channel_find_pulse(const struct step_channel *channel, uint32_t since, struct step_cursor *cursor)
{
    hal_step_hold();
    bool running = step_channel_is_running(channel);
    uint64_t made = channel_pulses(channel);
    *cursor = running ? *channel_base(channel, made) : channel->cursor;
    hal_step_release();
    cursor_advance_to(cursor, channel, made);
    struct step_cursor next = *cursor;
    bool came_after = made == step_cursor_pulse(cursor) && made > 0 && tick_is_before(since, cursor->generator.tick);
    if (running && made == step_cursor_pulse(cursor)) {
        cursor_advance_to(&next, channel, made + 1U);
        if (!came_after || next.generator.interval < (uint32_t)BACK_INTERVAL_TICKS) {
            *cursor = next;
        }
    }
    return running;
}

/* No pulse that has been made came after a tick to come, so the pulse found first is the next one. */
bool step_channel_look_ahead(const struct step_channel *channel, uint32_t tick, struct step_cursor *cursor)
{
    bool running = step_channel_find_pulse(channel, tick, cursor);
    uint32_t head = atomic_load_explicit(&channel->head, memory_order_relaxed);
    while (running && tick_is_before(cursor->generator.tick, tick)) {
        running = cursor_advance(cursor, channel, head);
    }
    return running;
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
        cursor_advance_to(&channel->cursor, channel, laid - back);
        if (step_cursor_pulse(&channel->kept[channel->young]) > laid - back) {
            channel->kept[channel->young] = channel->cursor;
        }
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
    in_time = in_time && channel_pulses(channel) < step_cursor_pulse(at);
    bool back = in_time && channel_take_back(channel, at);
    in_time = in_time && step_cursor_pulse(&channel->cursor) <= step_cursor_pulse(at);
    if (in_time) {
        channel_truncate(channel, step_cursor_pulse(at));
        for (unsigned i = 0; i < count; i++) {
            channel_push(channel, &segments[i]);
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
    atomic_store_explicit(&channel->head, cursor->tail, memory_order_relaxed);
    channel->closed = true;
    channel_keep_nothing(channel);
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
    channel_keep_nothing(channel);
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
        channel_push(channel, segment);
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
    cursor_advance_to(way, channel, pulse);
    return way->generator.tick;
}

void step_channel_halt(struct step_channel *channel)
{
    hal_step_hold();
    struct step_cursor *cursor = &channel->cursor;
    unsigned waiting = step_channel_is_running(channel) ? hal_step_waiting(channel->motor) : 0;
    unsigned back = waiting != 0 ? hal_step_take_back(channel->motor, waiting) : 0;
    uint64_t pulse = step_cursor_pulse(cursor) - back;
    struct step_cursor way = *channel_base(channel, pulse);
    cursor->end = pulse;
    cursor->left = 0;
    atomic_store_explicit(&channel->head, cursor->tail, memory_order_relaxed);
    channel_keep_nothing(channel);
    channel->closed = true;
    if (waiting != 0) {
        hal_step_run(channel->motor);
    }
    hal_step_release();
    if (back != 0) {
        cursor->generator.tick = channel_tick_of(channel, pulse, &way);
    }
}

uint64_t step_channel_pulses(const struct step_channel *channel)
{
    hal_step_hold();
    uint64_t pulses = channel_pulses(channel);
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

/* Keeps where the cursor is, once the younger of the two places can take the part of the older one. */
static inline void channel_keep(struct step_channel *channel, struct hal_step_room *room)
{
    const struct step_cursor *young = &channel->kept[channel->young];
    if (step_cursor_pulse(young) > step_cursor_pulse(&channel->cursor) - room->waiting) {
        return;
    }
    if (young->tail != atomic_load_explicit(&channel->taken, memory_order_relaxed)) {
        atomic_store_explicit(&channel->taken, young->tail, memory_order_release);
        room->main_has_work = true;
    }
    channel->young ^= 1U;
    channel->kept[channel->young] = channel->cursor;
}

/* False at the end of what is queued, and before a marked segment until all pulses before it have been made: main is to
 * be told of it then, and not before. */
static bool channel_lay_first(struct step_channel *channel, struct hal_step_room *room, unsigned place)
{
    uint32_t head = atomic_load_explicit(&channel->head, memory_order_acquire);
    uint32_t tail = channel->cursor.tail;
    bool marked = tail != head && queue_slot(channel, tail)->marked;
    if ((marked && place + room->waiting > 0) || !cursor_begin_segment(&channel->cursor, channel, head)) {
        return false;
    }
    if (marked) {
        atomic_store_explicit(&channel->marked, true, memory_order_relaxed);
        room->main_has_work = true;
    }
    step_lay_pulse(&channel->cursor.generator, room, place);
    return true;
}

static void channel_rest(struct step_channel *channel, struct hal_step_room *room)
{
    channel_keep_nothing(channel);
    atomic_store_explicit(&channel->running, false, memory_order_release);
    room->main_has_work = true;
}

static unsigned channel_lay(struct step_channel *channel, struct hal_step_room *room)
{
    struct step_cursor *cursor = &channel->cursor;
    unsigned laid = 0;
    do {
        unsigned count = room->count - laid;
        if (BASE_SELDOM(cursor->left == 0)) {
            if (!channel_lay_first(channel, room, laid)) {
                break;
            }
            count = 1;
        } else {
            count = step_lay(&cursor->generator, room, laid, count < cursor->left ? count : cursor->left);
            cursor->left -= count;
        }
        laid += count;
    } while (laid < room->count && step_lay_goes_on(cursor->generator.tick, room));
    return laid;
}

unsigned step_channel_lay_isr(struct step_channel *channel, struct hal_step_room *room)
{
    channel_keep(channel, room);
    unsigned laid = channel_lay(channel, room);
    if (BASE_SELDOM(laid == 0) && room->waiting == 0) {
        channel_rest(channel, room);
    }
    return laid;
}
