/*
 * An axis: what a PLC says to it, by the four instructions and those that are ours, and what it does and shows.
 *
 * Comes in: instructions, the levels of the inputs, settings. Goes out: motion of one motor, records, values. The
 * states are those of unit.md: one at a time, and all bits of the records but MP follow from it.
 */
#ifndef POS_AXIS_H
#define POS_AXIS_H

#include <stdbool.h>
#include <stdint.h>

#include "../drive/pos_drive.h"
#include "../frame/pos_frame.h"
#include "pos_records.h"
#include "pos_watch.h"

#define POS_SPEED_MAX (UINT32_C(200000) * PATH_SPEED_UNITS)

/* In which of them PROG, and in which POL is 1, and what takes which instruction, unit.md has. It brakes from a motion
 * before while the drive is busy and the state is not MOVING. */
enum pos_state {
    POS_FREE,
    POS_TAKEN,
    POS_WAITING, /* a measure has been given, and the axis still brakes */
    POS_READY,   /* it stands and has a measure, not begun or held */
    POS_MOVING,
    POS_REACHED,
    POS_FAULT,
};

enum pos_kind {
    POS_KIND_WAY,
    POS_KIND_POSITION,
    POS_KIND_HOME,
};

/* Methods of homing, as in CiA 402. */
enum pos_method {
    POS_METHOD_POSITIVE = 19, /* to the switch in positive direction */
    POS_METHOD_NEGATIVE = 21,
    POS_METHOD_HERE = 37, /* the present position is the reference */
};

/* A measure that has been given. */
struct pos_order {
    uint32_t method; /* of POS_KIND_HOME */
    int32_t len_um;  /* way, or position */
    uint16_t accel_mm_s2;
    uint8_t kind; /* enum pos_kind */
};

/* What the unit tells an axis of itself. */
struct pos_allowed {
    bool crystal;  /* the crystal runs */
    bool settings; /* the stored settings are not damaged */
};

enum pos_phase {
    POS_PHASE_NONE,
    POS_PHASE_READY,  /* homing: not begun; what comes first is seen when it does */
    POS_PHASE_FIND,   /* to the switch */
    POS_PHASE_LEAVE,  /* off it */
    POS_PHASE_RETURN, /* to where it ends */
};

/*
 * About 2.9 kB. Who may call:
 *   step interrupt   pos_drive_lay_isr of `drive`
 *   plan interrupt   pos_drive_plan_isr of `drive`
 *   tick interrupt   pos_axis_sense_isr
 *   main             everything else
 */
struct pos_axis {
    struct pos_frame frame;
    struct pos_watch watch;
    const uint32_t *settings;           /* values of the axis' registers, by enum pos_axis_register */
    struct pos_control_record own;      /* the bits as they are, but MP */
    struct pos_control_record *control; /* the one in use: MP is taken from it, the other bits are written to it */
    struct pos_order order;
    struct pos_target target;
    uint64_t start_tick;    /* at which the motion that shows in JEDE begins */
    int64_t reference_step; /* where the switch was left */
    int64_t motion_steps;   /* the motor's, where the motion in progress began */
    int64_t captured_step;
    int64_t captured_um;
    uint32_t feed;          /* wanted; 1/65 536 mm/min */
    uint32_t feed_of_speed; /* the last one of which the speed was computed, which takes long, */
    uint32_t speed_of_feed; /* and that speed */
    uint32_t speed;         /* that the drive has, while it moves; 0: it is held */
    uint16_t error;         /* enum pos_error */
    uint16_t captures;
    uint8_t state; /* enum pos_state */
    uint8_t phase; /* enum pos_phase */
    bool negative; /* the direction of the last motion */
    bool waits;    /* a measure that the initiator has not seen */
    bool found;    /* the switch that homing seeks; reference_step is right */
    bool turned;   /* DIR, as the settings had it */
    uint16_t backlash_um;
    struct pos_drive drive;
};

/* Free, at position 0. The values of the settings must live as long. */
void pos_axis_init(struct pos_axis *axis, unsigned motor, const uint32_t *settings);

/* Takes settings that have been written; an input that is active now is no edge. Only while the axis is free and
 * stands. */
void pos_axis_take_settings(struct pos_axis *axis, uint8_t inputs);

/* The instructions. Each returns POS_OK, or why it is refused: then nothing but ERR and ERROR has changed. */
enum pos_error pos_axis_take(struct pos_axis *axis, unsigned space);
enum pos_error pos_axis_order(struct pos_axis *axis, struct pos_control_record *control, const struct pos_order *order,
                              const struct pos_allowed *allowed);
enum pos_error pos_axis_capture(struct pos_axis *axis);
void pos_axis_release(struct pos_axis *axis);

/* POS_CONTROL: the wanted feed, and MP, if `mp` is not POS_MP_NIL. What the state does not take is dropped. */
void pos_axis_control(struct pos_axis *axis, uint32_t feed, int mp);

/* A fault: it brakes and ends the measure; nothing of an axis that is free. */
void pos_axis_fault(struct pos_axis *axis, enum pos_error error);

/* The beginning of a pass: positions, ends, inputs, the initiator of what was given in an earlier pass. Returns when to
 * call again at the latest. */
uint64_t pos_axis_poll(struct pos_axis *axis, uint8_t inputs);

/* The end of a pass, when all instructions of it have come: the wanted speed counts. True: the next pass is to come at
 * once, as more is to be handed over, or the initiator has something to do. */
bool pos_axis_follow(struct pos_axis *axis);

/* Whether it is to leave its stand; and it does, at a tick at least 0.5 ms ahead for the first of those that begin
 * together, unless an input forbids it. */
bool pos_axis_wants_start(const struct pos_axis *axis);
void pos_axis_start(struct pos_axis *axis, uint64_t start_tick, uint8_t inputs);

/* Whether it moves, as JEDE says; and whether pulses may still come. */
bool pos_axis_moves(const struct pos_axis *axis);
bool pos_axis_is_busy(const struct pos_axis *axis);

struct pos_status_record pos_axis_status(const struct pos_axis *axis);
void pos_axis_read(struct pos_axis *axis, uint8_t inputs, struct pos_values *values);

/* Senses the inputs. True: the plan interrupt is needed. */
static inline bool pos_axis_sense_isr(struct pos_axis *axis, uint8_t inputs)
{
    return pos_watch_sense_isr(&axis->watch, &axis->drive, inputs);
}

#endif
