/*
 * The drive of one motor: measures of any length in pulses, on one curve from a stand to a stand, whatever the speed
 * that is wanted on the way.
 *
 * Comes in: measures in pulses and one way, speeds, stops. Goes out: pulses, by a group of one motor (group.h). Between
 * pos_drive_aim and the end of the measure it may stop and go on as often as is wanted: it goes on from the real place
 * at which it stood. About 2.6 kB.
 */
#ifndef POS_DRIVE_H
#define POS_DRIVE_H

#include <stdbool.h>
#include <stdint.h>

#include "../../engine/group/group.h"

enum {
    /* Sections of a path are at most 2^31 - 1 pulses long, and a measure may have 2^40: they follow one another. At the
     * highest rate a section takes three hours. */
    POS_DRIVE_SECTIONS = 4,
};

#define POS_DRIVE_PULSES_MAX (UINT64_C(1) << 41)

/* Units as of path_vector.h. */
struct pos_measure {
    uint64_t pulses;      /* 1 to POS_DRIVE_PULSES_MAX */
    uint32_t accel;       /* 1 to PATH_ACCEL_MAX */
    uint32_t fault_accel; /* with which a fault brakes; 0: the same */
    uint32_t start_speed; /* 0 to PATH_SPEED_MAX */
    bool backward;
};

/*
 * Who may call:
 *   step interrupt   pos_drive_lay_isr
 *   plan interrupt   pos_drive_plan_isr
 *   tick interrupt   pos_drive_stop_isr, pos_drive_steps
 *   main             everything else
 */
struct pos_drive {
    struct pos_measure measure;
    uint64_t to_add;      /* pulses of the measure that are not in the ring yet */
    uint64_t start_tick;  /* of the motion in progress */
    uint64_t wake_tick;   /* the group wants to be polled then, if nothing else comes before */
    int64_t origin_steps; /* where the measure began */
    uint64_t stirred_at;  /* pulses of the measure when it was planned anew last; UINT64_MAX: it has not been */
    uint64_t noted;       /* at the last one of so many the speed has been noted; UINT64_MAX: it has not been */
    uint32_t noted_speed;
    uint32_t speed; /* wanted by all sections */
    uint32_t room;  /* of the channel's queue after the last poll */
    uint8_t motor;
    bool stirred; /* planned anew since the last poll: more is to be handed over soon */
    struct step_channel channel;
    struct path_kept before; /* of the group's path */
    struct path_section ring[POS_DRIVE_SECTIONS];
    struct group group;
};

/* Stands at step 0. */
void pos_drive_init(struct pos_drive *drive, unsigned motor);

/* Takes a measure from where it stands. Only while it does. */
void pos_drive_aim(struct pos_drive *drive, const struct pos_measure *measure);

/* Begins the measure, or goes on with it, with a speed, 1 to PATH_SPEED_MAX. Only while it stands and pulses are left;
 * the tick at least 0.5 ms ahead. */
void pos_drive_start(struct pos_drive *drive, uint32_t speed, uint64_t start_tick);

/* Another speed from the next step on, or at once in a slow cruise. Nothing while it is being stopped. */
void pos_drive_change(struct pos_drive *drive, uint32_t speed);

/* Stops down the ramp: to go on later; or for a fault, also while it is being stopped to go on. */
void pos_drive_hold(struct pos_drive *drive);
void pos_drive_fault(struct pos_drive *drive);

/* A stop from the tick interrupt; the drive is held, and its owner decides what follows. True: the plan interrupt is
 * needed. */
bool pos_drive_stop_isr(struct pos_drive *drive, bool fault);
void pos_drive_plan_isr(struct pos_drive *drive);

/* Goes on while it comes to rest because of pos_drive_hold. False: it is too late, or nothing is to be taken back. */
bool pos_drive_resume(struct pos_drive *drive, uint32_t speed);

/* Whether it has been planned anew since pos_drive_poll, which is to be called at once then. */
static inline bool pos_drive_is_stirred(const struct pos_drive *drive)
{
    return drive->stirred;
}

/* Returns when to call again at the latest. */
uint64_t pos_drive_poll(struct pos_drive *drive);

/* It has come to rest: standing from now on. False if it has not, or that has been told. */
bool pos_drive_take_end(struct pos_drive *drive);

/* The unit's time at which it comes to rest, when that has been planned; also once it counts as standing, as no pulse
 * comes any more. 0 where it has not moved since the measure was aimed. */
static inline uint64_t pos_drive_rest_tick(const struct pos_drive *drive)
{
    return group_end_tick(&drive->group);
}

/* The unit's time at which it came to rest, or of its last pulse, which may be a tick later. */
uint64_t pos_drive_end_tick(const struct pos_drive *drive);

/* Whether a motion has begun whose end has not been taken. */
bool pos_drive_is_busy(const struct pos_drive *drive);

/* Pulses of the measure that have not been made. */
uint64_t pos_drive_left(const struct pos_drive *drive);

/* The step of the motor. Also in the tick interrupt; `_held`: while hal_step_hold is in force. */
int64_t pos_drive_steps(const struct pos_drive *drive);
int64_t pos_drive_steps_held(const struct pos_drive *drive);

/* The speed at the last pulse, 1/256 step/s; 0 at rest. */
uint32_t pos_drive_speed(struct pos_drive *drive);

/* Lays the pulses that are due next (hal_run.h). */
static inline unsigned pos_drive_lay_isr(struct pos_drive *drive, struct hal_step_room *room)
{
    return step_channel_lay_isr(&drive->channel, room);
}

#endif
