/*
 * A step channel: the pulses of one motor, from segments to the pin.
 *
 * Comes in: segments, in a ring that the planner fills. Goes out: the edges of pulses, laid ahead as far as the backend
 * asks for, and the position. What has been laid and not made can be taken back, so a stop or a change of speed
 * replaces the queue from the next pulse on, whatever is laid by then.
 *
 * Who may call: the planner's functions belong to main and the plan interrupt, to one of them at a
 * time. Only step_channel_find_pulse, _brake, _halt, _pulses and _position may interrupt them, from the
 * tick interrupt. step_channel_lay_isr is the step interrupt's.
 */
#ifndef STEP_CHANNEL_H
#define STEP_CHANNEL_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "step_cursor.h"
#include "step_segment.h"

struct hal_step_room;

/* A compound move of ten sections has at most 30 segments: a whole move fits. A power of two. */
enum {
    STEP_QUEUE_SEGMENTS = 32
};

/*
 * The way back from the pulse that was laid last is the way on from one before it, pulse by pulse, as exact as the
 * first time. Two places are kept: the younger is one that `cursor` has passed; when all pulses up to it have been
 * made, it becomes the older one. So there is always one at or before the first pulse that can be taken back, unless
 * the motor brakes or its brake has been replaced: no way leads back beyond that.
 */
struct step_channel {
    struct step_cursor cursor;  /* stands on the pulse laid last; at rest on the last one made */
    struct step_cursor kept[2]; /* places before it */
    struct step_segment queue[STEP_QUEUE_SEGMENTS];
    _Atomic uint32_t head;  /* count of segments put into the queue; written by main */
    _Atomic uint32_t taken; /* count of segments that no way back leads over: what main may overwrite */
    _Atomic bool running;   /* a pulse is to come */
    _Atomic bool marked;    /* a marked segment has begun; main clears it */
    bool closed;            /* the motor brakes or has been halted: what was planned before is not wanted any more */
    bool frozen;            /* nothing after `until` is laid until the queue has been planned anew */
    bool turn;              /* what is pushed goes backward */
    uint8_t young;          /* which of `kept` is the younger one */
    int8_t direction;       /* +1 or -1: of the pulse laid last */
    uint8_t motor;          /* 0 to 3 */
    uint8_t wake_room;      /* free slots with which main is woken */
    uint32_t backward;      /* of each place of the queue a bit: its segment goes backward */
    uint32_t recalled;      /* while frozen: pulses taken back that the cursor has passed */
    uint64_t until;         /* while frozen: ordinal of the last pulse that may be laid */
    uint64_t pushed;        /* ordinal of the last pulse of what has been pushed */
    uint64_t turned;        /* ordinal of the last pulse before the last turn; those before it have been made */
    int64_t origin;         /* pulse k after the last turn is at origin + direction*k, steps */
};

/* Stands at position 0. */
void step_channel_init(struct step_channel *channel, unsigned motor);

/* Readies the channel for a move that begins at `tick` with DIR set; the queue is empty. Not while running or frozen.
 */
void step_channel_begin(struct step_channel *channel, uint32_t tick, bool backward);

/* The way of what is pushed from now on. DIR changes between the pulses; they must be so far apart (hal_step.h). */
void step_channel_turn(struct step_channel *channel, bool backward);

/* A queue that gets shorter wakes main with so many free slots, and not before; at first with any. Not while running.
 */
static inline void step_channel_wake_with(struct step_channel *channel, uint8_t room)
{
    channel->wake_room = room;
}

/* Free slots in the queue. */
uint32_t step_channel_room(const struct step_channel *channel);

/* Appends a segment; there must be room. False, and nothing is changed, once the motor brakes or
 * was halted, until the brake is replaced or the next move begins. */
bool step_channel_push(struct step_channel *channel, const struct step_segment *segment);

/* Lays the next pulses, the first of what has been pushed; rests if there is none. Not while running. */
void step_channel_run(struct step_channel *channel);

/* Whether a pulse is still to come. */
bool step_channel_is_running(const struct step_channel *channel);

/* The first pulse of a move after `since`: the next one to come, or, below 25 000 steps/s, the one before,
 * if it came after `since`. False at rest. */
bool step_channel_find_pulse(const struct step_channel *channel, uint32_t since, struct step_cursor *cursor);

/* The pulse at which a change can take effect: the next one, or the first that is due at or after
 * `tick`, which gives the caller time to plan. False if no pulse is left there. */
bool step_channel_look_ahead(const struct step_channel *channel, uint32_t tick, struct step_cursor *cursor);

/* Drops what is queued and brakes, from the pulse `at` on and to the pulse `until` at most: a
 * stopgap that takes effect at once, while the segments after `at` are being planned. `at` comes in
 * as step_channel_find_pulse found it; what is laid after it is taken back. If it is too late for that, `at` goes out
 * as the last pulse that stays. False, and nothing is changed, at rest. */
bool step_channel_brake(struct step_channel *channel, int32_t accel, uint64_t until, struct step_cursor *at);

/* Replaces the stopgap by the first planned segment after `at`. The pulses laid meanwhile are on it
 * already: both brake alike, and it has no fewer pulses. If it is marked, that is reported. */
void step_channel_replace_brake(struct step_channel *channel, const struct step_cursor *at,
                                const struct step_segment *segment);

/* Replaces all that comes after the pulse `at` by `count` new segments. False, and nothing is
 * changed, if it is too late for that, or the motor brakes, or if the queue has no
 * room for so many. */
bool step_channel_replace(struct step_channel *channel, const struct step_cursor *at,
                          const struct step_segment *segments, unsigned count);

/* Takes back what is laid of the last `back` pulses that have been pushed, and lays none of them until
 * step_channel_thaw_held. False, and all goes on, if it is too late, or if the queue has no room for a segment that
 * comes instead. Not while the motor brakes. */
bool step_channel_freeze(struct step_channel *channel, uint64_t back);

/* Drops the last `back` pulses that have been pushed, as they were frozen; `segment` comes instead, which goes backward
 * or not; NULL: none. More may be pushed after it, and none of that is laid before step_channel_thaw_held.
 */
void step_channel_recall(struct step_channel *channel, uint64_t back, const struct step_segment *segment,
                         bool backward);

/* Goes on: as if nothing had been frozen, or with what has been recalled and pushed. While hal_step_hold is in force,
 * so that some channels go on together. */
void step_channel_thaw_held(struct step_channel *channel);

/* Takes back what is laid and ends the move at once, or after the pulse for which it is too late; at rest, drops what
 * is queued. Not while frozen. */
void step_channel_halt(struct step_channel *channel);

/* Pulses made in the present or last move. */
uint64_t step_channel_pulses(const struct step_channel *channel);

/* Absolute position, steps; set only while not running. Read in the tick interrupt, too. `_held`: while hal_step_hold
 * is in force, so that some channels are read at one moment. */
int64_t step_channel_position(const struct step_channel *channel);
int64_t step_channel_position_held(const struct step_channel *channel);
void step_channel_set_position(struct step_channel *channel, int64_t position_steps);

/* The tick of the last pulse; of the start of the move if there was none. Not while running. */
uint32_t step_channel_end_tick(const struct step_channel *channel);

/* Whether a marked segment has begun since the last call: all pulses before it have been made, and its first ones are
 * laid. Main alone. */
bool step_channel_take_mark(struct step_channel *channel);

/* Lays what is due next: what lay_isr of hal_run.h is for one motor. Wakes main where the move has ended, a marked
 * segment has begun, or the queue has got shorter and has room enough. */
unsigned step_channel_lay_isr(struct step_channel *channel, struct hal_step_room *room);

#endif
