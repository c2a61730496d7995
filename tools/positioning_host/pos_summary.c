#include "pos_summary.h"

#include <inttypes.h>
#include <stdio.h>

#include "json.h"
#include "units.h"

enum {
    NS_DECIMALS = 9,
    MILLI_DECIMALS = 3,
};

static void print_seconds(const char *name, uint64_t ns)
{
    (void)printf("\"%s\":", name);
    json_print_fixed(ns, NS_DECIMALS);
}

static void print_times(const struct run *run)
{
    print_seconds("seconds", units_ns_of_ticks(run->machine.now));
    (void)printf(",\"ticks\":%" PRIu64 ",", run->machine.now);
    print_seconds("real_seconds", run->real_ns);
    (void)printf(",\"ratio\":");
    json_print_fixed(run_milli_ratio(run), MILLI_DECIMALS);
    (void)printf(",\"ended\":\"%s\",\"late_steps\":%" PRIu64 ",\n", run_end_text(run), run->machine.late_steps);
}

static void print_shown(const struct pos_values *values)
{
    (void)printf("\"status\":%u,\"error\":%u,\"flags\":%u,\"captures\":%u,\"position_um\":%" PRId32
                 ",\"way_left_um\":%" PRId32 ",\"speed\":%" PRIu32 ",\"position_steps\":%" PRId32
                 ",\"captured_um\":%" PRId32 ",\"captured_steps\":%" PRId32,
                 (unsigned)values->status.status1 << 8U | values->status.status2, (unsigned)values->error,
                 (unsigned)values->flags, (unsigned)values->captures, values->position_um, values->way_left_um,
                 values->speed, values->position_steps, values->captured_um, values->captured_steps);
}

static void print_axis(const struct run *run, unsigned motor)
{
    struct pos_values values;
    const struct tally *tally = &run->tally[motor];
    pos_read(run->unit, motor + 1U, &values);
    (void)printf("{\"axis\":%u,\"moves\":%" PRIu64 ",\"pulses\":%" PRIu64 ",\"position\":%" PRId64 ",\"peak_speed\":",
                 motor + 1U, tally->moves, tally->pulses, run->kind->position_steps(run->unit, motor));
    json_print_fixed(units_milli_speed(tally->shortest_ticks), MILLI_DECIMALS);
    (void)printf(",\"seconds_moving\":");
    json_print_fixed(units_ns_of_ticks(tally_moving_ticks(tally, run->machine.now, run->kind->moves_together)),
                     NS_DECIMALS);
    (void)putchar(',');
    print_shown(&values);
    (void)putchar('}');
}

static void print_line(const struct pos_script_line *line)
{
    (void)printf("{\"line\":%" PRIu32 ",\"axis\":%u,\"instruction\":\"%s\",\"result\":%u,\"tick\":%" PRIu64,
                 line->number, (unsigned)line->axis, pos_script_word((enum pos_script_kind)line->kind), line->result,
                 line->done_tick);
    if (line->kind == POS_SCRIPT_READ) {
        (void)putchar(',');
        print_shown(&line->read);
    }
    (void)putchar('}');
}

/* Lines that were refused, and what READ has kept. */
static void print_lines(const struct pos_script *script)
{
    const char *before = "\n";
    for (uint32_t i = 0; i < script->next; i++) {
        const struct pos_script_line *line = &script->lines[i];
        if (line->result != 0 || line->kind == POS_SCRIPT_READ) {
            (void)fputs(before, stdout);
            print_line(line);
            before = ",\n";
        }
    }
}

void pos_summary_print(const struct run *run, const struct pos_script *script)
{
    (void)putchar('{');
    print_times(run);
    (void)printf("\"axes\":[");
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        (void)fputs(i == 0 ? "\n" : ",\n", stdout);
        print_axis(run, i);
    }
    (void)printf("],\n\"executed\":%" PRIu32 ",\"lines\":%" PRIu32 ",\n\"told\":[", script->next, script->count);
    print_lines(script);
    (void)printf("]}\n");
}
