#include "hal_step.h"

#include "base_tick.h"
#include "host_private.h"

/* Sets DIR and the connection of a motor; tells of what changes. */
static void set_pins(struct host_machine *machine, unsigned motor, bool backward, bool connected)
{
    const struct host_listener *listener = &machine->listener;
    bool before = machine->connected[motor] && machine->backward[motor];
    bool after = connected && backward;
    if (machine->connected[motor] != connected && listener->connection != NULL) {
        listener->connection(listener->context, machine->now, motor, connected);
    }
    machine->backward[motor] = backward;
    machine->connected[motor] = connected;
    if (before != after && listener->direction != NULL) {
        listener->direction(listener->context, machine->now, motor, after);
    }
}

void host_step_reset(struct host_machine *machine)
{
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        machine->armed[motor] = TICK_NEVER;
        machine->edge_made[motor] = false;
        set_pins(machine, motor, false, true);
    }
}

void hal_step_arm(unsigned motor, uint32_t tick)
{
    struct host_machine *machine = host_current();
    assert(motor < UNIT_MOTORS);
    assert(machine->armed[motor] == TICK_NEVER);
    int32_t way = tick_difference(tick, (uint32_t)host_unit_time(machine));
    if (way < 0) {
        machine->late_steps++;
        way = 0;
    }
    machine->armed[motor] = machine->now + (uint32_t)way;
}

bool hal_step_disarm(unsigned motor)
{
    struct host_machine *machine = host_current();
    assert(motor < UNIT_MOTORS);
    if (machine->armed[motor] == TICK_NEVER || machine->edge_made[motor]) {
        return false;
    }
    machine->armed[motor] = TICK_NEVER;
    return true;
}

void hal_step_set_direction(unsigned motor, bool backward)
{
    struct host_machine *machine = host_current();
    assert(motor < UNIT_MOTORS);
    assert(machine->armed[motor] == TICK_NEVER);
    set_pins(machine, motor, backward, machine->connected[motor]);
}

void hal_step_connect(unsigned motor, bool connected)
{
    struct host_machine *machine = host_current();
    assert(motor < UNIT_MOTORS);
    assert(machine->armed[motor] == TICK_NEVER);
    set_pins(machine, motor, machine->backward[motor], connected);
}

uint32_t hal_step_lead_ticks(void)
{
    return 0;
}

void hal_step_hold(void)
{
    struct host_machine *machine = host_current();
    assert(!machine->step_held);
    machine->step_held = true;
}

void hal_step_release(void)
{
    struct host_machine *machine = host_current();
    assert(machine->step_held);
    machine->step_held = false;
}
