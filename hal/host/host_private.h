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

/* As after power-on: nothing armed, pins at 0 and connected, LEDs and outputs off; tells the listener what changes. */
void host_step_reset(struct host_machine *machine);
void host_io_reset(struct host_machine *machine);

#endif
