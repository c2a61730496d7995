/*
 * What the files of the queue share: gve_queue.c (vectors and motion), gve_queue_stop.c (stops and what follows them),
 * gve_queue_home.c (reference runs).
 */
#ifndef GVE_QUEUE_PRIVATE_H
#define GVE_QUEUE_PRIVATE_H

#include "gve_queue.h"

/* The path in use. */
static inline struct gve_chain *gve_queue_chain(struct gve_queue *queue)
{
    return &queue->chain[atomic_load_explicit(&queue->used, memory_order_relaxed)];
}

static inline const struct gve_chain *gve_queue_chain_of(const struct gve_queue *queue)
{
    return &queue->chain[atomic_load_explicit(&queue->used, memory_order_relaxed)];
}

static inline const struct group *gve_queue_group(const struct gve_queue *queue)
{
    return &gve_queue_chain_of(queue)->group;
}

/* Adds a vector to the path in use; `speed` and `border_speed` as struct path_vector has them. */
void gve_queue_add(struct gve_queue *queue, const struct gve_vector *vector, uint32_t speed, uint32_t border_speed);

/* Leaves the stand as soon as it may; inputs that are active stop it again. */
void gve_queue_start(struct gve_queue *queue, uint8_t inputs);

/* Tells onlookers that the motion in progress has ended at a tick. */
void gve_queue_tell_end(const struct gve_queue *queue, uint64_t tick);

/* Stops what moves; false: nothing does, or it is being stopped. */
bool gve_queue_brake(struct gve_queue *queue, enum axis_cause cause);

/* The motion that has ended was one of a reference run: goes on with the next phase, or sets the result. `stopped`: it
 * was stopped, but not by the switch. */
void gve_home_follow(struct gve_queue *queue, bool stopped, uint8_t inputs);

/* Whether the switch is as the phase wants it: then it stops the motion. */
bool gve_home_sense_isr(struct gve_queue *queue, uint8_t inputs);

/* An interrupt has come. Whether it ends a run that brakes for its switch already; once a phase. */
bool gve_home_end_isr(struct gve_queue *queue);

/* Of the interrupts that are active those that count: the switch of a reference run does not. */
uint16_t gve_home_mask(const struct gve_queue *queue, uint16_t active);

static inline enum gve_home_phase gve_home_phase(const struct gve_queue *queue)
{
    return (enum gve_home_phase)atomic_load_explicit(&queue->home.phase, memory_order_relaxed);
}

#endif
