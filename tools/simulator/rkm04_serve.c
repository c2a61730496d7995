#include "rkm04_serve.h"

#include "host_machine.h"
#include "rkm04_kind.h"
#include "serve.h"

const char rkm04_serve_usage[] =
    "usage: rkm04-host serve [--tcp PORT | --pty PATH] [--node N ...] [--flash FILE] [--speed X]\n"
    "                        [--unpaced] [--control PORT] [--address ADDRESS] [--noise N] [--loss N] [--seed N]\n"
    "                        [--json] [--until-eof]\n"
    "\n"
    "Units on one line in real time, until Ctrl-C. When ready it prints where it listens.\n"
    "\n"
    "--tcp PORT        listens there (5000); 0 takes any free port\n"
    "--pty PATH        makes a pty and the link PATH to it\n"
    "--node N          a unit of address 1 to 16; may be repeated (1)\n"
    "--flash FILE      keeps stored programs; with several units in FILE.nodeN\n"
    "--speed X         times real time, 0.001 to 1000; 0: as fast as possible (1)\n" SERVE_HELP_OF_ALL
    "\n" SERVE_HELP_OF_NODES "\n"
    "example: rkm04-host serve --node 1 --node 2 --flash units.flash\n";

static const struct serve_kind kind = {
    .unit = &rkm04_kind,
    .tool = "rkm04",
    .order_help = "not understood; write 3=1 or 3=0 for input 3, 2.3=1 for that of unit 2, or ?",
    .flash_mark = "RKM4",
    .byte_ticks = HOST_LINE_BYTE_TICKS,
    .has_nodes = true,
};

enum exit_status rkm04_serve(int count, char *const arguments[])
{
    const struct argument node = ARGUMENT_OTHER_ROW("--node", serve_options_read_node);
    struct serve_options options;
    enum exit_status status = serve_options_read(&options, &node, count, arguments);
    return status == EXIT_DONE ? serve_run(&kind, &options) : status;
}
