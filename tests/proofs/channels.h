/*
 * Contracts of the step channel: proved with step_channel.acsl (the ring, and what goes along it) and
 * step_channel_replace.acsl (what ends or changes a move).
 */
#ifndef CHANNELS_H
#define CHANNELS_H

#include "numbers.h"
#include "conversions.h"
#include "atomics.h"
#include "base_tick.h"
#include "hal_step.h"
#include "step_channel.h"

/* Counters wrap after 2^32, which the size of the ring divides. */
/*@ logic integer distance(integer head, integer tail) = (uint32_t)(head - tail);
    logic integer slot(integer tail, integer i) = (tail + i) % 32;
    predicate is_count(integer x) = 0 <= x <= 0xFFFFFFFF;

    lemma part: \forall integer x; 0 <= x ==> 0 <= x % 32 < 32;
    lemma index: \forall integer x; 0 <= x ==> (uint32_t)(x % 32) == x % 32;
    lemma distance_plain: \forall integer x, y; is_count(x) && is_count(y) ==>
        distance(x, y) == (x >= y ? x - y : x - y + 0x100000000);
    lemma distance_up: \forall integer x, y; is_count(x) && is_count(y) && distance(x, y) < 0xFFFFFFFF ==>
        distance((uint32_t)(x + 1), y) == distance(x, y) + 1;
    lemma distance_down: \forall integer x, y; is_count(x) && is_count(y) && distance(x, y) > 0 ==>
        distance(x, (uint32_t)(y + 1)) == distance(x, y) - 1;
    lemma distance_none: \forall integer x, y; is_count(x) && is_count(y) && distance(x, y) == 0 ==> x == y;
    lemma slot_range: \forall integer tail, i; 0 <= tail && 0 <= i ==> 0 <= slot(tail, i) < 32;
    lemma slot_first: \forall integer tail; slot(tail, 0) == tail % 32;
    lemma slot_last: \forall integer x, y; is_count(x) && is_count(y) ==> slot(y, distance(x, y)) == x % 32;
    lemma slot_next: \forall integer tail, i; is_count(tail) && 0 <= i ==>
        slot((uint32_t)(tail + 1), i) == slot(tail, i + 1);
    lemma slot_other: \forall integer tail, i, j; 0 <= tail && 0 <= i < 32 && 0 <= j < 32 && i != j ==>
        slot(tail, i) != slot(tail, j);
*/

/* A sound channel. As each segment has less than 2^32 pulses, a move whose end is not in sight stays finite. */
/*@ logic integer queued(struct step_channel *channel) = distance(channel->head, channel->cursor.tail);
    logic integer pulse_of(struct step_cursor *cursor) = cursor->end - cursor->left;
    logic integer made_by(struct step_channel *channel) =
        pulse_of(&channel->cursor) - (channel->running ? 1 : 0);
    predicate ring_is_sound(struct step_channel *channel) =
        \valid(channel) && channel->taken == channel->cursor.tail && queued(channel) <= STEP_QUEUE_SEGMENTS;
    predicate is_filled(struct step_segment *queue, integer tail, integer count) =
        \forall integer i; 0 <= i < count ==> queue[slot(tail, i)].steps >= 1;
    predicate cursor_is_sound(struct step_cursor *cursor) = cursor->left <= cursor->end;
    predicate fits(integer end, integer segments) = end + segments * 0x100000000 <= 0x1000000000000000;
    predicate is_sound(struct step_channel *channel) =
        ring_is_sound(channel) && cursor_is_sound(&channel->cursor) && channel->cursor.left < UINT32_MAX &&
        fits(channel->cursor.end, queued(channel)) &&
        is_filled(&channel->queue[0], channel->cursor.tail, queued(channel));
    predicate is_moving(struct step_channel *channel) =
        is_sound(channel) && (channel->running ==> pulse_of(&channel->cursor) >= 1);
    predicate is_pushable(struct step_channel *channel, struct step_segment *segment) =
        queued(channel) < STEP_QUEUE_SEGMENTS && fits(channel->cursor.end, queued(channel) + 1) &&
        \valid_read(segment) && \separated(segment, channel) && segment->steps >= 1;
*/

/* The ordinal of the last pulse on a segment: 0 is the present one, 1 the first in the queue. Nothing is said of it
 * but in is_numbered, so what is proved holds for whatever is queued. */
/*@ axiomatic Last { logic integer last_on(integer segment); }
    predicate is_numbered(struct step_channel *channel) =
        last_on(0) == channel->cursor.end &&
        \forall integer i; 0 <= i < queued(channel) ==>
            last_on(i + 1) == last_on(i) + channel->queue[slot(channel->cursor.tail, i)].steps;
    predicate is_within(struct step_channel *channel, integer pulse, integer segment) =
        0 <= segment <= queued(channel) && pulse <= last_on(segment);
*/

/* Proved in step_generator.acsl and base_tick.acsl; what the generator finds does not matter here. */
/*@ requires \valid(generator);
    assigns *generator;
*/
static inline uint32_t step_generator_next(struct step_generator *generator);
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
/*@ requires \valid(generator);
    assigns *generator;
*/
void step_generator_back(struct step_generator *generator);
/*@ assigns \nothing; */
bool tick_is_before(uint32_t a, uint32_t b);

/* The seam: it does not touch the channel. */
/*@ assigns \nothing; */
void hal_step_arm(unsigned motor, uint32_t tick);
/*@ assigns \nothing; */
bool hal_step_disarm(unsigned motor);
/*@ assigns \nothing; */
void hal_step_set_direction(unsigned motor, bool backward);
/*@ assigns \nothing; */
void hal_step_hold(void);
/*@ assigns \nothing; */
void hal_step_release(void);

/*@ requires \valid_read(cursor) && cursor_is_sound(cursor);
    assigns \nothing;
    ensures \result == pulse_of(cursor);
*/
static inline uint64_t step_cursor_pulse(const struct step_cursor *cursor);

/*@ requires is_sound(channel);
    assigns channel->cursor, channel->running, channel->marked, channel->taken;
    ensures is_sound(channel);
    ensures \result == STEP_CHANNEL_ARM || \result == STEP_CHANNEL_WAKE || \result == 3;
    ensures \result == STEP_CHANNEL_WAKE ==> !channel->running &&
        pulse_of(&channel->cursor) == \old(pulse_of(&channel->cursor));
    ensures \result != STEP_CHANNEL_WAKE ==> channel->running == \old(channel->running) &&
        pulse_of(&channel->cursor) == \old(pulse_of(&channel->cursor)) + 1;
    ensures queued(channel) <= \old(queued(channel));
    ensures \old(queued(channel)) == 0 ==> channel->cursor.end == \old(channel->cursor.end);
*/
static inline unsigned step_channel_next(struct step_channel *channel);

/*@ requires \valid_read(channel);
    assigns \nothing;
    ensures \result == &channel->queue[count % 32];
*/
static const struct step_segment *queue_slot(const struct step_channel *channel, uint32_t count);

/*@ requires \valid(cursor) && \valid_read(channel) && \separated(cursor, &channel->queue[0 .. 31]);
    requires cursor->tail != head ==> channel->queue[cursor->tail % 32].steps >= 1;
    assigns *cursor;
    ensures \result <==> \old(cursor->tail) != head;
    ensures !\result ==> cursor->tail == \old(cursor->tail) && cursor->left == \old(cursor->left) &&
        cursor->end == \old(cursor->end);
    ensures \result ==> cursor->tail == (uint32_t)(\old(cursor->tail) + 1);
    ensures \result ==> cursor->left == channel->queue[\old(cursor->tail) % 32].steps - 1;
    ensures \result && \old(cursor->end) <= 0x1000000000000000 ==>
        cursor->end == \old(cursor->end) + channel->queue[\old(cursor->tail) % 32].steps;
*/
static inline bool cursor_begin_segment(struct step_cursor *cursor, const struct step_channel *channel, uint32_t head);

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
    ensures \result && \old(cursor->left) == 0 && \old(cursor->end) <= 0x1000000000000000 ==>
        cursor->end == \old(cursor->end) + channel->queue[\old(cursor->tail) % 32].steps;
    ensures one_pulse: \result && \old(cursor->left <= cursor->end <= 0x1000000000000000) ==>
        pulse_of(cursor) == \old(pulse_of(cursor)) + 1;
*/
static bool cursor_advance(struct step_cursor *cursor, const struct step_channel *channel, uint32_t head);

/*@ requires is_sound(channel) && is_pushable(channel, segment);
    assigns channel->queue[channel->head % 32], channel->head;
    ensures is_sound(channel) && queued(channel) == \old(queued(channel)) + 1;
    ensures channel->head == (uint32_t)(\old(channel->head) + 1);
    ensures channel->cursor.tail == \old(channel->cursor.tail) && channel->cursor.left == \old(channel->cursor.left) &&
        channel->cursor.end == \old(channel->cursor.end);
    ensures channel->queue[\old(channel->head) % 32].steps == \old(segment->steps);
    ensures slot(channel->cursor.tail, \old(queued(channel))) == \old(channel->head) % 32;
    ensures \forall integer i; 0 <= i < \old(queued(channel)) ==>
        slot(channel->cursor.tail, i) != \old(channel->head) % 32;
    ensures kept: \forall integer i; 0 <= i < \old(queued(channel)) ==>
        channel->queue[slot(channel->cursor.tail, i)].steps ==
            \old(channel->queue[slot(channel->cursor.tail, i)].steps);
*/
static void channel_push(struct step_channel *channel, const struct step_segment *segment);

/*@ requires is_sound(channel);
    assigns channel->cursor, channel->running, channel->marked, channel->taken;
    ensures is_moving(channel);
    ensures made_by(channel) == \old(pulse_of(&channel->cursor));
    ensures queued(channel) <= \old(queued(channel));
    ensures \old(queued(channel)) == 0 ==> channel->cursor.end == \old(channel->cursor.end);
*/
void step_channel_run(struct step_channel *channel);

/*@ requires \valid_read(channel);
    assigns \nothing;
    ensures \result <==> channel->running;
*/
bool step_channel_is_running(const struct step_channel *channel);

/*@ requires \valid_read(cursor) && cursor_is_sound(cursor);
    assigns \nothing;
    ensures \result ==> pulse_of(cursor) > 1;
*/
static bool cursor_can_go_back(const struct step_cursor *cursor);

/*@ requires \valid(cursor) && cursor_is_sound(cursor);
    requires pulse_of(cursor) > 1 && cursor->left < UINT32_MAX;
    assigns *cursor;
    ensures cursor_is_sound(cursor) && pulse_of(cursor) == \old(pulse_of(cursor)) - 1;
    ensures cursor->left == \old(cursor->left) + 1 && cursor->end == \old(cursor->end);
    ensures cursor->tail == \old(cursor->tail);
*/
static void cursor_go_back(struct step_cursor *cursor);

/*@ requires is_moving(channel) && \valid(cursor) && \separated(cursor, channel);
    assigns *cursor;
    ensures \result <==> channel->running;
    ensures cursor_is_sound(cursor) && cursor->end == channel->cursor.end && cursor->tail == channel->cursor.tail;
    ensures pulse_of(cursor) == pulse_of(&channel->cursor) ||
        (\result && pulse_of(cursor) == pulse_of(&channel->cursor) - 1);
    ensures \result ==> pulse_of(cursor) >= 1;
*/
bool step_channel_find_pulse(const struct step_channel *channel, uint32_t since, struct step_cursor *cursor);

/*@ requires is_sound(channel) && is_numbered(channel) && pulse_of(&channel->cursor) <= pulse;
    requires \exists integer i; is_within(channel, pulse, i);
    assigns channel->cursor.left, channel->cursor.end, channel->queue[0 .. 31].steps, channel->head;
    ensures is_sound(channel) && pulse_of(&channel->cursor) == \old(pulse_of(&channel->cursor));
    ensures queued(channel) <= \old(queued(channel));
    ensures first: \forall integer i; 0 <= i <= \old(queued(channel)) && pulse <= last_on(i) ==> queued(channel) <= i;
    ensures present: queued(channel) == 0 ==> channel->cursor.end == pulse;
    ensures others: queued(channel) > 0 ==> channel->cursor.end == \old(channel->cursor.end);
    ensures kept: \forall integer i; 0 <= i < queued(channel) - 1 ==>
        channel->queue[slot(channel->cursor.tail, i)].steps ==
            \old(channel->queue[slot(channel->cursor.tail, i)].steps);
    ensures last: queued(channel) > 0 ==>
        channel->queue[slot(channel->cursor.tail, queued(channel) - 1)].steps == pulse - last_on(queued(channel) - 1);
*/
static void channel_truncate(struct step_channel *channel, uint64_t pulse);

#endif
