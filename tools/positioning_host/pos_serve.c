#include "pos_serve.h"

#include "base_tick.h"
#include "pos_kind.h"
#include "serve.h"

/* More than 3.5 characters at 9600 Bd. */
#define SILENCE_TICKS (10U * TICKS_PER_MS)

const char pos_serve_usage[] =
    "usage: positioning-host serve [--tcp PORT | --pty PATH] [--node N ...] [--flash FILE] [--speed X]\n"
    "                              [--unpaced] [--control PORT] [--address ADDRESS] [--noise N] [--loss N]\n"
    "                              [--seed N] [--json] [--until-eof]\n"
    "\n"
    "Units on one line in real time, until Ctrl-C. The line carries Modbus RTU; bytes take their time as the\n"
    "stored settings of the units say. When ready it prints where it listens.\n"
    "\n"
    "--tcp PORT        listens there (5000), for the bytes of RTU; 0 takes any free port\n"
    "--pty PATH        makes a pty and the link PATH to it\n"
    "--node N          a unit of address 1 to 16; may be repeated (1)\n"
    "--flash FILE      keeps stored settings; with several units in FILE.nodeN\n"
    "--speed X         times real time, 0.001 to 1000; 0: as fast as possible (1)\n" SERVE_HELP_OF_ALL
    "\n" SERVE_HELP_OF_NODES "\n"
    "example: positioning-host serve --pty /tmp/unit --flash unit.flash\n";

static const struct serve_kind kind = {
    .unit = &pos_kind_of_unit,
    .tool = "positioning",
    .order_help = "not understood; write 3=1 or 3=0 for input 3, 2.3=1 for that of unit 2, or ?",
    .flash_mark = "POS4",
    .silence_ticks = SILENCE_TICKS,
    .has_nodes = true,
};

enum exit_status pos_serve(int count, char *const arguments[])
{
    const struct argument node = ARGUMENT_OTHER_ROW("--node", serve_options_read_node);
    struct serve_options options;
    enum exit_status status = serve_options_read(&options, &node, count, arguments);
    return status == EXIT_DONE ? serve_run(&kind, &options) : status;
}
