#include "hal_run.h"

#include "host_private.h"

void hal_run_start(const struct hal_client *client)
{
    assert(client->step_isr != NULL && client->tick_isr != NULL);
    host_current()->client = *client;
}

void hal_run_hold_tick(void)
{
    struct host_machine *machine = host_current();
    assert(!machine->tick_held);
    machine->tick_held = true;
}

void hal_run_release_tick(void)
{
    struct host_machine *machine = host_current();
    assert(machine->tick_held);
    machine->tick_held = false;
}
