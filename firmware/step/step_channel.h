/*
 * A step channel: the pulses of one motor, from segments to the pin.
 *
 * Comes in: segments, in a ring that the planner fills (main) and the step interrupt empties. Goes out: compare ticks
 * to hal_step, one pulse ahead, and the position. Because the channel is never more than one pulse ahead, a stop or a
 * change of speed cuts the queue at the pulse that is armed, and a stop that is seen late takes back that one pulse.
 * Functions named _isr run in the step interrupt; step_channel_look, _brake, _halt and _pulses in any context below it,
 * all others in main or the plan interrupt, never in both at once.
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

/* How far the pulses have come: enough to foresee the pulses that follow. */
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

/* Readies the channel for a move that begins at `tick` with DIR set; the queue is empty. Not while running. */
void step_channel_begin(struct step_channel *channel, uint32_t tick, bool backward);

/* Free places in the queue. */
uint32_t step_channel_room(const struct step_channel *channel);

/* Appends a segment; there must be room. False, and nothing is changed, after a brake or a halt, until a splice or the
 * next move. */
bool step_channel_push(struct step_channel *channel, const struct step_segment *segment);

/* Arms the next pulse, the first of what has been pushed; rests if there is none. Not while running. */
void step_channel_run(struct step_channel *channel);

/* Whether a pulse is still to come. */
bool step_channel_is_running(const struct step_channel *channel);

/* The first pulse of a move behind `since`: the armed one, or, below 25 000 steps/s, the one before, if it came after
 * `since`. False at rest. */
bool step_channel_look(const struct step_channel *channel, uint32_t since, struct step_cursor *cursor);

/* The pulse at which a change can take effect: the armed one, or the first that is due at or after `tick`, which
 * gives the caller time to plan. False if no pulse is left there. */
bool step_channel_foresee(const struct step_channel *channel, uint32_t tick, struct step_cursor *cursor);

/* Stops what was queued and brakes, from the pulse `at` on and to the pulse `until` at most: a stop-gap that takes
 * effect at once, while the segments behind `at` are being planned. `at` comes in as seen by step_channel_look; if the
 * pulse behind it is armed by now, that one is taken back. If it is too late for that, `at` goes out as the armed
 * pulse. False, and nothing is changed, at rest. */
bool step_channel_brake(struct step_channel *channel, int32_t accel, uint64_t until, struct step_cursor *at);

/* Puts the first planned segment behind `at` in the place of the stop-gap. The pulses that were made in the meantime
 * are on it already: both brake alike, and it has no fewer pulses. A mark of it is
 * reported when `at` has been made. */
void step_channel_splice(struct step_channel *channel, const struct step_cursor *at,
                         const struct step_segment *segment);

/* From the pulse `at` on, nothing that was queued is left, and `count` new segments follow. False, and nothing is
 * changed, if the motor has gone past that pulse in the meantime, or brakes, or if the queue has no room for so many
 * behind it. */
bool step_channel_cut(struct step_channel *channel, const struct step_cursor *at, const struct step_segment *segments,
                      unsigned count);

/* Takes the armed pulse back and ends the move at once; at rest, drops what is queued. */
void step_channel_halt(struct step_channel *channel);

/* Pulses made in the present or last move. */
uint64_t step_channel_pulses(const struct step_channel *channel);

/* Absolute position, steps; set only while not running. */
int64_t step_channel_position(const struct step_channel *channel);
void step_channel_set_position(struct step_channel *channel, int64_t position_steps);

/* The tick of the last pulse; of the start of the move if there was none. Not while running. */
uint32_t step_channel_end_tick(const struct step_channel *channel);

/* Whether a marked segment has begun since the last call. */
bool step_channel_take_mark(struct step_channel *channel);

/* What follows a pulse. LOOK: main should look, as the move has ended, or a marked segment has begun, or the queue has
 * got shorter. */
enum {
    STEP_CHANNEL_ARM = 1,
    STEP_CHANNEL_LOOK = 2
};

/* step_channel_next_isr where a segment ends. */
unsigned step_channel_next_segment_isr(struct step_channel *channel);

/* The armed pulse has been made by hardware: counts it and finds the next. With STEP_CHANNEL_ARM in the answer the
 * caller arms it, at cursor.generator.tick. Inline, for a backend whose step interrupt is one function. */
static inline unsigned step_channel_next_isr(struct step_channel *channel)
{
    struct step_cursor *cursor = &channel->cursor;
    uint32_t left = cursor->left - 1U;
    if (BASE_SELDOM(left > cursor->left)) {
        return step_channel_next_segment_isr(channel);
    }
    cursor->left = left;
    (void)step_generator_next(&cursor->generator);
    return STEP_CHANNEL_ARM;
}

/* The same for other backends: arms the next pulse through hal_step. True when main should look. */
bool step_channel_pulse_isr(struct step_channel *channel);

#endif
