/*
 * The group: the engine's door for motors that move together on a path. It makes one motion at a time, from a stand to
 * a stand, and owns how the motion ends.
 *
 * Comes in: vectors, starts, stops and changes of speed from a unit. Goes out: segments to the step channels of the
 * motors that follow the path's axes. The states are those of an axis (axis_state.h), of all motors together: a motion
 * begins with group_start and is over when group_take_end has said so. What a stop has left of the path stays:
 * group_start goes on with it, group_forget drops it.
 *
 * A change takes effect at a whole step of the longest axis, the first that is due 0.33 ms after it was asked for, if
 * the manner says no other time, or up to 0.2 ms later where many sections get other speeds. Each channel is frozen
 * from there on while the path is planned; where the plan is late, so are the pulses, and the motors are where the path
 * says all the same.
 */
#ifndef GROUP_H
#define GROUP_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base_limits.h"
#include "../axis/axis_cause.h"
#include "../axis/axis_state.h"
#include "../path/path.h"
#include "../step/step_channel.h"

/* Speeds of the sections that wait or move. */
struct group_speeds {
    uint32_t (*of)(const void *context, uint32_t section); /* 1/256 step/s, 1 to PATH_SPEED_MAX; as path_init counts */
    const void *context;
};

/* How a group moves. */
struct group_manner {
    uint32_t start_speed; /* path_set_start_speed */
    uint32_t fault_accel; /* with which a stop for AXIS_CAUSE_FAULT brakes, 1/128 step/s^2, up to PATH_ACCEL_MAX; 0, or
                             where the motion ends before: as other stops. What is left is not to be gone on with.
                             Less than that of a vector: only where no axis turns (path_can_rest) */
    uint32_t lead_ticks;  /* from when a change is asked for until it can take effect, as long as planning takes, which
                             hangs on the axes and where the code lies, up to 0.33 ms; 0: that */
    uint32_t go_on_ticks; /* so much is handed over at once after that; 0: 0.37 ms */
    struct path_kept *before; /* path_set_before; the caller's, who keeps it */
    bool between_steps;       /* in a cruise a change does not wait for a step that is due more than 0.5 ms later; on a
                                 slow ramp it takes one that is due earlier */
};

/*
 * Who may call:
 *   tick interrupt   group_stop_isr
 *   plan interrupt   group_plan_isr
 *   main             everything else
 * The path belongs to main and the plan interrupt, which main holds off by itself where it must (hal_run.h). The step
 * interrupt lays pulses from the channels, which are the caller's.
 */
struct group {
    struct group_manner manner;
    bool speeds_wait;                          /* other speeds are ready, and are to be taken */
    struct step_channel *channel[UNIT_MOTORS]; /* NULL: the motor is not of the group */
    uint8_t axis[UNIT_MOTORS];                 /* of the path, that the motor follows */
    uint8_t motors[PATH_AXES];                 /* that follow the axis: a bit each */
    _Atomic unsigned state;                    /* enum axis_state */
    _Atomic unsigned cause; /* enum axis_cause, of the present or last motion; set once, by what stops it */
    struct path path;
};

/* Stands, without vectors and motors. The ring, `size` places, a power of two and at least 2, is the caller's, who
 * keeps it. */
void group_init(struct group *group, struct path_section *ring, uint32_t size);

/* A motor that has its channel follows an axis of the path, without one (NULL) none; some motors may follow the same
 * axis. Main is not woken for each segment of the channel from then on, but for half of its queue. Only while STANDING,
 * and not where something is left of a path that has moved the axis. */
void group_connect(struct group *group, unsigned motor, struct step_channel *channel, unsigned axis);

/* Only while STANDING, and without vectors. All 0 after group_init; group_forget leaves it. */
void group_set_manner(struct group *group, const struct group_manner *manner);

/* Appends a vector. False if there is no room. A motion in progress takes it along if it can, and needs no stop for
 * it. Vectors in which an axis turns after one without steps on it last hal_step_turn_us at least. */
bool group_add(struct group *group, const struct path_vector *vector);

/* Free places in the ring. */
uint32_t group_room(const struct group *group);

/* Counts of sections: of the one in progress, or from which the path would go on; and after the last one. They begin
 * with 0 at group_init and group_forget. */
uint32_t group_first(const struct group *group);
uint32_t group_end(const struct group *group);

/* Leaves the stand at `start_tick`, the unit's time: begins, or goes on. At least 0.5 ms ahead, so that drivers are on
 * and DIR stands; 0.25 ms where another group has just been started at the same tick, which turns all drivers on. False
 * if no vector is left. Only while STANDING. */
bool group_start(struct group *group, uint64_t start_tick);

/* Stops the motion down its ramp. True if this is why it ends; else nothing happens, as it does not move, or is being
 * stopped already; but a stop for AXIS_CAUSE_FAULT takes the place of another one. */
bool group_stop(struct group *group, enum axis_cause cause);

/* The same in the tick interrupt. True: the plan interrupt is needed. */
bool group_stop_isr(struct group *group, enum axis_cause cause);

/* Takes a stop back: the motion goes on from the first step at which a change can take effect, with the speeds that its
 * sections have. False if there is no stop, or it comes to rest before: to be asked again, or started after the end;
 * and where it is one for AXIS_CAUSE_FAULT, which is not taken back. */
bool group_resume(struct group *group);

/* Plans a stop that was asked for. */
void group_plan_isr(struct group *group);

/* Gives all sections their speeds, from the first one on that waits or moves: at once while the group stands or comes
 * to rest, else as soon as a change can take effect, by group_poll at the latest. `of` is called before this returns.
 * The plan interrupt must not be held off. */
void group_set_speeds(struct group *group, const struct group_speeds *speeds);

/* Hands over segments, for some 0.1 ms, sees sections and the motion end, plans what is left to be planned. Whenever
 * the step interrupt asks for main, and at the tick that it returns at the latest: at once if more waits to be handed
 * over; TICK_NEVER: nothing moves. */
uint64_t group_poll(struct group *group);

/* The motion is over: STANDING from now on. False if it has not ended, or has been taken. */
bool group_take_end(struct group *group);

/* Whether a motion has begun whose end has not been taken. */
static inline bool group_is_busy(const struct group *group)
{
    return (enum axis_state)atomic_load_explicit(&group->state, memory_order_relaxed) != AXIS_STANDING;
}

/* Whether a stop has been accepted and pulses may still come. Also in the tick interrupt. */
static inline bool group_is_stopping(const struct group *group)
{
    enum axis_state state = (enum axis_state)atomic_load_explicit(&group->state, memory_order_relaxed);
    return state == AXIS_BRAKING || state == AXIS_STOPPING;
}

/* Why the present or last motion ends before its end. Also in the tick interrupt. */
static inline enum axis_cause group_cause(const struct group *group)
{
    return (enum axis_cause)atomic_load_explicit(&group->cause, memory_order_relaxed);
}

/* The unit's time at which the path came to rest; of the motion that was taken last. */
uint64_t group_end_tick(const struct group *group);

/* The speed of the path at a whole step of a section (path_speed_at). */
uint32_t group_speed_at(struct group *group, uint32_t section, uint32_t step);

/* Whether something is left of the path, or waits. */
bool group_has_rest(const struct group *group);

/* Drops all that is left and waits. Positions stay what was made. Only while STANDING. */
void group_forget(struct group *group);

#endif
