#include "sim.h"

#include <stdlib.h>

#include "feed.h"
#include "inputs.h"
#include "rkm04_kind.h"
#include "run.h"
#include "summary.h"
#include "units.h"

/* Too large for the stack. */
struct sim {
    struct run run;
    struct rkm04 unit;
};

/* With everything read and all output files open. The unit gets its programs before its first pass. */
static enum exit_status run_programs(struct sim *sim, struct feed *feed, uint64_t duration_ns)
{
    struct run *run = &sim->run;
    if (!feed_send(feed, &sim->unit)) {
        return EXIT_REFUSED;
    }
    run_until(run, units_ticks_of_ns(duration_ns));
    if (!recorder_finish(&run->recorder, run->machine.now)) {
        return EXIT_REFUSED;
    }
    summary_print(run, &sim->unit, feed);
    return finish_output();
}

static enum exit_status run_with(const struct options *options, struct feed *feed, const struct inputs *inputs)
{
    struct sim *sim = malloc(sizeof *sim);
    if (sim == NULL) {
        complain("there is not memory enough for a unit; close other programs");
        return EXIT_REFUSED;
    }
    enum exit_status status = EXIT_REFUSED;
    struct run *run = &sim->run;
    run_init(run, &rkm04_kind, &sim->unit, options->sim.epoch);
    run_begin(run);
    run->limit_ns = options->sim.real_ns;
    run->progress_ns = options->sim.progress_ns;
    host_machine_set_script(&run->machine, inputs->script, inputs->length);
    if (recorder_open(&run->recorder, &options->sim.paths, &rkm04_kind)) {
        status = run_programs(sim, feed, options->sim.duration_ns);
        recorder_discard(&run->recorder);
    }
    free(sim);
    return status;
}

enum exit_status sim_run(const struct options *options)
{
    struct feed feed;
    struct inputs inputs;
    enum exit_status status = EXIT_REFUSED;
    if (!feed_read(&feed, options->programs)) {
        return status;
    }
    if (inputs_read(&inputs, options->sim.inputs, &rkm04_kind)) {
        status = run_with(options, &feed, &inputs);
        inputs_discard(&inputs);
    }
    feed_discard(&feed);
    return status;
}
