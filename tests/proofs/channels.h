/*
 * Contracts of the step channel: proved with step_channel.acsl (the ring, and what is laid from it),
 * step_channel_replace.acsl (ways back, and what changes a move) and step_channel_stop.acsl (what ends it).
 */
#ifndef CHANNELS_H
#define CHANNELS_H

#include "numbers.h"
#include "conversions.h"
#include "atomics.h"
#include "base_tick.h"
#include "hal_step.h"
#include "step_channel_private.h"
#include "step_lay.h"

/* Counters wrap after 2^32, which the size of the ring divides. A count is in a ring if it lies between the counts of
 * its two ends. */
/*@ logic integer distance(integer head, integer tail) = (uint32_t)(head - tail);
    predicate is_count(integer x) = 0 <= x <= 0xFFFFFFFF;
    predicate in_ring(integer head, integer tail, integer x) =
        is_count(x) && distance(x, tail) + distance(head, x) == distance(head, tail);

    lemma index: \forall integer x; 0 <= x ==> 0 <= x % 32 < 32 && (uint32_t)(x % 32) == x % 32;
    lemma distance_plain: \forall integer x, y; is_count(x) && is_count(y) ==>
        distance(x, y) == (x >= y ? x - y : x - y + 0x100000000);
    lemma count_next: \forall integer x; is_count(x) ==>
        (uint32_t)(x + 1) == (x == 0xFFFFFFFF ? 0 : x + 1);
    lemma ring_next: \forall integer h, t, x; is_count(h) && is_count(t) && in_ring(h, t, x) && x != h ==>
        in_ring(h, t, (uint32_t)(x + 1)) && distance(h, (uint32_t)(x + 1)) == distance(h, x) - 1;
    lemma ring_ends: \forall integer h, t; is_count(h) && is_count(t) ==> in_ring(h, t, t) && in_ring(h, t, h);
    lemma ring_after: \forall integer h, t, c, y; is_count(h) && is_count(t) && in_ring(h, t, c) && in_ring(c, t, y) ==>
        in_ring(h, y, c) && in_ring(h, t, y) && distance(h, y) <= distance(h, t);
    lemma ring_above: \forall integer h, t, y, x; is_count(h) && is_count(t) && in_ring(h, t, y) && in_ring(h, y, x) ==>
        in_ring(h, t, x);
    lemma ring_below: \forall integer h, t, y, x; is_count(h) && is_count(t) && in_ring(h, t, y) && in_ring(y, t, x) ==>
        in_ring(h, t, x) && distance(h, y) <= distance(h, x);
    lemma distance_up: \forall integer h, t; is_count(h) && is_count(t) && distance(h, t) < 0xFFFFFFFF ==>
        distance((uint32_t)(h + 1), t) == distance(h, t) + 1;
    lemma ring_grown: \forall integer h, t, x; is_count(h) && is_count(t) && distance(h, t) < 0xFFFFFFFF ==>
        distance((uint32_t)(h + 1), t) == distance(h, t) + 1 &&
        (in_ring(h, t, x) ==> in_ring((uint32_t)(h + 1), t, x) &&
            distance((uint32_t)(h + 1), x) == distance(h, x) + 1);
    lemma ring_grown_back: \forall integer h, t, x; is_count(h) && is_count(t) && distance(h, t) < 0xFFFFFFFF &&
        in_ring((uint32_t)(h + 1), t, x) && x != (uint32_t)(h + 1) ==> in_ring(h, t, x);
    lemma ring_apart: \forall integer h, t, x; is_count(h) && is_count(t) && distance(h, t) < 32 && in_ring(h, t, x) &&
        x != h ==> x % 32 != h % 32;
*/

/* A sound channel. As each segment has less than 2^32 pulses, a move whose end is not in sight stays finite. */
/*@ logic integer queued(struct step_channel *channel) = distance(channel->head, channel->taken);
    logic integer to_come(struct step_channel *channel) = distance(channel->head, channel->cursor.tail);
    logic integer pulse_of(struct step_cursor *cursor) = cursor->end - cursor->left;
    predicate fits(integer end, integer segments) = end + segments * 0x100000000 <= 0x1000000000000000;
    predicate is_filled(struct step_channel *channel) =
        \forall integer x; in_ring(channel->head, channel->taken, x) && x != channel->head ==>
            channel->queue[x % 32].steps >= 1;
    predicate ring_is_sound(struct step_channel *channel) =
        \valid(channel) && queued(channel) <= STEP_QUEUE_SEGMENTS && is_filled(channel) &&
        in_ring(channel->head, channel->taken, channel->cursor.tail);
    predicate is_kept(struct step_channel *channel, struct step_cursor *kept) =
        in_ring(channel->cursor.tail, channel->taken, kept->tail) && kept->left <= kept->end &&
        kept->end <= channel->cursor.end && pulse_of(kept) <= pulse_of(&channel->cursor);
    predicate is_sound(struct step_channel *channel) =
        ring_is_sound(channel) && channel->cursor.left <= channel->cursor.end &&
        fits(channel->cursor.end, to_come(channel)) && channel->young <= 1 &&
        is_kept(channel, &channel->kept[0]) && is_kept(channel, &channel->kept[1]);
    predicate keeps_nothing(struct step_channel *channel) =
        channel->taken == channel->cursor.tail && channel->kept[0].tail == channel->cursor.tail &&
        channel->kept[1].tail == channel->cursor.tail && channel->kept[0].end == channel->cursor.end &&
        channel->kept[1].end == channel->cursor.end && channel->kept[0].left == channel->cursor.left &&
        channel->kept[1].left == channel->cursor.left;
    predicate is_pushable(struct step_channel *channel, struct step_segment *segment) =
        queued(channel) < STEP_QUEUE_SEGMENTS && fits(channel->cursor.end, to_come(channel) + 1) &&
        \valid_read(segment) && \separated(segment, channel) && segment->steps >= 1;
*/

/* The ordinal of the last pulse before the segment with a count: the end of each cursor with that count. Nothing is
 * said of it but in is_numbered, so what is proved holds for whatever is queued. */
/*@ axiomatic Last { logic integer last_at(integer count); }
    predicate queue_is_numbered(struct step_channel *channel) =
        \forall integer x; in_ring(channel->head, channel->taken, x) && x != channel->head ==>
            last_at((uint32_t)(x + 1)) == last_at(x) + channel->queue[x % 32].steps;
    predicate is_numbered(struct step_channel *channel) =
        queue_is_numbered(channel) && channel->cursor.end == last_at(channel->cursor.tail) &&
        channel->kept[0].end == last_at(channel->kept[0].tail) &&
        channel->kept[1].end == last_at(channel->kept[1].tail);
    predicate is_on_way(struct step_channel *channel, struct step_cursor *cursor) =
        in_ring(channel->head, channel->taken, cursor->tail) && cursor->left <= cursor->end &&
        cursor->end == last_at(cursor->tail) &&
        cursor->end + distance(channel->head, cursor->tail) * 0x100000000 <= 0x2000000000000000;
*/

/* Proved in step_generator.acsl, step_lay.acsl and base_tick.acsl; what the generator finds does not matter here. */
/*@ requires \valid(generator);
    assigns *generator;
*/
static inline uint32_t step_generator_next(struct step_generator *generator);
/*@ requires \valid(generator) && 1 <= pulses <= 8;
    assigns *generator;
*/
bool step_skip(struct step_generator *generator, uint32_t pulses);
/*@ requires \valid(generator) && \valid_read(segment);
    assigns *generator;
*/
static inline void step_generator_load(struct step_generator *generator, const struct step_segment *segment);
/*@ requires \valid(generator);
    assigns *generator;
*/
void step_generator_start(struct step_generator *generator, uint32_t tick);
/*@ requires \valid(generator) && \valid_read(segment);
    assigns *generator;
*/
void step_generator_join(struct step_generator *generator, const struct step_segment *segment, uint32_t made);
/*@ requires \valid(generator) && \valid_read(room) && 1 <= count && first + count <= UINT32_MAX;
    requires \valid(&room->pulse[first .. first + count - 1]);
    requires \separated(generator, &room->pulse[first .. first + count - 1]) && \separated(generator, room) &&
        \separated(room, &room->pulse[first .. first + count - 1]);
    assigns *generator, room->pulse[first .. first + count - 1];
    ensures 1 <= \result <= count;
*/
unsigned step_lay(struct step_generator *generator, const struct hal_step_room *room, unsigned first, unsigned count);
/*@ requires \valid_read(generator) && \valid_read(room) && \valid(&room->pulse[place]);
    requires \separated(generator, &room->pulse[place]) && \separated(room, &room->pulse[place]);
    assigns room->pulse[place];
*/
static inline void step_lay_pulse(const struct step_generator *generator, const struct hal_step_room *room,
                                  unsigned place);
/*@ assigns \nothing; */
bool tick_is_before(uint32_t a, uint32_t b);

/* The seam. That hal_step_run lays pulses is left out here: step_channel_lay_isr keeps a channel sound. */
/*@ axiomatic Waiting { logic integer most_waiting; }
    predicate waits(struct step_channel *channel) = 0 <= most_waiting <= pulse_of(&channel->cursor);
*/
/*@ assigns \nothing; */
void hal_step_run(unsigned motor);
/*@ assigns \nothing;
    ensures \result <= most_waiting;
*/
unsigned hal_step_waiting(unsigned motor);
/*@ assigns \nothing;
    ensures \result <= count && \result <= most_waiting;
*/
unsigned hal_step_take_back(unsigned motor, unsigned count);
/*@ assigns \nothing; */
void hal_step_set_direction(unsigned motor, bool backward);
/*@ assigns \nothing; */
void hal_step_hold(void);
/*@ assigns \nothing; */
void hal_step_release(void);

/*@ requires \valid_read(cursor) && cursor->left <= cursor->end;
    assigns \nothing;
    ensures \result == pulse_of(cursor);
*/
static inline uint64_t step_cursor_pulse(const struct step_cursor *cursor);

/*@ requires \valid_read(channel);
    assigns \nothing;
    ensures \result == &channel->queue[count % 32];
*/
static const struct step_segment *queue_slot(const struct step_channel *channel, uint32_t count);

/*@ requires \valid(cursor) && \valid_read(segment) && \separated(cursor, segment) && segment->steps >= 1;
    assigns *cursor;
    ensures cursor->tail == (uint32_t)(\old(cursor->tail) + 1);
    ensures cursor->left == \old(segment->steps) - 1;
    ensures \old(cursor->end) <= 0x2000000000000000 ==> cursor->end == \old(cursor->end) + \old(segment->steps);
*/
static inline void cursor_begin_segment(struct step_cursor *cursor, const struct step_segment *segment);

/*@ requires \valid(cursor) && \valid_read(channel) && \separated(cursor, &channel->queue[0 .. 31]);
    requires cursor->tail != head ==> channel->queue[cursor->tail % 32].steps >= 1;
    assigns *cursor;
    ensures \result <==> \old(cursor->left) > 0 || \old(cursor->tail) != head;
    ensures !\result ==> cursor->tail == \old(cursor->tail) && cursor->left == \old(cursor->left) &&
        cursor->end == \old(cursor->end);
    ensures \old(cursor->left) > 0 ==> cursor->left == \old(cursor->left) - 1 && cursor->tail == \old(cursor->tail) &&
        cursor->end == \old(cursor->end);
    ensures \result && \old(cursor->left) == 0 ==> cursor->tail == (uint32_t)(\old(cursor->tail) + 1) &&
        cursor->left == channel->queue[\old(cursor->tail) % 32].steps - 1;
    ensures \result && \old(cursor->left) == 0 && \old(cursor->end) <= 0x2000000000000000 ==>
        cursor->end == \old(cursor->end) + channel->queue[\old(cursor->tail) % 32].steps;
    ensures one_pulse: \result && \old(cursor->left <= cursor->end <= 0x2000000000000000) ==>
        pulse_of(cursor) == \old(pulse_of(cursor)) + 1;
*/
static bool cursor_advance(struct step_cursor *cursor, const struct step_channel *channel, uint32_t head);

/*@ requires \valid(cursor) && cursor->left <= cursor->end && pulse_of(cursor) < pulse;
    assigns *cursor;
    ensures cursor->end == \old(cursor->end) && cursor->tail == \old(cursor->tail);
    ensures cursor->left <= \old(cursor->left);
    ensures \result ==> cursor->left < \old(cursor->left) && pulse_of(cursor) < pulse;
    ensures !\result ==> cursor->left == \old(cursor->left);
*/
static bool cursor_skip(struct step_cursor *cursor, uint64_t pulse);

/*@ requires ring_is_sound(channel) && queue_is_numbered(channel) && \valid(cursor) && is_on_way(channel, cursor);
    requires \separated(cursor, &channel->queue[0 .. 31]) && \separated(cursor, &channel->head) &&
        \separated(cursor, &channel->taken);
    assigns *cursor;
    ensures is_on_way(channel, cursor);
    ensures \old(pulse_of(cursor)) <= pulse_of(cursor);
    ensures pulse_of(cursor) <= pulse || pulse_of(cursor) == \old(pulse_of(cursor));
    ensures there: \old(pulse_of(cursor)) <= pulse <= last_at(channel->head) ==> pulse_of(cursor) == pulse;
*/
void step_channel_follow(struct step_cursor *cursor, const struct step_channel *channel, uint64_t pulse);

/*@ requires ring_is_sound(channel) && channel->cursor.left <= channel->cursor.end && channel->young <= 1 &&
        fits(channel->cursor.end, to_come(channel));
    assigns channel->kept[0 .. 1], channel->taken;
    ensures is_sound(channel) && keeps_nothing(channel);
*/
void step_channel_keep_nothing(struct step_channel *channel);

/*@ requires is_sound(channel) && is_pushable(channel, segment);
    assigns channel->queue[channel->head % 32], channel->head, channel->backward, channel->pushed;
    ensures is_sound(channel) && queued(channel) == \old(queued(channel)) + 1;
    ensures channel->head == (uint32_t)(\old(channel->head) + 1);
    ensures channel->queue[\old(channel->head) % 32].steps == \old(segment->steps);
    ensures kept: \forall integer x; in_ring(\old(channel->head), channel->taken, x) && x != \old(channel->head) ==>
        channel->queue[x % 32].steps == \old(channel->queue[x % 32].steps);
*/
void step_channel_append(struct step_channel *channel, const struct step_segment *segment);

/*@ requires \valid_read(channel);
    assigns \nothing;
    ensures \result <==> channel->cursor.left == 0 && channel->cursor.tail == channel->head && channel->running;
*/
static bool channel_is_dry(const struct step_channel *channel);

/*@ requires \valid_read(channel);
    assigns \nothing;
    ensures \result <==> channel->running;
*/
bool step_channel_is_running(const struct step_channel *channel);

/*@ requires is_sound(channel) && waits(channel) && channel->recalled == 0;
    assigns \nothing;
    ensures pulse_of(&channel->cursor) - most_waiting <= \result <= pulse_of(&channel->cursor);
    ensures !channel->running ==> \result == pulse_of(&channel->cursor);
*/
uint64_t step_channel_count(const struct step_channel *channel);

/*@ requires is_sound(channel);
    assigns \nothing;
    ensures \result == &channel->kept[0] || \result == &channel->kept[1];
    ensures pulse_of(\result) <= pulse || \result == &channel->kept[1 - channel->young];
*/
const struct step_cursor *step_channel_base(const struct step_channel *channel, uint64_t pulse);

/*@ requires \valid(channel);
    assigns channel->origin, channel->direction, channel->turned;
*/
void step_channel_turn_over(struct step_channel *channel);

#endif
