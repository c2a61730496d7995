/*
 * A step channel: the pulses of one motor, from segments to the pin.
 *
 * Comes in: segments, in a ring that the planner fills and the step interrupt empties. Goes out:
 * compare ticks to hal_step, one pulse ahead, and the position. Because the channel is never more
 * than one pulse ahead, a stop or a change of speed replaces the queue from the armed pulse on, and
 * a stop that is seen late takes back that one pulse.
 *
 * Who may call: the planner's functions belong to main and the plan interrupt, to one of them at a
 * time. Only step_channel_find_pulse, _brake, _halt and _pulses may interrupt them, from the tick
 * interrupt. step_channel_pulse_isr is the step interrupt's.
 */
#ifndef STEP_CHANNEL_H
#define STEP_CHANNEL_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "base_hint.h"
#include "step_generator.h"
#include "step_segment.h"

/* A compound move of ten sections has at most 30 segments: a whole move fits. A power of two. */
enum {
    STEP_QUEUE_SEGMENTS = 32
};

/* How far the pulses have come: enough to look ahead at the pulses that follow. */
struct step_cursor {
    struct step_generator generator;
    uint64_t before_residual; /* of the last pulse on the segment before */
    uint64_t before_slope;
    int32_t before_accel;
    uint64_t end;   /* ordinal in the move of the last pulse on the present segment */
    uint32_t left;  /* pulses still to come on the present segment */
    uint32_t first; /* low half of the ordinal of the present segment's first pulse */
    uint32_t tail;  /* count of segments taken from the queue */
};

/* The ordinal in the move of the pulse that a cursor stands on; 0 before the first. */
static inline uint64_t step_cursor_pulse(const struct step_cursor *cursor)
{
    return cursor->end - cursor->left;
}

struct step_channel {
    struct step_cursor cursor; /* stands on the armed pulse while running, else on the last one made */
    struct step_segment queue[STEP_QUEUE_SEGMENTS];
    _Atomic uint32_t head;  /* count of segments put into the queue; written by main */
    _Atomic uint32_t taken; /* count of segments taken; written by the interrupt: what main may overwrite */
    _Atomic bool running;   /* a pulse is armed */
    _Atomic bool marked;    /* a marked segment has begun; main clears it */
    bool closed;            /* the motor brakes or has been halted: what was planned before is not wanted any more */
    int64_t origin;         /* absolute position at the start of the move, steps */
    int8_t direction;       /* +1 or -1 */
    uint8_t motor;          /* 0 to 3 */
};

/* Stands at position 0. */
void step_channel_init(struct step_channel *channel, unsigned motor);

/* Readies the channel for a move that begins at `tick` with DIR set; the queue is empty. Not while
 * running. */
void step_channel_begin(struct step_channel *channel, uint32_t tick, bool backward);

/* Free slots in the queue. */
uint32_t step_channel_room(const struct step_channel *channel);

/* Appends a segment; there must be room. False, and nothing is changed, once the motor brakes or
 * was halted, until the brake is replaced or the next move begins. */
bool step_channel_push(struct step_channel *channel, const struct step_segment *segment);

/* Arms the next pulse, the first of what has been pushed; rests if there is none. Not while
 * running. */
void step_channel_run(struct step_channel *channel);

/* Whether a pulse is still to come. */
bool step_channel_is_running(const struct step_channel *channel);

/* The first pulse of a move after `since`: the armed one, or, below 25 000 steps/s, the one before,
 * if it came after `since`. False at rest. */
bool step_channel_find_pulse(const struct step_channel *channel, uint32_t since, struct step_cursor *cursor);

/* The pulse at which a change can take effect: the armed one, or the first that is due at or after
 * `tick`, which gives the caller time to plan. False if no pulse is left there. */
bool step_channel_look_ahead(const struct step_channel *channel, uint32_t tick, struct step_cursor *cursor);

/* Drops what is queued and brakes, from the pulse `at` on and to the pulse `until` at most: a
 * stopgap that takes effect at once, while the segments after `at` are being planned. `at` comes in
 * as step_channel_find_pulse found it; if the pulse after it is armed by now, that one is taken
 * back. If it is too late for that, `at` goes out as the armed pulse. False, and nothing is
 * changed, at rest. */
bool step_channel_brake(struct step_channel *channel, int32_t accel, uint64_t until, struct step_cursor *at);

/* Replaces the stopgap by the first planned segment after `at`. The pulses made meanwhile are on it
 * already: both brake alike, and it has no fewer pulses. If it is marked, that is reported once
 * `at` has been made. */
void step_channel_replace_brake(struct step_channel *channel, const struct step_cursor *at,
                                const struct step_segment *segment);

/* Replaces all that is queued after the pulse `at` by `count` new segments. False, and nothing is
 * changed, if the motor has gone past that pulse in the meantime, or brakes, or if the queue has no
 * room for so many. */
bool step_channel_replace(struct step_channel *channel, const struct step_cursor *at,
                          const struct step_segment *segments, unsigned count);

/* Takes the armed pulse back and ends the move at once; at rest, drops what is queued. */
void step_channel_halt(struct step_channel *channel);

/* Pulses made in the present or last move. */
uint64_t step_channel_pulses(const struct step_channel *channel);

/* Absolute position, steps; set only while not running. */
int64_t step_channel_position(const struct step_channel *channel);
void step_channel_set_position(struct step_channel *channel, int64_t position_steps);

/* The tick of the last pulse; of the start of the move if there was none. Not while running. */
uint32_t step_channel_end_tick(const struct step_channel *channel);

/* Whether a marked segment has begun since the last call; main alone. */
bool step_channel_take_mark(struct step_channel *channel);

/* What follows a pulse. WAKE: main has something to do, as the move has ended, or a marked segment
 * has begun, or the queue has got shorter. */
enum {
    STEP_CHANNEL_ARM = 1,
    STEP_CHANNEL_WAKE = 2
};

/* step_channel_next where a segment ends. */
unsigned step_channel_next_segment(struct step_channel *channel);

/* Moves on to the next pulse: where the armed one has been made, in the step interrupt, or where
 * none is armed, with hal_step held. With STEP_CHANNEL_ARM in the answer the caller arms it, at
 * cursor.generator.tick. Inline, for a backend whose step interrupt is one function. */
static inline unsigned step_channel_next(struct step_channel *channel)
{
    struct step_cursor *cursor = &channel->cursor;
    /* At 0 the difference wraps and is the greater: the subtraction's borrow is the test, which
     * saves a comparison for each pulse. */
    uint32_t left = cursor->left - 1U;
    if (BASE_SELDOM(left > cursor->left)) {
        return step_channel_next_segment(channel);
    }
    cursor->left = left;
    (void)step_generator_next(&cursor->generator);
    return STEP_CHANNEL_ARM;
}

/* For backends that do not call step_channel_next themselves: the armed pulse has been made; arms
 * the next through hal_step. True when main has something to do. */
bool step_channel_pulse_isr(struct step_channel *channel);

#endif
