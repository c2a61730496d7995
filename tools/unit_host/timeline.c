#include "timeline.h"

#include <assert.h>
#include <stdbool.h>
#include <stddef.h>

static_assert((TIMELINE_EVENTS_MAX & (TIMELINE_EVENTS_MAX - 1)) == 0, "the ring's counters wrap with its size");

static struct timeline_event *timeline_slot(struct timeline *timeline, uint32_t count)
{
    return &timeline->ring[count % TIMELINE_EVENTS_MAX];
}

void timeline_init(struct timeline *timeline, timeline_deliver *deliver, void *context)
{
    timeline->head = 0;
    timeline->tail = 0;
    timeline->deliver = deliver;
    timeline->context = context;
}

static void deliver_first(struct timeline *timeline)
{
    timeline->deliver(timeline->context, timeline_slot(timeline, timeline->tail));
    timeline->tail++;
}

/* Events come nearly sorted, so the place is mostly the last or the last but a few. */
static void insert(struct timeline *timeline, const struct timeline_event *event)
{
    uint32_t at = timeline->head;
    while (at != timeline->tail && timeline_slot(timeline, at - 1U)->tick > event->tick) {
        *timeline_slot(timeline, at) = *timeline_slot(timeline, at - 1U);
        at--;
    }
    *timeline_slot(timeline, at) = *event;
    timeline->head++;
}

void timeline_put(struct timeline *timeline, const struct timeline_event *event, uint64_t now_ticks)
{
    if (timeline->head - timeline->tail == TIMELINE_EVENTS_MAX) {
        deliver_first(timeline);
    }
    insert(timeline, event);
    while (timeline->tail != timeline->head &&
           timeline_slot(timeline, timeline->tail)->tick + TIMELINE_WINDOW_TICKS <= now_ticks) {
        deliver_first(timeline);
    }
}

void timeline_flush(struct timeline *timeline)
{
    while (timeline->tail != timeline->head) {
        deliver_first(timeline);
    }
}
