#include "gve_serve.h"

#include "gve_kind.h"
#include "serve.h"

const char gve_serve_usage[] =
    "usage: gve134-host serve [--tcp PORT | --pty PATH] [--flash FILE] [--speed X] [--baud N]\n"
    "                         [--unpaced] [--control PORT] [--address ADDRESS] [--noise N] [--loss N] [--seed N]\n"
    "                         [--json] [--until-eof]\n"
    "\n"
    "A unit in real time, until Ctrl-C. When ready it prints where it listens.\n"
    "\n"
    "--tcp PORT        listens there (5000); 0 takes any free port\n"
    "--pty PATH        makes a pty and the link PATH to it\n"
    "--flash FILE      keeps the EEPROM\n"
    "--speed X         times real time, 0.001 to 1000; 0: as fast as possible (1)\n"
    "--baud N          the rate of the line (115200)\n" SERVE_HELP_OF_ALL "\n"
    "Lines on standard input: 3=0 closes input 3 to ground, 3=1 opens it, ? prints the state. Each is\n"
    "answered by a line of JSON. All inputs are open at the start.\n"
    "\n"
    "example: gve134-host serve --flash unit.flash\n";

static bool read_baud(void *target, const char *value)
{
    struct serve_options *options = target;
    return gve_read_baud(value, &options->baud);
}

enum exit_status gve_serve(int count, char *const arguments[])
{
    const struct argument baud = ARGUMENT_OTHER_ROW("--baud", read_baud);
    struct serve_options options;
    struct serve_kind kind = {
        .unit = &gve_kind_of_unit,
        .tool = "gve134",
        .order_help = "not understood; write 3=0 or 3=1 for input 3 (there are 1 to 4, 7 and 8), or ?",
        .flash_mark = "GVE1",
    };
    enum exit_status status = serve_options_read(&options, &baud, count, arguments);
    if (status != EXIT_DONE) {
        return status;
    }
    kind.byte_ticks = gve_byte_ticks(options.baud != 0 ? options.baud : GVE_BAUD);
    return serve_run(&kind, &options);
}
