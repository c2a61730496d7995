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

static void write_pwm(struct host_machine *machine, uint32_t permille)
{
    bool changes = machine->pwm_permille != permille;
    machine->pwm_permille = permille;
    if (changes && machine->listener.pwm != NULL) {
        machine->listener.pwm(machine->listener.context, machine->now, permille);
    }
}

static void set_led(struct host_machine *machine, unsigned led, bool on)
{
    bool changes = machine->led[led] != on;
    machine->led[led] = on;
    if (changes && machine->listener.led != NULL) {
        machine->listener.led(machine->listener.context, machine->now, led, on);
    }
}

void host_io_reset(struct host_machine *machine)
{
    write_outputs(machine, 0);
    write_pwm(machine, 0);
    for (unsigned led = 0; led < HAL_IO_LEDS; led++) {
        set_led(machine, led, false);
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

void hal_io_write_pwm(uint32_t permille)
{
    assert(permille <= HAL_IO_PWM_MAX);
    write_pwm(host_current(), permille);
}

void hal_io_set_led(unsigned led, bool on)
{
    assert(led < HAL_IO_LEDS);
    set_led(host_current(), led, on);
}
