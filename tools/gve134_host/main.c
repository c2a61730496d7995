/*
 * gve134-host: the firmware of the GVE134 unit on the host backend, for tools/gve134 and for tests. Subcommands sim,
 * serve, check, plan and commands; answers are JSON on standard output, complaints one line on standard error
 * (complain.h).
 */
#include <limits.h>

#include "commands.h"
#include "gve_check.h"
#include "gve_plan.h"
#include "gve_serve.h"
#include "gve_sim.h"

static const char usage[] =
    "usage: gve134-host sim FILE [--inputs FILE] [--for SECONDS] [--baud N]\n"
    "                       [--steps OUT.csv] [--trace OUT.csv] [--vcd OUT.vcd] [--epoch TICKS]\n"
    "                       [--curve OUT.json [--points N] [--from SECONDS] [--to SECONDS]] [--real SECONDS]\n"
    "       gve134-host serve [--help] ...\n"
    "       gve134-host check FILE\n"
    "       gve134-host plan X Y Z [COURSE] <FILE\n"
    "       gve134-host commands\n"
    "\n"
    "sim      plays a vector file (- is standard input) to the simulated unit and prints a summary (JSON)\n"
    "         --inputs FILE   levels of the inputs over time, as ports read them: lines ms,input,level\n"
    "         --for SECONDS   ends after so much of the unit's time if not before (60)\n"
    "         --baud N        bytes take the time that they take at this rate, else none\n"
    "         --steps, --trace, --vcd  write pulses, events, waveforms\n"
    "         --curve         writes speeds and positions over time, in at most N points a motor (2000),\n"
    "                         of the whole time or from one moment to another\n"
    "         --real SECONDS  ends after so much real time too\n"
    "         --progress SECONDS  tells so often, in real time, how many ms of unit time are done (standard error)\n"
    "         --epoch TICKS   what the unit's clock shows at the start (0)\n"
    "serve    runs a unit in real time for whoever connects; serve --help says more\n"
    "check    parses a vector file (- is standard input) and prints what the unit would refuse (JSON)\n"
    "plan     tells how long vectors take and how fast they become, without a pulse (JSON); X, Y, Z: pulses a mm\n"
    "commands prints the table of the commands (JSON)\n"
    "\n"
    "example: gve134-host sim part.gve --for 2.5 --steps steps.csv\n";

static enum exit_status serve(int count, char *const arguments[])
{
    return count == 1 && commands_is_help(arguments[0]) ? commands_print(gve_serve_usage) : gve_serve(count, arguments);
}

static enum exit_status check(int count, char *const arguments[])
{
    (void)count;
    return gve_check_file(arguments[0]);
}

static enum exit_status plan(int count, char *const arguments[])
{
    return gve_plan_input(arguments, count > GVE_PLAN_SCALES ? arguments[GVE_PLAN_SCALES] : NULL);
}

static enum exit_status commands(int count, char *const arguments[])
{
    (void)count;
    (void)arguments;
    return gve_check_commands();
}

static const struct command list[] = {
    {"sim", 0, INT_MAX, gve_sim}, {"serve", 0, INT_MAX, serve},
    {"check", 1, 1, check},       {"plan", GVE_PLAN_SCALES, GVE_PLAN_SCALES + 1, plan},
    {"commands", 0, 0, commands},
};

int main(int argc, char *argv[])
{
    static const struct commands all = {
        .program = "gve134-host",
        .usage = usage,
        .hint = "write gve134-host sim, serve, check FILE (- is standard input), plan X Y Z, commands, or --help",
        .list = list,
        .count = sizeof list / sizeof list[0],
    };
    return commands_main(&all, argc, argv);
}
