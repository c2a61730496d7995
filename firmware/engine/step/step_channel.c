#include "step_channel_private.h"

#include <assert.h>

#include "base_hint.h"
#include "base_tick.h"
#include "hal_step.h"
#include "step_lay.h"
#include "step_skip.h"

static_assert((STEP_QUEUE_SEGMENTS & (STEP_QUEUE_SEGMENTS - 1)) == 0, "the ring's counters wrap with its size");
static_assert(STEP_QUEUE_SEGMENTS <= 32, "each place has a bit that says its way");

/* Where pulses come faster, a stop is not looked for at one that has been made: half of that goes by until the last of
 * four motors has its turn. */
enum {
    BACK_INTERVAL_TICKS = 40 * TICKS_PER_US
};

static const struct step_segment *queue_slot(const struct step_channel *channel, uint32_t count)
{
    return &channel->queue[count % STEP_QUEUE_SEGMENTS];
}

/* Moves a cursor to the first pulse of the next segment in the queue: there is one. */
static inline void cursor_begin_segment(struct step_cursor *cursor, const struct step_segment *segment)
{
    step_generator_load(&cursor->generator, segment);
    cursor->end += segment->steps;
    cursor->left = segment->steps - 1U;
    cursor->tail++;
}

static bool cursor_advance(struct step_cursor *cursor, const struct step_channel *channel, uint32_t head)
{
    if (cursor->left != 0) {
        cursor->left--;
        (void)step_generator_next(&cursor->generator);
        return true;
    }
    bool more = cursor->tail != head;
    if (more) {
        cursor_begin_segment(cursor, queue_slot(channel, cursor->tail));
    }
    return more;
}

/* Skips what it can on the way to a pulse that comes later, but for that one and the last one of the segment, whose
 * intervals must be known. */
static bool cursor_skip(struct step_cursor *cursor, uint64_t pulse)
{
    uint64_t way = pulse - step_cursor_pulse(cursor);
    uint64_t least = way < cursor->left ? way : cursor->left;
    uint32_t count = least <= STEP_SKIP_MAX ? (uint32_t)least - 1U : STEP_SKIP_MAX;
    bool skipped = least != 0U && count > 1U && step_skip(&cursor->generator, count);
    cursor->left -= skipped ? count : 0U;
    return skipped;
}

void step_channel_follow(struct step_cursor *cursor, const struct step_channel *channel, uint64_t pulse)
{
    uint32_t head = atomic_load_explicit(&channel->head, memory_order_relaxed);
    while (step_cursor_pulse(cursor) < pulse && (cursor_skip(cursor, pulse) || cursor_advance(cursor, channel, head))) {
    }
}

void step_channel_init(struct step_channel *channel, unsigned motor)
{
    *channel = (struct step_channel){.direction = 1, .motor = (uint8_t)motor};
}

/* No way leads back from where the cursor is. */
void step_channel_keep_nothing(struct step_channel *channel)
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
    channel->pushed = 0;
    step_channel_keep_nothing(channel);
    channel->closed = false;
    channel->turn = backward;
    channel->turned = 0;
    channel->direction = backward ? -1 : 1;
    atomic_store_explicit(&channel->marked, false, memory_order_relaxed);
    hal_step_set_direction(channel->motor, backward);
}

void step_channel_turn(struct step_channel *channel, bool backward)
{
    channel->turn = backward;
}

uint32_t step_channel_room(const struct step_channel *channel)
{
    uint32_t head = atomic_load_explicit(&channel->head, memory_order_relaxed);
    uint32_t taken = atomic_load_explicit(&channel->taken, memory_order_acquire);
    return STEP_QUEUE_SEGMENTS - (head - taken);
}

void step_channel_append(struct step_channel *channel, const struct step_segment *segment)
{
    uint32_t head = atomic_load_explicit(&channel->head, memory_order_relaxed);
    uint32_t place = head % STEP_QUEUE_SEGMENTS;
    uint32_t bit = UINT32_C(1) << place;
    channel->queue[place] = *segment;
    channel->pushed += segment->steps;
    channel->backward = channel->turn ? channel->backward | bit : channel->backward & ~bit;
    atomic_store_explicit(&channel->head, head + 1U, memory_order_release);
}

/* Whether a motor that runs has laid all that was pushed: the backend may have heard that there is no more. */
static bool channel_is_dry(const struct step_channel *channel)
{
    bool all =
        channel->cursor.left == 0 && channel->cursor.tail == atomic_load_explicit(&channel->head, memory_order_relaxed);
    return all && atomic_load_explicit(&channel->running, memory_order_relaxed);
}

bool step_channel_push(struct step_channel *channel, const struct step_segment *segment)
{
    hal_step_hold();
    bool open = !channel->closed;
    if (open) {
        bool dry = channel_is_dry(channel);
        step_channel_append(channel, segment);
        if (dry) {
            hal_step_run(channel->motor);
        }
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

uint64_t step_channel_count(const struct step_channel *channel)
{
    uint64_t laid = step_cursor_pulse(&channel->cursor);
    return step_channel_is_running(channel) ? laid - channel->recalled - hal_step_waiting(channel->motor) : laid;
}

/* The last of the places that are kept from which a way leads on to a pulse. */
const struct step_cursor *step_channel_base(const struct step_channel *channel, uint64_t pulse)
{
    const struct step_cursor *young = &channel->kept[channel->young];
    return step_cursor_pulse(young) <= pulse ? young : &channel->kept[channel->young ^ 1U];
}

bool step_channel_find_pulse(const struct step_channel *channel, uint32_t since, struct step_cursor *cursor)
{
    hal_step_hold();
    bool running = step_channel_is_running(channel);
    uint64_t made = step_channel_count(channel);
    *cursor = running ? *step_channel_base(channel, made) : channel->cursor;
    hal_step_release();
    step_channel_follow(cursor, channel, made);
    struct step_cursor next = *cursor;
    bool came_after = made == step_cursor_pulse(cursor) && made > 0 && tick_is_before(since, cursor->generator.tick);
    if (running && made == step_cursor_pulse(cursor)) {
        step_channel_follow(&next, channel, made + 1U);
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

uint64_t step_channel_pulses(const struct step_channel *channel)
{
    hal_step_hold();
    uint64_t pulses = step_channel_count(channel);
    hal_step_release();
    return pulses;
}

/* The way there is the other one before the last turn. */
static int64_t channel_position_of(const struct step_channel *channel, uint64_t pulse)
{
    uint64_t way = pulse < channel->turned ? 2U * channel->turned - pulse : pulse;
    return channel->origin + channel->direction * (int64_t)way;
}

int64_t step_channel_position_held(const struct step_channel *channel)
{
    return channel_position_of(channel, step_channel_count(channel));
}

int64_t step_channel_position(const struct step_channel *channel)
{
    hal_step_hold();
    int64_t position = step_channel_position_held(channel);
    hal_step_release();
    return position;
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
    uint32_t tail = young->tail;
    if (tail != atomic_load_explicit(&channel->taken, memory_order_relaxed)) {
        uint32_t head = atomic_load_explicit(&channel->head, memory_order_relaxed);
        atomic_store_explicit(&channel->taken, tail, memory_order_release);
        room->main_has_work = STEP_QUEUE_SEGMENTS - (head - tail) >= channel->wake_room;
    }
    channel->young ^= 1U;
    channel->kept[channel->young] = channel->cursor;
}

/* Before a segment that is marked or goes the other way. False: all pulses before a marked one must have been made, as
 * main is to be told of it then, and not before; a portion goes one way. */
BASE_APART static bool channel_heed(struct step_channel *channel, struct hal_step_room *room, unsigned place,
                                    bool marked)
{
    bool turns = room->backward != (channel->direction < 0);
    if (place > 0 || (marked && room->waiting > 0)) {
        return false;
    }
    if (turns) {
        step_channel_turn_over(channel);
    }
    if (marked) {
        atomic_store_explicit(&channel->marked, true, memory_order_relaxed);
        room->main_has_work = true;
    }
    return true;
}

/* False at the end of what is queued, and where the next segment has to wait. */
static bool channel_lay_first(struct step_channel *channel, struct hal_step_room *room, unsigned place)
{
    uint32_t tail = channel->cursor.tail;
    if (tail == atomic_load_explicit(&channel->head, memory_order_acquire)) {
        return false;
    }
    const struct step_segment *segment = queue_slot(channel, tail);
    bool before = channel->direction < 0;
    room->backward = (channel->backward >> tail % STEP_QUEUE_SEGMENTS & 1U) != 0;
    if (BASE_SELDOM(segment->marked || room->backward != before) &&
        !channel_heed(channel, room, place, segment->marked)) {
        room->backward = before;
        return false;
    }
    cursor_begin_segment(&channel->cursor, segment);
    step_lay_pulse(&channel->cursor.generator, room, place);
    return true;
}

static void channel_rest(struct step_channel *channel, struct hal_step_room *room)
{
    step_channel_keep_nothing(channel);
    atomic_store_explicit(&channel->running, false, memory_order_release);
    room->main_has_work = true;
}

/* What is left of a segment then is left to another time. */
static unsigned channel_lay(struct step_channel *channel, struct hal_step_room *room)
{
    struct step_cursor *cursor = &channel->cursor;
    unsigned laid = 0;
    bool more = true;
    do {
        if (BASE_SELDOM(cursor->left == 0)) {
            if (!channel_lay_first(channel, room, laid)) {
                break;
            }
            laid++;
        } else {
            unsigned most = room->count - laid;
            unsigned count = step_lay(&cursor->generator, room, laid, most < cursor->left ? most : cursor->left);
            laid += count;
            cursor->left -= count;
            more = cursor->left == 0;
        }
    } while (more && laid < room->count && step_lay_goes_on(cursor->generator.tick, room->until_tick));
    return laid;
}

/* While the queue is planned anew from a pulse on, those before it are laid. False: they have been. */
BASE_APART static bool channel_leave_room(const struct step_channel *channel, struct hal_step_room *room)
{
    uint64_t laid = step_cursor_pulse(&channel->cursor);
    uint64_t left = laid < channel->until ? channel->until - laid : 0;
    room->count = left < room->count ? (unsigned)left : room->count;
    return room->count != 0;
}

unsigned step_channel_lay_isr(struct step_channel *channel, struct hal_step_room *room)
{
    if (BASE_SELDOM(channel->frozen) && !channel_leave_room(channel, room)) {
        return 0;
    }
    channel_keep(channel, room);
    unsigned laid = channel_lay(channel, room);
    if (BASE_SELDOM(laid == 0) && room->waiting == 0) {
        channel_rest(channel, room);
    }
    return laid;
}
