#include "hal_io.h"

#include "host_private.h"

static void write_outputs(struct host_machine *machine, uint8_t levels)
{
    bool changes = machine->outputs != levels;
    machine->outputs = levels;
    if (changes && machine->listener.output != NULL) {
        machine->listener.output(machine->listener.context, machine->now, levels);
    }
}

static void set_led(struct host_machine *machine, unsigned motor, bool on)
{
    bool changes = machine->led[motor] != on;
    machine->led[motor] = on;
    if (changes && machine->listener.led != NULL) {
        machine->listener.led(machine->listener.context, machine->now, motor, on);
    }
}

void host_io_reset(struct host_machine *machine)
{
    write_outputs(machine, 0);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        set_led(machine, motor, false);
    }
}

uint8_t hal_io_read_inputs(void)
{
    return host_current()->inputs;
}

void hal_io_write_outputs(uint8_t levels)
{
    write_outputs(host_current(), levels);
}

void hal_io_set_led(unsigned motor, bool on)
{
    assert(motor < UNIT_MOTORS);
    set_led(host_current(), motor, on);
}
