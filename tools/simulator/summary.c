#include "summary.h"

#include <inttypes.h>
#include <stdio.h>

#include "json.h"
#include "units.h"

enum {
    NS_DECIMALS = 9,
    MILLI_DECIMALS = 3,
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

static void print_seconds(const char *name, uint64_t ns)
{
    (void)printf("\"%s\":", name);
    json_print_fixed(ns, NS_DECIMALS);
    (void)putchar(',');
}

static void print_motor(const struct run *run, const struct rkm04 *unit, const struct feed *feed, unsigned motor)
{
    const struct interpreter *interpreter = &unit->interpreter[motor];
    const struct tally *tally = &run->tally[motor];

    (void)printf("{\"motor\":%u,\"program\":%s,", motor + 1U, feed->programs[motor].path != NULL ? "true" : "false");
    (void)printf("\"moves\":%" PRIu64 ",\"pulses\":%" PRIu64 ",\"position\":%" PRId64 ",\"peak_speed\":", tally->moves,
                 tally->pulses, axis_position_steps(&unit->axis[motor]));
    json_print_fixed(units_milli_speed(tally->shortest_ticks), MILLI_DECIMALS);
    (void)putchar(',');
    print_seconds("seconds_moving",
                  units_ns_of_ticks(tally_moving_ticks(tally, run->machine.now, run->kind->moves_together)));
    (void)printf("\"state\":\"%s\",\"error\":", summary_state_text(interpreter->state));
    json_print_string(interpreter_error_text((enum interpreter_error)interpreter->error));
    (void)printf(",\"place\":%" PRIu32 ",\"held\":%s,\"overflow\":%s}", feed_place(feed, motor, interpreter->place),
                 feed->held[motor] ? "true" : "false", feed->overflow[motor] ? "true" : "false");
}

void summary_print(const struct run *run, const struct rkm04 *unit, const struct feed *feed)
{
    (void)putchar('{');
    print_seconds("seconds", units_ns_of_ticks(run->machine.now));
    (void)printf("\"ticks\":%" PRIu64 ",", run->machine.now);
    print_seconds("real_seconds", run->real_ns);
    (void)printf("\"ratio\":");
    json_print_fixed(run_milli_ratio(run), MILLI_DECIMALS);
    (void)printf(",\"ended\":\"%s\",\"late_steps\":%" PRIu64 ",\n\"motors\":[", run_end_text(run),
                 run->machine.late_steps);
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        (void)fputs(i == 0 ? "\n" : ",\n", stdout);
        print_motor(run, unit, feed, i);
    }
    (void)printf("],\n\"outputs\":%u,\"variables\":%u}\n", (unsigned)unit->io.outputs,
                 (unsigned)unit->shared.variables);
}
