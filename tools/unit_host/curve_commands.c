#include "curve_commands.h"

#include <stdlib.h>

#include "base_tick.h"
#include "line.h"
#include "units.h"

enum {
    NS_PER_US = 1000,
    TIME_DECIMALS = 6,
    ITEM_BYTES_MAX = 96,
};

bool curve_commands_begin(struct curve_commands *commands, uint32_t room)
{
    *commands = (struct curve_commands){.room = room, .cut_tick = TICK_NEVER};
    commands->list = malloc(room * sizeof *commands->list);
    return commands->list != NULL;
}

void curve_commands_put(struct curve_commands *commands, const struct curve_command *command, uint64_t from_tick,
                        uint64_t to_tick)
{
    if (command->tick < from_tick) {
        commands->before = command->ordinal;
    } else if (command->tick <= to_tick && commands->cut_tick == TICK_NEVER) {
        if (commands->count == commands->room) {
            commands->cut_tick = command->tick;
            return;
        }
        commands->list[commands->count++] = *command;
    }
}

static char *put_time(char *at, uint64_t tick)
{
    return line_put_fixed(at, units_ns_of_ticks(tick) / NS_PER_US, TIME_DECIMALS);
}

void curve_commands_write(const struct curve_commands *commands, struct outfile *file)
{
    char *at = line_put_string(outfile_reserve(file, ITEM_BYTES_MAX), ",\"command\":");
    at = line_put_signed(at, commands->before);
    outfile_commit(file, line_put_string(at, ",\"commands\":["));
    for (uint32_t i = 0; i < commands->count; i++) {
        at = line_put_string(outfile_reserve(file, ITEM_BYTES_MAX), i == 0 ? "[" : ",[");
        at = put_time(at, commands->list[i].tick);
        *at++ = ',';
        at = line_put_signed(at, commands->list[i].ordinal);
        *at++ = ']';
        outfile_commit(file, at);
    }
    at = line_put_string(outfile_reserve(file, ITEM_BYTES_MAX), "],\"commands_cut\":");
    bool is_whole = commands->cut_tick == TICK_NEVER;
    outfile_commit(file, is_whole ? line_put_string(at, "null") : put_time(at, commands->cut_tick));
}

void curve_commands_discard(struct curve_commands *commands)
{
    free(commands->list);
    commands->list = NULL;
}
