/*
 * What the files of the host backend share. The one mutable thing at file level is the selection.
 */
#ifndef HOST_PRIVATE_H
#define HOST_PRIVATE_H

#include <assert.h>
#include <stddef.h>

#include "host_machine.h"

extern struct host_machine *host_selected;

/* The machine that the hal functions work on. */
static inline struct host_machine *host_current(void)
{
    assert(host_selected != NULL);
    return host_selected;
}

/* The time that hal_time_now gives. */
static inline uint64_t host_unit_time(const struct host_machine *machine)
{
    return machine->epoch + machine->now;
}

static inline void host_wake_main(struct host_machine *machine, uint64_t tick)
{
    machine->wake = tick < machine->wake ? tick : machine->wake;
}

/* As after power-on: nothing armed, pins at 0 and connected, LEDs and outputs off; tells the listener what changes. */
void host_step_reset(struct host_machine *machine);
void host_io_reset(struct host_machine *machine);

/* No byte in the machine, the bus free. */
void host_line_reset(struct host_machine *machine);

/* The motor of which something happens first, and when: an edge, or the interrupt after it; then what happens. */
unsigned host_step_first(const struct host_machine *machine);
uint64_t host_step_next_tick(const struct host_machine *machine, unsigned motor);
void host_step_event(struct host_machine *machine, unsigned motor);

/* What is due at `line.next_tick`, which is now. True: main has something to do. */
bool host_line_event(struct host_machine *machine);

#endif
