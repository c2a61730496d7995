/*
 * What the files of the axis share: axis.c (from an order to its last pulse), axis_stop.c (whatever ends it early).
 */
#ifndef AXIS_PRIVATE_H
#define AXIS_PRIVATE_H

#include "axis.h"

/* Goes to the state that an event leads to. False if the event means nothing now, also because another context was
 * first. Any context but the step interrupt. */
bool axis_enter(struct axis *axis, enum axis_event event);

/* Plans the next segment and queues it, which takes a Cortex-M4 about 16 us. False if there is none, no room for it
 * now, or a stop that makes it void. Main or plan interrupt. */
bool axis_feed_segment(struct axis *axis);

/* Why the inputs, as sensed last, forbid or end a motion. */
enum axis_cause axis_guarded_cause(const struct axis *axis);

/* Stops at a tick, the unit's time: the first pulse after it is the one from which the motor brakes. False if the
 * motion does not go on, or is being stopped already. */
bool axis_stop_since(struct axis *axis, enum axis_cause cause, uint64_t since);

/* Sets the cause and tells the trace of it. The state has been entered before, so only one context comes here. */
void axis_set_cause(struct axis *axis, enum axis_cause cause, uint64_t tick);

#endif
