#include "gve_script.h"

#include <assert.h>
#include <stdlib.h>

#include "base_tick.h"
#include "complain.h"
#include "gve_command.h"
#include "units.h"

static void read_command(struct gve_script_line *line)
{
    if (line->line.probes) {
        line->opcode = GVE_OPCODES;
        return;
    }
    struct gve_reading reading =
        gve_command_read(line->line.text, line->line.length, (enum gve_address)line->line.address);
    assert(reading.fault == GVE_FAULT_NONE);
    line->opcode = reading.command.opcode;
}

/* Finds the next line of either sort. */
static bool find_line(struct gve_script_place *place, bool timed, struct gve_script_line *line)
{
    while (gve_file_next(&place->file, &place->line)) {
        if (place->line.timed == timed) {
            line->line = place->line;
            line->tick = units_ticks_of_ns(place->line.ns);
            read_command(line);
            return true;
        }
    }
    return false;
}

static uint32_t count_timed(struct gve_script_place place)
{
    struct gve_script_line line;
    uint32_t count = 0;
    while (find_line(&place, true, &line)) {
        count++;
    }
    return count;
}

static int compare(const void *a, const void *b)
{
    const struct gve_script_line *one = a;
    const struct gve_script_line *other = b;
    if (one->tick != other->tick) {
        return one->tick < other->tick ? -1 : 1;
    }
    return one->line.number < other->line.number ? -1 : 1;
}

bool gve_script_begin(struct gve_script *script, const struct infile *file)
{
    *script = (struct gve_script){.place.file = gve_file_of(file)};
    struct gve_script_place place = script->place;
    uint32_t count = count_timed(place);
    script->timed = calloc((size_t)count + 1U, sizeof *script->timed);
    if (script->timed == NULL) {
        complain("%s: there is not memory enough for so many lines; make the file shorter", file->path);
        return false;
    }
    while (find_line(&place, true, &script->timed[script->timed_count])) {
        script->timed_count++;
    }
    qsort(script->timed, script->timed_count, sizeof *script->timed, compare);
    return true;
}

bool gve_script_next(struct gve_script *script, struct gve_script_line *line)
{
    return find_line(&script->place, false, line);
}

bool gve_script_probes_next(const struct gve_script *script)
{
    struct gve_script_place place = script->place;
    struct gve_script_line line;
    return find_line(&place, false, &line) && line.line.probes;
}

uint64_t gve_script_timed_tick(const struct gve_script *script)
{
    return script->timed_taken == script->timed_count ? TICK_NEVER : script->timed[script->timed_taken].tick;
}

void gve_script_take_timed(struct gve_script *script, struct gve_script_line *line)
{
    *line = script->timed[script->timed_taken++];
}

/* There is room where it was taken from. */
void gve_script_put_back(struct gve_script *script, const struct gve_script_line *line)
{
    uint32_t at = --script->timed_taken;
    while (at + 1U < script->timed_count && script->timed[at + 1U].tick <= line->tick) {
        script->timed[at] = script->timed[at + 1U];
        at++;
    }
    script->timed[at] = *line;
}

void gve_script_discard(struct gve_script *script)
{
    free(script->timed);
    script->timed = NULL;
}
