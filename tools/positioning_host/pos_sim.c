#include "pos_sim.h"

#include <assert.h>
#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include "inputs.h"
#include "pos_kind.h"
#include "pos_script.h"
#include "pos_summary.h"
#include "run.h"
#include "sim_options.h"
#include "units.h"

struct options {
    struct sim_options sim;
    const char *path;
};

static_assert(offsetof(struct options, sim) == 0, "the rows of the options of all units count from there");

/* Too large for the stack. */
struct sim {
    struct run run;
    struct pos_unit unit;
    struct pos_script script;
    struct inputs inputs;
};

static const struct argument rows[] = {
    SIM_OPTIONS_ROWS,
};

static const struct argument_table table = {
    .rows = rows,
    .count = sizeof rows / sizeof rows[0],
    .unknown = "no such option of sim; positioning-host --help lists them",
    .missing = "its value is missing; positioning-host --help shows it",
};

static enum exit_status read_options(struct options *options, int count, char *const arguments[])
{
    *options = (struct options){.sim = sim_options_init()};
    if (count == 0) {
        complain("there is no script to play; write positioning-host sim FILE");
        return EXIT_USAGE;
    }
    options->path = arguments[0];
    if (arguments_read(&table, options, count - 1, arguments + 1) != EXIT_DONE) {
        return EXIT_USAGE;
    }
    return sim_options_are_whole(&options->sim) ? EXIT_DONE : EXIT_USAGE;
}

/* The unit is switched on with all files open: they have its start, too. */
static enum exit_status play(struct sim *sim, const struct options *options)
{
    struct run *run = &sim->run;
    run->partner =
        (struct run_partner){.context = &sim->script, .pass = pos_script_pass, .is_over = pos_script_is_over};
    pos_script_play(&sim->script, &run->machine);
    run_begin(run);
    run_until(run, units_ticks_of_ns(options->sim.duration_ns));
    if (!recorder_finish(&run->recorder, run->machine.now)) {
        return EXIT_REFUSED;
    }
    pos_summary_print(run, &sim->script);
    return finish_output();
}

static enum exit_status play_recorded(struct sim *sim, const struct options *options)
{
    struct run *run = &sim->run;
    enum exit_status status = EXIT_REFUSED;
    run_init(run, &pos_kind_of_unit, &sim->unit, options->sim.epoch);
    run->limit_ns = options->sim.real_ns;
    run->progress_ns = options->sim.progress_ns;
    host_machine_set_script(&run->machine, sim->inputs.script, sim->inputs.length);
    if (recorder_open(&run->recorder, &options->sim.paths, &pos_kind_of_unit)) {
        status = play(sim, options);
        recorder_discard(&run->recorder);
    }
    return status;
}

static enum exit_status play_script(struct sim *sim, const struct options *options, const struct infile *file)
{
    enum exit_status status = EXIT_REFUSED;
    if (!pos_script_read(&sim->script, file)) {
        return status;
    }
    if (inputs_read(&sim->inputs, options->sim.inputs, &pos_kind_of_unit)) {
        status = play_recorded(sim, options);
        inputs_discard(&sim->inputs);
    }
    pos_script_play(NULL, NULL);
    pos_script_discard(&sim->script);
    return status;
}

enum exit_status pos_sim(int count, char *const arguments[])
{
    struct options options;
    struct infile file;
    enum exit_status status = read_options(&options, count, arguments);
    if (status != EXIT_DONE) {
        return status;
    }
    if (!infile_read_text(&file, options.path)) {
        return EXIT_REFUSED;
    }
    struct sim *sim = malloc(sizeof *sim);
    if (sim == NULL) {
        complain("there is not memory enough for a unit; close other programs");
        status = EXIT_REFUSED;
    } else {
        status = play_script(sim, &options, &file);
    }
    free(sim);
    infile_discard(&file);
    return status;
}

enum exit_status pos_sim_check(const char *path)
{
    struct infile file;
    struct pos_script script;
    if (!infile_read_text(&file, path)) {
        return EXIT_REFUSED;
    }
    bool good = pos_script_read(&script, &file);
    if (good) {
        (void)printf("{\"lines\":%" PRIu32 "}\n", script.count);
        pos_script_discard(&script);
    }
    infile_discard(&file);
    return good ? finish_output() : EXIT_REFUSED;
}
