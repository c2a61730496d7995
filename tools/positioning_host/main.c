/*
 * positioning-host: the firmware of the positioning unit on the host backend, for tools/positioning and for tests.
 * Subcommands sim, serve, check; answers are JSON on standard output, complaints one line on standard error
 * (complain.h).
 */
#include <limits.h>

#include "commands.h"
#include "pos_serve.h"
#include "pos_sim.h"

static const char usage[] =
    "usage: positioning-host sim FILE [--inputs FILE] [--for SECONDS]\n"
    "                            [--steps OUT.csv] [--trace OUT.csv] [--vcd OUT.vcd] [--epoch TICKS]\n"
    "                            [--curve OUT.json [--points N] [--from SECONDS] [--to SECONDS]] [--real SECONDS]\n"
    "       positioning-host serve [--help] ...\n"
    "       positioning-host check FILE\n"
    "\n"
    "sim      plays a script (- is standard input) to the simulated unit and prints a summary (JSON)\n"
    "         --inputs FILE   levels of the inputs over time: lines ms,input,level\n"
    "         --for SECONDS   ends after so much of the unit's time if not before (60)\n"
    "         --steps, --trace, --vcd  write pulses, events, waveforms\n"
    "         --curve         writes speeds and positions over time, in at most N points a motor (2000),\n"
    "                         of the whole time or from one moment to another\n"
    "         --real SECONDS  ends after so much real time too\n"
    "         --progress SECONDS  tells so often, in real time, how many ms of unit time are done (standard error)\n"
    "         --epoch TICKS   what the unit's clock shows at the start (0)\n"
    "serve    runs units in real time for whoever connects; serve --help says more\n"
    "check    reads a script (- is standard input)\n"
    "\n"
    "example: positioning-host sim moves.csv --for 2.5 --steps steps.csv\n";

static enum exit_status serve(int count, char *const arguments[])
{
    return count == 1 && commands_is_help(arguments[0]) ? commands_print(pos_serve_usage) : pos_serve(count, arguments);
}

static enum exit_status check(int count, char *const arguments[])
{
    (void)count;
    return pos_sim_check(arguments[0]);
}

static const struct command list[] = {
    {"sim", 0, INT_MAX, pos_sim},
    {"serve", 0, INT_MAX, serve},
    {"check", 1, 1, check},
};

int main(int argc, char *argv[])
{
    static const struct commands all = {
        .program = "positioning-host",
        .usage = usage,
        .hint = "write positioning-host sim FILE, serve, check FILE (- is standard input), or --help",
        .list = list,
        .count = sizeof list / sizeof list[0],
    };
    return commands_main(&all, argc, argv);
}
