#include "hal_run.h"

#include "host_private.h"

void hal_run_start(const struct hal_client *client)
{
    assert(client->lay_isr != NULL && client->tick_isr != NULL && client->plan_isr != NULL);
    host_current()->client = *client;
}

/* Nothing is above it here: main asks only while it does not hold it off. */
void hal_run_plan(void)
{
    struct host_machine *machine = host_current();
    assert(!machine->plan_held);
    machine->client.plan_isr(machine->client.context);
}

void hal_run_hold_plan(void)
{
    struct host_machine *machine = host_current();
    assert(!machine->plan_held);
    machine->plan_held = true;
}

void hal_run_release_plan(void)
{
    struct host_machine *machine = host_current();
    assert(machine->plan_held);
    machine->plan_held = false;
}
