#include "hal_line.h"

#include "base_tick.h"
#include "host_private.h"

/* Main is called again when the bytes to be sent have come down to this. */
enum {
    TO_SEND_LOW = HOST_LINE_TO_SEND_MAX / 2
};

static uint64_t script_tick(const struct host_machine *machine)
{
    const struct host_line *line = &machine->line;
    if (line->script_next == line->script_length) {
        return TICK_NEVER;
    }
    uint64_t tick = line->script[line->script_next].tick;
    return tick < machine->now ? machine->now : tick;
}

static void find_next(struct host_machine *machine)
{
    uint64_t script = script_tick(machine);
    machine->line.next_tick = script < machine->line.sent_tick ? script : machine->line.sent_tick;
}

void host_line_reset(struct host_machine *machine)
{
    struct host_line *line = &machine->line;
    line->heard_count = 0;
    line->to_send_count = 0;
    line->refused = false;
    line->sent_tick = TICK_NEVER;
    find_next(machine);
}

void host_machine_set_line(struct host_machine *machine, const struct host_line_byte *script, uint32_t length)
{
    for (uint32_t i = 1; i < length; i++) {
        assert(script[i - 1].tick <= script[i].tick);
    }
    machine->line.script = script;
    machine->line.script_length = length;
    machine->line.script_next = 0;
    find_next(machine);
}

void host_machine_set_byte_ticks(struct host_machine *machine, uint32_t ticks)
{
    machine->line.byte_ticks = ticks;
}

void host_machine_set_node(struct host_machine *machine, uint8_t node)
{
    machine->line.node = node;
}

/* The last place of the ring is the mark of an overrun: it may stand for any number of bytes. */
static void hear(struct host_machine *machine, const struct host_line_byte *byte)
{
    struct host_line *line = &machine->line;
    if (line->heard_count == HOST_LINE_HEARD_MAX) {
        return;
    }
    uint32_t end = (line->heard_first + line->heard_count) % HOST_LINE_HEARD_MAX;
    line->heard[end] = (struct hal_line_byte){
        .tick = host_unit_time(machine),
        .value = byte->value,
        .broken = byte->broken || line->heard_count == HOST_LINE_HEARD_MAX - 1,
    };
    line->heard_count++;
}

/* The byte on the bus has gone. True: main waits for the room. */
static bool finish_byte(struct host_machine *machine)
{
    struct host_line *line = &machine->line;
    uint8_t value = line->to_send[line->to_send_first];
    line->to_send_first = (line->to_send_first + 1U) % HOST_LINE_TO_SEND_MAX;
    line->to_send_count--;
    line->sent_tick = line->to_send_count == 0 ? TICK_NEVER : machine->now + line->byte_ticks;
    if (machine->listener.line != NULL) {
        machine->listener.line(machine->listener.context, machine->now, value);
    }
    if (!line->refused || line->to_send_count > TO_SEND_LOW) {
        return false;
    }
    line->refused = false;
    return true;
}

bool host_line_event(struct host_machine *machine)
{
    struct host_line *line = &machine->line;
    bool wakes = false;
    if (line->sent_tick <= machine->now) {
        wakes = finish_byte(machine);
    }
    if (script_tick(machine) <= machine->now) {
        hear(machine, &line->script[line->script_next++]);
        wakes = true;
    }
    find_next(machine);
    return wakes;
}

bool hal_line_read(struct hal_line_byte *byte)
{
    struct host_line *line = &host_current()->line;
    if (line->heard_count == 0) {
        return false;
    }
    *byte = line->heard[line->heard_first];
    line->heard_first = (line->heard_first + 1U) % HOST_LINE_HEARD_MAX;
    line->heard_count--;
    return true;
}

/* Whether the next byte goes on with a run. */
static bool goes_on(const struct host_line *line, const struct hal_line_run *run, uint8_t last)
{
    const struct hal_line_byte *heard = &line->heard[line->heard_first];
    return line->heard_count != 0 && run->count < (uint32_t)HAL_LINE_RUN_MAX && !run->broken && !heard->broken &&
           heard->tick == run->tick && run->bytes[run->count - 1U] != last;
}

bool hal_line_read_run(struct hal_line_run *run, uint8_t last)
{
    const struct host_line *line = &host_current()->line;
    struct hal_line_byte byte;
    if (!hal_line_read(&byte)) {
        return false;
    }
    run->tick = byte.tick;
    run->count = 1;
    run->bytes[0] = byte.value;
    run->broken = byte.broken;
    while (goes_on(line, run, last)) {
        (void)hal_line_read(&byte);
        run->bytes[run->count++] = byte.value;
    }
    return true;
}

bool hal_line_is_quiet(void)
{
    const struct host_machine *machine = host_current();
    return machine->line.heard_count == 0 && script_tick(machine) - machine->now >= machine->line.byte_ticks;
}

bool hal_line_write(uint8_t byte)
{
    struct host_machine *machine = host_current();
    struct host_line *line = &machine->line;
    if (line->to_send_count == HOST_LINE_TO_SEND_MAX) {
        line->refused = true;
        return false;
    }
    line->to_send[(line->to_send_first + line->to_send_count) % HOST_LINE_TO_SEND_MAX] = byte;
    line->to_send_count++;
    if (line->sent_tick == TICK_NEVER) {
        line->sent_tick = machine->now + line->byte_ticks;
        find_next(machine);
    }
    return true;
}

bool hal_line_is_idle(void)
{
    return host_current()->line.to_send_count == 0;
}

void hal_line_set(uint32_t rate_bd, enum hal_line_format format)
{
    struct host_line *line = &host_current()->line;
    uint32_t bits = format == HAL_LINE_8N1 ? 10U : 11U;
    line->byte_ticks = TICK_HZ / rate_bd * bits;
    line->rate_bd = rate_bd;
    line->format = format;
}

uint8_t hal_line_node(void)
{
    return host_current()->line.node;
}
