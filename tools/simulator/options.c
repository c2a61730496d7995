#include "options.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "arguments.h"
#include "units.h"

enum {
    SECONDS_DECIMALS = 9
};

/* 31 years. */
#define DURATION_NS_MAX UINT64_C(1000000000000000000)
#define EPOCH_MAX UINT64_C(1000000000000000000)

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

static bool read_duration(void *target, const char *value)
{
    const struct argument_number range = {.decimals = SECONDS_DECIMALS, .least = 1, .most = DURATION_NS_MAX};
    struct options *options = target;
    if (!arguments_read_number(value, range, &options->duration_ns)) {
        complain("--for %s: not a time; write seconds above 0 with up to 9 decimals, as 2.5", value);
        return false;
    }
    return true;
}

static bool read_seconds(const char *name, const char *value, uint64_t *ns)
{
    const struct argument_number range = {.decimals = SECONDS_DECIMALS, .most = DURATION_NS_MAX};
    if (!arguments_read_number(value, range, ns)) {
        complain("%s %s: not a time; write seconds with up to 9 decimals, as 2.5", name, value);
        return false;
    }
    return true;
}

static bool read_from(void *target, const char *value)
{
    struct options *options = target;
    uint64_t ns = 0;
    bool good = read_seconds("--from", value, &ns);
    options->paths.range.from_tick = units_ticks_of_ns(ns);
    return good;
}

static bool read_to(void *target, const char *value)
{
    struct options *options = target;
    uint64_t ns = 0;
    bool good = read_seconds("--to", value, &ns);
    options->paths.range.to_tick = units_ticks_of_ns(ns);
    return good;
}

static bool read_real(void *target, const char *value)
{
    struct options *options = target;
    return read_seconds("--real", value, &options->real_ns);
}

static bool read_progress(void *target, const char *value)
{
    struct options *options = target;
    return read_seconds("--progress", value, &options->progress_ns);
}

static bool read_points(void *target, const char *value)
{
    struct options *options = target;
    const struct argument_number range = {.least = CURVE_POINTS_MIN, .most = CURVE_POINTS_MAX};
    uint64_t points = 0;
    if (!arguments_read_number(value, range, &points)) {
        complain("--points %s: write how many points a curve may have, %d to %d", value, CURVE_POINTS_MIN,
                 CURVE_POINTS_MAX);
        return false;
    }
    options->paths.range.points = (uint32_t)points;
    return true;
}

static bool read_epoch(void *target, const char *value)
{
    struct options *options = target;
    if (!arguments_read_number(value, (struct argument_number){.most = EPOCH_MAX}, &options->epoch)) {
        complain("--epoch %s: not a time; write ticks from 0 to 10^18, as 4294967295", value);
        return false;
    }
    return true;
}

static const struct argument rows[] = {
    ARGUMENT_TEXT_ROW(options, "--inputs", inputs),
    ARGUMENT_TEXT_ROW(options, "--steps", paths.steps),
    ARGUMENT_TEXT_ROW(options, "--trace", paths.trace),
    ARGUMENT_TEXT_ROW(options, "--curve", paths.curve),
    ARGUMENT_TEXT_ROW(options, "--vcd", paths.vcd),
    ARGUMENT_OTHER_ROW("--motor", read_motor),
    ARGUMENT_OTHER_ROW("--for", read_duration),
    ARGUMENT_OTHER_ROW("--epoch", read_epoch),
    ARGUMENT_OTHER_ROW("--real", read_real),
    ARGUMENT_OTHER_ROW("--progress", read_progress),
    ARGUMENT_OTHER_ROW("--points", read_points),
    ARGUMENT_OTHER_ROW("--from", read_from),
    ARGUMENT_OTHER_ROW("--to", read_to),
};

static const struct argument_table table = {
    .rows = rows,
    .count = sizeof rows / sizeof rows[0],
    .unknown = "no such option of sim; rkm04-host --help lists them",
    .missing = "its value is missing; rkm04-host --help shows it",
};

static bool is_same(const char *a, const char *b)
{
    return a != NULL && b != NULL && strcmp(a, b) == 0;
}

static bool paths_differ(const struct recorder_paths *paths)
{
    const char *const all[] = {paths->steps, paths->trace, paths->vcd, paths->curve};
    for (size_t i = 1; i < sizeof all / sizeof all[0]; i++) {
        for (size_t j = 0; j < i; j++) {
            if (is_same(all[i], all[j])) {
                complain("two outputs go to the same file; give --steps, --trace, --vcd and --curve a file each");
                return false;
            }
        }
    }
    return true;
}

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
    *options = (struct options){
        .duration_ns = OPTIONS_DURATION_NS,
        .paths.range = {.points = CURVE_POINTS_DEFAULT, .to_tick = TICK_NEVER},
    };
    if (arguments_read(&table, options, count, arguments) != EXIT_DONE) {
        return EXIT_USAGE;
    }
    return has_program(options) && paths_differ(&options->paths) ? EXIT_DONE : EXIT_USAGE;
}
