#include "serve_line.h"

#include <assert.h>
#include <string.h>

/* Main has a pass after each byte: else bytes that come on the same tick overrun it. */
enum {
    UNPACED_TICKS = 1
};

void serve_line_init(struct serve_line *line, struct serve_port *port, struct serve_turns *turns, uint32_t byte_ticks,
                     const struct serve_options *options)
{
    uint32_t noise = (uint32_t)options->noise;
    uint32_t loss = (uint32_t)options->loss;
    line->heard_count = 0;
    line->byte_ticks = options->unpaced ? UNPACED_TICKS : byte_ticks;
    line->last_tick = 0;
    line->said_count = 0;
    line->said_to = -1;
    line->port = port;
    line->turns = turns;
    serve_noise_init(&line->to_units, noise, loss, options->seed);
    serve_noise_init(&line->to_clients, noise, loss, ~options->seed);
}

uint32_t serve_line_room(struct serve_line *line, uint64_t now)
{
    uint32_t done = 0;
    while (done < line->heard_count && line->heard[done].tick < now) {
        done++;
    }
    line->heard_count -= done;
    memmove(line->heard, line->heard + done, line->heard_count * sizeof line->heard[0]);
    return SERVE_HEARD_MAX - line->heard_count;
}

void serve_line_put(struct serve_line *line, uint64_t now, const uint8_t *bytes, uint32_t count)
{
    assert(count <= SERVE_HEARD_MAX - line->heard_count);
    for (uint32_t i = 0; i < count; i++) {
        uint64_t begin = line->last_tick < now ? now : line->last_tick;
        uint8_t value = bytes[i];
        line->last_tick = begin + line->byte_ticks;
        if (serve_noise_pass(&line->to_units, &value)) {
            line->heard[line->heard_count++] = (struct host_line_byte){.tick = line->last_tick, .value = value};
        }
    }
}

void serve_line_say(struct serve_line *line, uint8_t value, bool resets)
{
    int to = line->turns != NULL ? serve_turns_hear(line->turns, value, resets) : line->said_to;
    if (to != line->said_to) {
        serve_line_flush(line);
        line->said_to = to;
    }
    if (!serve_noise_pass(&line->to_clients, &value)) {
        return;
    }
    if (line->said_count == SERVE_SAID_MAX) {
        serve_line_flush(line);
    }
    line->said[line->said_count++] = value;
}

void serve_line_flush(struct serve_line *line)
{
    if (line->said_count > 0 && line->turns == NULL) {
        serve_port_write_all(line->port, line->said, line->said_count);
    } else if (line->said_count > 0 && line->said_to >= 0) {
        serve_port_write(line->port, (unsigned)line->said_to, line->said, line->said_count);
    } else {
        /* there is nothing, or nobody whom it concerns */
    }
    line->said_count = 0;
}
