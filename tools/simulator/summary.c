#include "summary.h"

#include <inttypes.h>
#include <stdio.h>

#include "json.h"
#include "units.h"

enum {
    NS_DECIMALS = 9,
    MILLI_DECIMALS = 3,
    NS_PER_MILLI_RATIO = 1000,
};

const char *summary_state_text(unsigned state)
{
    static const char *const texts[SUMMARY_STATES] = {
        [INTERPRETER_RUNNING] = "running",     [INTERPRETER_IDLE] = "idle",
        [INTERPRETER_HELD] = "held",           [INTERPRETER_MOVING] = "moving",
        [INTERPRETER_WAIT_TIME] = "wait_time", [INTERPRETER_WAIT_LEVEL] = "wait_level",
        [INTERPRETER_STOPPED] = "stopped",     [INTERPRETER_RESETTING] = "resetting",
        [INTERPRETER_ENDED] = "ended",         [INTERPRETER_FAILED] = "failed",
    };
    return texts[state];
}

uint64_t summary_milli_ratio(const struct run *run)
{
    uint64_t real_us = run->real_ns / NS_PER_MILLI_RATIO;
    return units_ns_of_ticks(run->machine.now) / (real_us == 0 ? 1U : real_us);
}

static void print_seconds(const char *name, uint64_t ns)
{
    (void)printf("\"%s\":", name);
    json_print_fixed(ns, NS_DECIMALS);
    (void)putchar(',');
}

static void print_motor(const struct run *run, const struct feed *feed, unsigned motor)
{
    const struct interpreter *interpreter = &run->unit.interpreter[motor];
    const struct tally *tally = &run->tally[motor];

    (void)printf("{\"motor\":%u,\"program\":%s,", motor + 1U, feed->programs[motor].path != NULL ? "true" : "false");
    (void)printf("\"moves\":%" PRIu64 ",\"pulses\":%" PRIu64 ",\"position\":%" PRId64 ",\"peak_speed\":", tally->moves,
                 tally->pulses, axis_position_steps(&run->unit.axis[motor]));
    json_print_fixed(units_milli_speed(tally->shortest_ticks), MILLI_DECIMALS);
    (void)putchar(',');
    print_seconds("seconds_moving", units_ns_of_ticks(tally_moving_ticks(tally, run->machine.now)));
    (void)printf("\"state\":\"%s\",\"error\":", summary_state_text(interpreter->state));
    json_print_string(interpreter_error_text((enum interpreter_error)interpreter->error));
    (void)printf(",\"place\":%" PRIu32 ",\"overflow\":%s}", feed_place(feed, motor, interpreter->place),
                 feed->overflow[motor] ? "true" : "false");
}

/* What ended it: the programs, the limit of real time, or that of unit time. */
static const char *end_of(const struct run *run)
{
    if (run->idle) {
        return "idle";
    }
    return run->cut ? "real" : "time";
}

void summary_print(const struct run *run, const struct feed *feed)
{
    (void)putchar('{');
    print_seconds("seconds", units_ns_of_ticks(run->machine.now));
    (void)printf("\"ticks\":%" PRIu64 ",", run->machine.now);
    print_seconds("real_seconds", run->real_ns);
    (void)printf("\"ratio\":");
    json_print_fixed(summary_milli_ratio(run), MILLI_DECIMALS);
    (void)printf(",\"ended\":\"%s\",\"late_steps\":%" PRIu64 ",\n\"motors\":[", end_of(run), run->machine.late_steps);
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        (void)fputs(i == 0 ? "\n" : ",\n", stdout);
        print_motor(run, feed, i);
    }
    (void)printf("],\n\"outputs\":%u,\"variables\":%u}\n", (unsigned)run->unit.io.outputs,
                 (unsigned)run->unit.shared.variables);
}
