#include "host_machine.h"

#include <string.h>

#include "base_tick.h"
#include "host_private.h"

enum {
    ERASED = 0xFF
};

struct host_machine *host_selected;

void host_machine_init(struct host_machine *machine, uint64_t epoch)
{
    memset(machine, 0, sizeof *machine);
    machine->epoch = epoch;
    machine->wake = TICK_NEVER;
    machine->sense = TICK_NEVER;
    memset(machine->flash, ERASED, sizeof machine->flash);
    host_machine_set_node(machine, 1);
    host_machine_set_byte_ticks(machine, HOST_LINE_BYTE_TICKS);
    host_step_reset(machine);
    host_io_reset(machine);
    host_line_reset(machine);
}

void host_machine_select(struct host_machine *machine)
{
    host_selected = machine;
}

void host_machine_set_script(struct host_machine *machine, const struct host_input *script, uint32_t length)
{
    for (uint32_t i = 0; i < length; i++) {
        assert(script[i].input >= 1 && script[i].input <= UNIT_INPUTS);
        assert(i == 0 || script[i - 1].tick <= script[i].tick);
    }
    machine->script = script;
    machine->script_length = length;
    machine->script_next = 0;
}

void host_machine_restart(struct host_machine *machine)
{
    machine->client = (struct hal_client){0};
    machine->faults = (struct host_faults){0};
    machine->wake = TICK_NEVER;
    machine->sense = TICK_NEVER;
    machine->step_held = false;
    machine->plan_held = false;
    machine->flash_operations = 0;
    host_step_reset(machine);
    host_io_reset(machine);
    host_line_reset(machine);
}

static uint64_t next_input_tick(const struct host_machine *machine)
{
    if (machine->script_next == machine->script_length) {
        return TICK_NEVER;
    }
    uint64_t tick = machine->script[machine->script_next].tick;
    return tick < machine->now ? machine->now : tick;
}

static uint8_t with_input(uint8_t levels, unsigned input, bool level)
{
    unsigned bit = 1U << (input - 1U);
    return (uint8_t)(level ? levels | bit : levels & ~bit);
}

static void sense_event(struct host_machine *machine)
{
    machine->now = machine->sense;
    machine->sense = TICK_NEVER;
    if (machine->client.tick_isr != NULL) {
        machine->client.tick_isr(machine->client.context, host_unit_time(machine) - machine->faults.late_tick_ticks);
        assert(!machine->step_held);
    }
    host_wake_main(machine, machine->now);
}

static void set_inputs(struct host_machine *machine, uint8_t levels)
{
    if (levels == machine->inputs) {
        return;
    }
    machine->inputs = levels;
    if (machine->listener.input != NULL) {
        machine->listener.input(machine->listener.context, machine->now, levels);
    }
    if (machine->sense == TICK_NEVER) {
        machine->sense = machine->now + machine->faults.late_tick_ticks;
    }
    if (machine->faults.late_tick_ticks == 0) {
        sense_event(machine);
    }
}

static void input_event(struct host_machine *machine, uint64_t tick)
{
    uint8_t levels = machine->inputs;
    machine->now = tick;
    while (machine->script_next < machine->script_length && machine->script[machine->script_next].tick <= tick) {
        const struct host_input *change = &machine->script[machine->script_next++];
        levels = with_input(levels, change->input, change->level);
    }
    set_inputs(machine, levels);
}

void host_machine_set_input(struct host_machine *machine, unsigned input, bool level)
{
    assert(input >= 1 && input <= UNIT_INPUTS);
    host_machine_select(machine);
    set_inputs(machine, with_input(machine->inputs, input, level));
}

static void line_event(struct host_machine *machine)
{
    machine->now = machine->line.next_tick;
    if (host_line_event(machine)) {
        host_wake_main(machine, machine->now);
    }
}

static void main_event(struct host_machine *machine, host_main_pass *pass, void *context)
{
    machine->now = machine->wake;
    uint64_t next = pass(context);
    assert(!machine->step_held && !machine->plan_held);
    if (next == TICK_NEVER) {
        machine->wake = TICK_NEVER;
    } else if (next <= host_unit_time(machine)) {
        machine->wake = machine->now + HOST_PASS_TICKS;
    } else {
        machine->wake = next - machine->epoch;
    }
}

/* What happens next, of what falls on the same tick in this order. */
enum event {
    EVENT_PULSE,
    EVENT_INPUT,
    EVENT_SENSE,
    EVENT_LINE,
    EVENT_MAIN,
    EVENT_NONE
};

static enum event next_event(const struct host_machine *machine, uint64_t pulse, uint64_t input, uint64_t until)
{
    const uint64_t ticks[] = {pulse, input, machine->sense, machine->line.next_tick, machine->wake};
    enum event next = EVENT_NONE;
    uint64_t earliest = until;
    for (unsigned event = EVENT_PULSE; event < EVENT_NONE; event++) {
        if (ticks[event] < earliest) {
            earliest = ticks[event];
            next = (enum event)event;
        }
    }
    return next;
}

void host_machine_run(struct host_machine *machine, uint64_t until, host_main_pass *pass, bool (*done)(void *context),
                      void *context)
{
    host_machine_select(machine);
    machine->wake = machine->now;
    for (bool ended = false; !ended;) {
        unsigned motor = host_step_first(machine);
        uint64_t input = next_input_tick(machine);
        switch (next_event(machine, host_step_next_tick(machine, motor), input, until)) {
        case EVENT_PULSE:
            host_step_event(machine, motor);
            break;
        case EVENT_INPUT:
            input_event(machine, input);
            break;
        case EVENT_SENSE:
            sense_event(machine);
            break;
        case EVENT_LINE:
            line_event(machine);
            break;
        case EVENT_MAIN:
            main_event(machine, pass, context);
            if (done != NULL && done(context)) {
                return;
            }
            break;
        case EVENT_NONE:
            ended = true;
            break;
        }
    }
    if (until != TICK_NEVER && until > machine->now) {
        machine->now = until;
    }
}

void host_machine_wake(struct host_machine *machine, uint64_t tick)
{
    host_wake_main(machine, tick);
}

uint64_t host_machine_next_tick(const struct host_machine *machine)
{
    uint64_t next = host_step_next_tick(machine, host_step_first(machine));
    uint64_t input = next_input_tick(machine);
    next = input < next ? input : next;
    next = machine->sense < next ? machine->sense : next;
    next = machine->line.next_tick < next ? machine->line.next_tick : next;
    return machine->wake < next ? machine->wake : next;
}
