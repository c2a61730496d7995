#include "serve_unit.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base_tick.h"
#include "line.h"
#include "units.h"

enum {
    SECONDS_DECIMALS = 3
};

struct serve_unit *serve_unit_make(const struct serve_kind *kind)
{
    struct serve_unit *unit = malloc(sizeof *unit);
    void *of_kind = malloc(kind->unit->bytes);
    if (unit == NULL || of_kind == NULL) {
        free(unit);
        free(of_kind);
        return NULL;
    }
    unit->kind = kind;
    unit->unit = of_kind;
    serve_flash_init(&unit->flash, kind);
    return unit;
}

enum exit_status serve_unit_begin(struct serve_unit *unit, uint8_t node, const char *flash_path)
{
    unit->saved_operations = 0;
    unit->unsaved = false;
    unit->line = NULL;
    memset(unit->travel_steps, 0, sizeof unit->travel_steps);
    host_machine_init(&unit->machine, 0);
    host_machine_select(&unit->machine);
    host_machine_set_node(&unit->machine, node);
    enum exit_status status = serve_flash_open(&unit->flash, &unit->machine, flash_path);
    unit->kind->unit->begin(unit->unit);
    return status;
}

static void hear_step(void *context, uint64_t tick, unsigned motor, bool backward)
{
    struct serve_unit *unit = context;
    (void)tick;
    unit->travel_steps[motor] += backward ? -1 : 1;
}

static void hear_line(void *context, uint64_t tick, uint8_t value)
{
    struct serve_unit *unit = context;
    (void)tick;
    serve_line_say(unit->line, value, unit->kind->asks != NULL && unit->kind->answers_reset(unit->unit));
}

void serve_unit_attach(struct serve_unit *unit, struct serve_line *line)
{
    unit->line = line;
    unit->machine.listener = (struct host_listener){.context = unit, .step = hear_step, .line = hear_line};
}

void serve_unit_run(struct serve_unit *unit, uint64_t until_tick)
{
    host_machine_run(&unit->machine, until_tick, unit->kind->unit->poll, NULL, unit->unit);
}

bool serve_unit_has_work(const struct serve_unit *unit)
{
    const struct unit_kind *kind = unit->kind->unit;
    if (unit->machine.line.next_tick != TICK_NEVER || kind->is_talking(unit->unit)) {
        return true;
    }
    return !kind->is_idle(unit->unit) && host_machine_next_tick(&unit->machine) != TICK_NEVER;
}

static bool write_file(struct serve_unit *unit)
{
    unit->unsaved = !serve_flash_save(&unit->flash, &unit->machine);
    return !unit->unsaved;
}

bool serve_unit_save(struct serve_unit *unit)
{
    if (unit->flash.path == NULL || unit->machine.flash_operations == unit->saved_operations) {
        return true;
    }
    unit->saved_operations = unit->machine.flash_operations;
    return write_file(unit);
}

bool serve_unit_save_rest(struct serve_unit *unit)
{
    return serve_unit_save(unit) && (!unit->unsaved || write_file(unit));
}

typedef char *put_item(const struct serve_unit *unit, unsigned index, char *at);

static char *put_position(const struct serve_unit *unit, unsigned index, char *at)
{
    return line_put_signed(at, unit->kind->unit->position_steps(unit->unit, index));
}

static char *put_travel(const struct serve_unit *unit, unsigned index, char *at)
{
    return line_put_signed(at, unit->travel_steps[index]);
}

static char *put_moving(const struct serve_unit *unit, unsigned index, char *at)
{
    return line_put_string(at, unit->kind->unit->is_moving(unit->unit, index) ? "true" : "false");
}

static char *put_led(const struct serve_unit *unit, unsigned index, char *at)
{
    return line_put_unsigned(at, unit->machine.led[index]);
}

static char *put_input(const struct serve_unit *unit, unsigned index, char *at)
{
    unsigned levels = (unsigned)unit->machine.inputs ^ unit->kind->unit->inputs_turned;
    return line_put_unsigned(at, levels >> index & 1U);
}

static char *put_output(const struct serve_unit *unit, unsigned index, char *at)
{
    return line_put_unsigned(at, unit->machine.outputs >> index & 1U);
}

static char *put_list(const struct serve_unit *unit, const char *name, put_item *put, unsigned count, char *at)
{
    at = line_put_string(at, ", \"");
    at = line_put_string(at, name);
    at = line_put_string(at, "\": [");
    for (unsigned i = 0; i < count; i++) {
        at = i == 0 ? at : line_put_string(at, ", ");
        at = put(unit, i, at);
    }
    return line_put_string(at, "]");
}

static char *put_pwm(const struct serve_unit *unit, char *at)
{
    at = line_put_string(at, ", \"pwm\": ");
    return line_put_unsigned(at, unit->machine.pwm_permille);
}

char *serve_unit_put_status(const struct serve_unit *unit, char *at)
{
    const struct unit_kind *kind = unit->kind->unit;
    if (unit->kind->has_nodes) {
        at = line_put_string(at, "\"node\": ");
        at = line_put_unsigned(at, unit->machine.line.node);
        at = line_put_string(at, ", ");
    }
    at = line_put_string(at, "\"seconds\": ");
    at = line_put_fixed(at, units_ns_of_ticks(unit->machine.now) / 1000000U, SECONDS_DECIMALS);
    at = line_put_string(at, ", \"idle\": ");
    at = line_put_string(at, kind->is_idle(unit->unit) ? "true" : "false");
    at = put_list(unit, "positions", put_position, UNIT_MOTORS, at);
    at = put_list(unit, "travel", put_travel, UNIT_MOTORS, at);
    at = put_list(unit, "moving", put_moving, UNIT_MOTORS, at);
    at = put_list(unit, "leds", put_led, kind->leds != NULL ? HAL_IO_LEDS : UNIT_MOTORS, at);
    at = put_list(unit, "inputs", put_input, UNIT_INPUTS, at);
    at = put_list(unit, "outputs", put_output, UNIT_OUTPUTS, at);
    return kind->has_pwm ? put_pwm(unit, at) : at;
}

void serve_unit_discard(struct serve_unit *unit)
{
    serve_flash_close(&unit->flash);
    free(unit->unit);
    free(unit);
}
