/*
 * positioning-host: the firmware of the positioning unit on the host backend, for tools/positioning and for tests.
 * Subcommands sim, serve, check; answers are JSON on standard output, complaints one line on standard error
 * (complain.h).
 */
#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "complain.h"
#include "parent.h"
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

static bool is_help(const char *argument)
{
    return strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0;
}

static enum exit_status print_text(const char *text)
{
    (void)fputs(text, stdout);
    return finish_output();
}

static enum exit_status serve(int count, char *const arguments[])
{
    return count == 1 && is_help(arguments[0]) ? print_text(pos_serve_usage) : pos_serve(count, arguments);
}

static enum exit_status check(int count, char *const arguments[])
{
    (void)count;
    return pos_sim_check(arguments[0]);
}

static enum exit_status help(int count, char *const arguments[])
{
    (void)count;
    (void)arguments;
    return print_text(usage);
}

static const struct command {
    const char *name;
    int least; /* arguments after it */
    int most;
    enum exit_status (*run)(int count, char *const arguments[]);
} list[] = {
    {"sim", 0, INT_MAX, pos_sim}, {"serve", 0, INT_MAX, serve}, {"check", 1, 1, check},
    {"--help", 0, INT_MAX, help}, {"-h", 0, INT_MAX, help},
};

static enum exit_status run_command(const char *name, int count, char *const arguments[])
{
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++) {
        if (strcmp(name, list[i].name) == 0 && count >= list[i].least && count <= list[i].most) {
            return list[i].run(count, arguments);
        }
    }
    complain("write positioning-host sim FILE, serve, check FILE (- is standard input), or --help");
    return EXIT_USAGE;
}

int main(int argc, char *argv[])
{
    parent_bind();
    complain_as(argc > 0 ? argv[0] : "positioning-host");
    return (int)run_command(argc > 1 ? argv[1] : "", argc - 2, argv + 2);
}
