#include "options.h"

#include <assert.h>
#include <stdbool.h>
#include <stddef.h>

#include "arguments.h"

static_assert(offsetof(struct options, sim) == 0, "the rows of the options of all units count from there");

const char options_usage[] =
    "usage: rkm04-host sim --motor N=FILE ... [--inputs FILE] [--for SECONDS]\n"
    "                      [--steps OUT.csv] [--trace OUT.csv] [--vcd OUT.vcd] [--epoch TICKS]\n"
    "                      [--curve OUT.json [--points N] [--from SECONDS] [--to SECONDS]] [--real SECONDS]\n"
    "       rkm04-host serve [--help] ...\n"
    "       rkm04-host check FILE\n"
    "       rkm04-host opcodes\n"
    "       rkm04-host bench\n"
    "\n"
    "sim      runs programs on the simulated unit and prints a summary (JSON)\n"
    "         --motor N=FILE  the program of motor 1 to 4 (UTF-8); once per motor\n"
    "         --inputs FILE   levels of the inputs over time: lines ms,input,level\n"
    "         --for SECONDS   ends after so much of the unit's time if not before (60)\n"
    "         --steps, --trace, --vcd  write pulses, events, waveforms\n"
    "         --curve         writes speeds and positions over time, in at most N points a motor (2000),\n"
    "                         of the whole time or from one moment to another\n"
    "         --real SECONDS  ends after so much real time too\n"
    "         --progress SECONDS  tells so often, in real time, how many ms of unit time are done (standard error)\n"
    "         --epoch TICKS   what the unit's clock shows at the start (0)\n"
    "serve    runs units in real time for whoever connects; serve --help says more\n"
    "check    parses a program (- is standard input) and prints commands and errors (JSON)\n"
    "opcodes  prints the tables of the language and of the files (JSON)\n"
    "bench    measures the step generator and the simulation (JSON)\n"
    "\n"
    "example: rkm04-host sim --motor 1=loop.rks --for 2.5 --steps steps.csv\n";

static bool read_motor(void *target, const char *value)
{
    struct options *options = target;
    if (value[0] < '1' || value[0] > '0' + UNIT_MOTORS || value[1] != '=' || value[2] == '\0') {
        complain("--motor %s: not a motor and its program; write 1= to 4= and a file, as 1=loop.rks", value);
        return false;
    }
    const char **program = &options->programs[value[0] - '1'];
    if (*program != NULL) {
        complain("--motor %s: motor %c has a program already; give each motor one", value, value[0]);
        return false;
    }
    *program = value + 2;
    return true;
}

static const struct argument rows[] = {
    SIM_OPTIONS_ROWS,
    ARGUMENT_OTHER_ROW("--motor", read_motor),
};

static const struct argument_table table = {
    .rows = rows,
    .count = sizeof rows / sizeof rows[0],
    .unknown = "no such option of sim; rkm04-host --help lists them",
    .missing = "its value is missing; rkm04-host --help shows it",
};

static bool has_program(const struct options *options)
{
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        if (options->programs[i] != NULL) {
            return true;
        }
    }
    complain("there is no program to run; give one with --motor 1=FILE");
    return false;
}

enum exit_status options_read(struct options *options, int count, char *const arguments[])
{
    *options = (struct options){.sim = sim_options_init()};
    if (arguments_read(&table, options, count, arguments) != EXIT_DONE) {
        return EXIT_USAGE;
    }
    return has_program(options) && sim_options_are_whole(&options->sim) ? EXIT_DONE : EXIT_USAGE;
}
