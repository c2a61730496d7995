#include "sim.h"

#include <stdlib.h>

#include "feed.h"
#include "inputs.h"
#include "run.h"
#include "summary.h"
#include "units.h"

/* With everything read and all output files open. The unit gets its programs before its first pass. */
static enum exit_status run_programs(struct run *run, struct feed *feed, uint64_t duration_ns)
{
    if (!feed_send(feed, &run->unit)) {
        return EXIT_REFUSED;
    }
    run_until(run, units_ticks_of_ns(duration_ns));
    if (!recorder_finish(&run->recorder, run->machine.now)) {
        return EXIT_REFUSED;
    }
    summary_print(run, feed);
    return finish_output();
}

static enum exit_status run_with(const struct options *options, struct feed *feed, const struct inputs *inputs)
{
    struct run *run = malloc(sizeof *run);
    if (run == NULL) {
        complain("there is not memory enough for a unit; close other programs");
        return EXIT_REFUSED;
    }
    enum exit_status status = EXIT_REFUSED;
    run_begin(run, options->epoch);
    run->limit_ns = options->real_ns;
    run->progress_ns = options->progress_ns;
    host_machine_set_script(&run->machine, inputs->script, inputs->length);
    if (recorder_open(&run->recorder, &options->paths)) {
        status = run_programs(run, feed, options->duration_ns);
        recorder_discard(&run->recorder);
    }
    free(run);
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
    if (inputs_read(&inputs, options->inputs)) {
        status = run_with(options, &feed, &inputs);
        inputs_discard(&inputs);
    }
    feed_discard(&feed);
    return status;
}
