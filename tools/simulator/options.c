#include "options.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "line.h"
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
    "         --motor N=FILE  the program of motor 1 to 4, as the line carries it; once per motor\n"
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

static bool read_motor(struct options *options, const char *value)
{
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

static bool read_number(const char *value, unsigned decimals, uint64_t max, uint64_t *number)
{
    const char *at = value;
    const char *end = value + strlen(value);
    return line_read_fixed(&at, end, decimals, max, number) && at == end;
}

static bool read_duration(struct options *options, const char *value)
{
    if (!read_number(value, SECONDS_DECIMALS, DURATION_NS_MAX, &options->duration_ns) || options->duration_ns == 0) {
        complain("--for %s: not a time; write seconds above 0 with up to 9 decimals, as 2.5", value);
        return false;
    }
    return true;
}

static bool read_seconds(const char *name, const char *value, uint64_t *ns)
{
    if (!read_number(value, SECONDS_DECIMALS, DURATION_NS_MAX, ns)) {
        complain("%s %s: not a time; write seconds with up to 9 decimals, as 2.5", name, value);
        return false;
    }
    return true;
}

static bool read_from(struct options *options, const char *value)
{
    uint64_t ns = 0;
    bool good = read_seconds("--from", value, &ns);
    options->paths.range.from_tick = units_ticks_of_ns(ns);
    return good;
}

static bool read_to(struct options *options, const char *value)
{
    uint64_t ns = 0;
    bool good = read_seconds("--to", value, &ns);
    options->paths.range.to_tick = units_ticks_of_ns(ns);
    return good;
}

static bool read_real(struct options *options, const char *value)
{
    return read_seconds("--real", value, &options->real_ns);
}

static bool read_progress(struct options *options, const char *value)
{
    return read_seconds("--progress", value, &options->progress_ns);
}

static bool read_points(struct options *options, const char *value)
{
    uint64_t points = 0;
    if (!read_number(value, 0, CURVE_POINTS_MAX, &points) || points < CURVE_POINTS_MIN) {
        complain("--points %s: write how many points a curve may have, %d to %d", value, CURVE_POINTS_MIN,
                 CURVE_POINTS_MAX);
        return false;
    }
    options->paths.range.points = (uint32_t)points;
    return true;
}

static bool read_epoch(struct options *options, const char *value)
{
    if (!read_number(value, 0, EPOCH_MAX, &options->epoch)) {
        complain("--epoch %s: not a time; write ticks from 0 to 10^18, as 4294967295", value);
        return false;
    }
    return true;
}

/* The option that is a path only; null if there is none of this name. */
static const char **find_path(struct options *options, const char *name)
{
    if (strcmp(name, "--inputs") == 0) {
        return &options->inputs;
    }
    if (strcmp(name, "--steps") == 0) {
        return &options->paths.steps;
    }
    if (strcmp(name, "--trace") == 0) {
        return &options->paths.trace;
    }
    if (strcmp(name, "--curve") == 0) {
        return &options->paths.curve;
    }
    return strcmp(name, "--vcd") == 0 ? &options->paths.vcd : NULL;
}

typedef bool read_option(struct options *options, const char *value);

static read_option *find_reader(const char *name)
{
    static const struct {
        const char *name;
        read_option *read;
    } readers[] = {
        {"--motor", read_motor},       {"--for", read_duration},  {"--epoch", read_epoch}, {"--real", read_real},
        {"--progress", read_progress}, {"--points", read_points}, {"--from", read_from},   {"--to", read_to},
    };
    for (size_t i = 0; i < sizeof readers / sizeof readers[0]; i++) {
        if (strcmp(name, readers[i].name) == 0) {
            return readers[i].read;
        }
    }
    return NULL;
}

static bool read_pair(struct options *options, const char *name, const char *value)
{
    const char **path = find_path(options, name);
    read_option *reader = find_reader(name);
    if (path == NULL && reader == NULL) {
        complain("%s: no such option of sim; rkm04-host --help lists them", name);
        return false;
    }
    if (value == NULL || value[0] == '\0') {
        complain("%s: its value is missing; rkm04-host --help shows it", name);
        return false;
    }
    if (path != NULL) {
        *path = value;
        return true;
    }
    return reader(options, value);
}

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
    for (int i = 0; i < count; i += 2) {
        if (!read_pair(options, arguments[i], i + 1 < count ? arguments[i + 1] : NULL)) {
            return EXIT_USAGE;
        }
    }
    return has_program(options) && paths_differ(&options->paths) ? EXIT_DONE : EXIT_USAGE;
}
