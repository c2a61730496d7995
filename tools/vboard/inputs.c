#include "inputs.h"

#include <stdlib.h>
#include <string.h>

#include "complain.h"
#include "infile.h"
#include "line.h"

enum {
    MS_DECIMALS = 9
};

#define MS_MAX (UINT64_C(1000000000) * VTIME_PS_PER_MS)

static int compare(const void *a, const void *b)
{
    const struct input_change *one = a;
    const struct input_change *other = b;
    if (one->ps != other->ps) {
        return one->ps < other->ps ? -1 : 1;
    }
    return one->line < other->line ? -1 : 1;
}

static bool take_comma(const char **at, const char *end)
{
    bool comma = *at != end && **at == ',';
    *at += comma ? 1 : 0;
    while (*at != end && (**at == ' ' || **at == '\t')) {
        (*at)++;
    }
    return comma;
}

static bool is_blank(const char *at, const char *end)
{
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\r')) {
        at++;
    }
    return at == end;
}

/* Reads a line without blanks at its beginning. */
static bool read_line(const char *at, const char *end, struct input_change *change)
{
    uint64_t input = 0;
    uint64_t level = 0;
    bool good = line_read_fixed(&at, end, MS_DECIMALS, MS_MAX, &change->ps) && take_comma(&at, end) &&
                line_read_fixed(&at, end, 0, PINS_INPUTS, &input) && input > 0 && take_comma(&at, end) &&
                line_read_fixed(&at, end, 0, 1, &level);
    change->input = (uint8_t)(input - 1U);
    change->level = level != 0;
    return good && is_blank(at, end);
}

static size_t count_lines(const struct infile *file)
{
    size_t lines = 1;
    for (uint32_t i = 0; i < file->length; i++) {
        lines += file->bytes[i] == '\n' ? 1U : 0U;
    }
    return lines;
}

static bool read_file(struct inputs *inputs, const struct infile *file)
{
    const char *at = (const char *)file->bytes;
    const char *file_end = at + file->length;
    inputs->change = calloc(count_lines(file), sizeof *inputs->change);
    if (inputs->change == NULL) {
        return false;
    }
    for (uint32_t line = 1; at < file_end; line++) {
        const char *end = at + strcspn(at, "\n");
        const char *text_end = at + strcspn(at, "#\n");
        at += strspn(at, " \t\r");
        struct input_change *change = &inputs->change[inputs->changes];
        if (at < text_end) {
            if (!read_line(at, text_end, change)) {
                complain("%s:%u: not a change; write ms,input,level, for example 350.5,3,1", file->path,
                         (unsigned)line);
                return false;
            }
            change->line = line;
            inputs->changes++;
        }
        at = end + 1;
    }
    qsort(inputs->change, inputs->changes, sizeof *inputs->change, compare);
    return true;
}

static void set_signal(struct inputs *inputs, unsigned signal, bool level, uint64_t cycle)
{
    if (pins_is_connected(inputs->wires.pins, signal)) {
        gpio_set_outside(inputs->wires.gpio, inputs->wires.pins->pin[signal], level != inputs->wires.pins->low[signal],
                         cycle);
    }
}

static void plan(struct inputs *inputs)
{
    if (inputs->next < inputs->changes) {
        clock_set_ps(inputs->wires.clock, EVENT_INPUTS, inputs->change[inputs->next].ps);
    }
}

bool inputs_open(struct inputs *inputs, unsigned node, const char *path)
{
    struct infile file;
    for (unsigned i = 0; i < PINS_INPUTS; i++) {
        set_signal(inputs, SIGNAL_INPUT + i, false, 0);
    }
    for (unsigned i = 0; i < PINS_MOTORS; i++) {
        set_signal(inputs, SIGNAL_ENABLE + i, false, 0); /* the pull of a driver; a pin that is an output wins */
    }
    for (unsigned i = 0; i < PINS_SWITCHES; i++) {
        set_signal(inputs, SIGNAL_SWITCH + i, (node - 1U) >> i & 1U, 0);
    }
    if (path == NULL) {
        return true;
    }
    if (!infile_read_text(&file, path)) {
        return false;
    }
    bool good = read_file(inputs, &file);
    infile_discard(&file);
    plan(inputs);
    return good;
}

void inputs_close(struct inputs *inputs)
{
    free(inputs->change);
    inputs->change = NULL;
}

static void on_inputs_event(void *model, uint64_t cycle)
{
    struct inputs *inputs = model;
    const struct input_change *change = &inputs->change[inputs->next++];
    set_signal(inputs, SIGNAL_INPUT + change->input, change->level, cycle);
    plan(inputs);
}

void inputs_init(struct inputs *inputs, struct inputs_wires wires)
{
    inputs->wires = wires;
    clock_attach(wires.clock, EVENT_INPUTS, on_inputs_event, inputs);
}
