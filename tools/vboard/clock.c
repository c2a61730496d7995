#include "clock.h"

void clock_init(struct clock *clock, uint64_t hz)
{
    *clock = (struct clock){.next = VTIME_NEVER};
    for (unsigned i = 0; i < EVENTS; i++) {
        clock->source[i] = (struct clock_source){.due = VTIME_NEVER, .due_ps = VTIME_NEVER};
    }
    vtime_set_hclk(&clock->time, 0, hz);
}

void clock_attach(struct clock *clock, enum event event, clock_handler *handler, void *model)
{
    clock->source[event].handler = handler;
    clock->source[event].model = model;
}

static void lower_deadline(struct clock *clock, uint64_t cycle)
{
    clock->deadline = cycle < clock->deadline ? cycle : clock->deadline;
}

static void find_next(struct clock *clock)
{
    uint64_t next = VTIME_NEVER;
    for (unsigned i = 0; i < EVENTS; i++) {
        next = clock->source[i].due < next ? clock->source[i].due : next;
    }
    clock->next = next;
    lower_deadline(clock, next);
}

void clock_set(struct clock *clock, enum event event, uint64_t cycle)
{
    struct clock_source *source = &clock->source[event];
    uint64_t before = source->due;
    source->due = cycle;
    source->due_ps = VTIME_NEVER;
    if (cycle <= clock->next) {
        clock->next = cycle;
        lower_deadline(clock, cycle);
    }
    if (before == clock->next && cycle > before) {
        find_next(clock);
    }
}

void clock_set_ps(struct clock *clock, enum event event, uint64_t ps)
{
    clock_set(clock, event, vtime_cycle_of_ps(&clock->time, ps));
    clock->source[event].due_ps = ps;
}

void clock_run(struct clock *clock, uint64_t cycle)
{
    while (clock->next <= cycle) {
        unsigned event = 0;
        while (clock->source[event].due != clock->next) {
            event++;
        }
        uint64_t due = clock->next;
        clock->moment = due;
        clock_set(clock, (enum event)event, VTIME_NEVER);
        clock->source[event].handler(clock->source[event].model, due);
    }
    clock->moment = cycle;
}

void clock_set_hclk(struct clock *clock, uint64_t hz)
{
    vtime_set_hclk(&clock->time, clock->now, hz);
    for (unsigned i = 0; i < EVENTS; i++) {
        struct clock_source *source = &clock->source[i];
        if (source->due_ps != VTIME_NEVER) {
            source->due = vtime_cycle_of_ps(&clock->time, source->due_ps);
        }
    }
    find_next(clock);
}

uint64_t clock_now_ps(const struct clock *clock)
{
    return vtime_ps_of_cycle(&clock->time, clock->now);
}

uint64_t clock_ps_of_cycle(const struct clock *clock, uint64_t cycle)
{
    return vtime_ps_of_cycle(&clock->time, cycle);
}
