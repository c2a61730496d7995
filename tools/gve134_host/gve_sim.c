#include "gve_sim.h"

#include <assert.h>
#include <stddef.h>
#include <stdlib.h>

#include "gve134.h"
#include "gve_check.h"
#include "gve_kind.h"
#include "gve_player.h"
#include "gve_summary.h"
#include "inputs.h"
#include "run.h"
#include "sim_options.h"
#include "units.h"

struct options {
    struct sim_options sim;
    const char *path;
    uint64_t baud; /* 0: bytes take no time */
};

static_assert(offsetof(struct options, sim) == 0, "the rows of the options of all units count from there");

/* Too large for the stack. */
struct sim {
    struct run run;
    struct gve134 unit;
    struct gve_player player;
    const struct inputs *inputs;
};

static bool read_baud(void *target, const char *value)
{
    struct options *options = target;
    return gve_read_baud(value, &options->baud);
}

static const struct argument rows[] = {
    SIM_OPTIONS_ROWS,
    ARGUMENT_OTHER_ROW("--baud", read_baud),
};

static const struct argument_table table = {
    .rows = rows,
    .count = sizeof rows / sizeof rows[0],
    .unknown = "no such option of sim; gve134-host --help lists them",
    .missing = "its value is missing; gve134-host --help shows it",
};

static enum exit_status read_options(struct options *options, int count, char *const arguments[])
{
    *options = (struct options){.sim = sim_options_init()};
    if (count == 0) {
        complain("there is no vector file to play; write gve134-host sim FILE");
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
    run->partner = (struct run_partner){
        .context = &sim->player,
        .line = gve_player_hear,
        .pass = gve_player_pass,
        .is_over = gve_player_is_over,
    };
    run_begin(run);
    run_until(run, units_ticks_of_ns(options->sim.duration_ns));
    if (!recorder_finish(&run->recorder, run->machine.now)) {
        return EXIT_REFUSED;
    }
    gve_summary_print(run, &sim->player);
    return finish_output();
}

static enum exit_status play_recorded(struct sim *sim, const struct options *options, const struct infile *file)
{
    struct run *run = &sim->run;
    enum exit_status status = EXIT_REFUSED;
    uint32_t byte_ticks = options->baud != 0 ? gve_byte_ticks(options->baud) : 0;
    run_init(run, &gve_kind_of_unit, &sim->unit, options->sim.epoch);
    run->limit_ns = options->sim.real_ns;
    run->progress_ns = options->sim.progress_ns;
    host_machine_set_byte_ticks(&run->machine, byte_ticks);
    host_machine_set_script(&run->machine, sim->inputs->script, sim->inputs->length);
    if (!gve_player_begin(&sim->player, &run->machine, file, byte_ticks)) {
        return status;
    }
    if (recorder_open(&run->recorder, &options->sim.paths, &gve_kind_of_unit)) {
        status = play(sim, options);
        recorder_discard(&run->recorder);
    }
    gve_player_discard(&sim->player);
    return status;
}

static enum exit_status play_with_inputs(const struct options *options, const struct infile *file)
{
    struct inputs inputs;
    struct sim *sim = malloc(sizeof *sim);
    if (sim == NULL) {
        complain("there is not memory enough for a unit; close other programs");
        return EXIT_REFUSED;
    }
    enum exit_status status = EXIT_REFUSED;
    if (inputs_read(&inputs, options->sim.inputs, &gve_kind_of_unit)) {
        sim->inputs = &inputs;
        status = play_recorded(sim, options, file);
        inputs_discard(&inputs);
    }
    free(sim);
    return status;
}

enum exit_status gve_sim(int count, char *const arguments[])
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
    status = gve_check_is_good(&file) ? play_with_inputs(&options, &file) : EXIT_REFUSED;
    infile_discard(&file);
    return status;
}
