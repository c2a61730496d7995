#include "gve_summary.h"

#include <inttypes.h>
#include <stdio.h>

#include "gve134.h"
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
    (void)putchar(',');
}

static void print_times(const struct run *run)
{
    print_seconds("seconds", units_ns_of_ticks(run->machine.now));
    (void)printf("\"ticks\":%" PRIu64 ",", run->machine.now);
    print_seconds("real_seconds", run->real_ns);
    (void)printf("\"ratio\":");
    json_print_fixed(run_milli_ratio(run), MILLI_DECIMALS);
    (void)printf(",\"ended\":\"%s\",\"late_steps\":%" PRIu64 ",\n", run_end_text(run), run->machine.late_steps);
}

static void print_axis(const struct run *run, unsigned motor)
{
    const struct tally *tally = &run->tally[motor];
    (void)printf("{\"axis\":\"%c\",\"motor\":%u,\"pulses\":%" PRIu64 ",\"position\":%" PRId64 ",\"peak_speed\":",
                 "XYZA"[motor], motor + 1U, tally->pulses, run->kind->position_steps(run->unit, motor));
    json_print_fixed(units_milli_speed(tally->shortest_ticks), MILLI_DECIMALS);
    (void)printf(",\"seconds_moving\":");
    json_print_fixed(units_ns_of_ticks(tally_moving_ticks(tally, run->machine.now, run->kind->moves_together)),
                     NS_DECIMALS);
    (void)putchar('}');
}

/* Why the line that the others wait for has not been answered. */
static const char *reason_of(const struct gve_player *player)
{
    const struct gve_player_waiting *waiting = &player->waiting[player->waiting_first];
    bool sent = player->waiting_count > 0;
    bool timed = sent ? waiting->timed : !player->has_next;
    if (timed ? gve_player_stuck_at(player)->repeated : player->next_repeats > 0) {
        return "no_room";
    }
    return sent ? "no_answer" : "time";
}

static void print_stuck(const struct gve_player *player)
{
    const struct gve_script_line *line = gve_player_stuck_at(player);
    if (line == NULL) {
        (void)printf("\"stuck\":null,\n");
        return;
    }
    (void)printf("\"stuck\":{\"line\":%" PRIu32 ",\"command\":", line->line.number);
    json_print_text((const char *)line->line.text, line->line.length);
    (void)printf(",\"reason\":\"%s\"},\n", reason_of(player));
}

void gve_summary_print(const struct run *run, const struct gve_player *player)
{
    const struct gve134 *unit = run->unit;
    (void)putchar('{');
    print_times(run);
    (void)printf("\"axes\":[");
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        (void)fputs(i == 0 ? "\n" : ",\n", stdout);
        print_axis(run, i);
    }
    (void)printf("],\n\"commands\":%" PRIu64 ",\"vectors\":%" PRIu64 ",\"repeats\":%" PRIu64 ",\"unanswered\":%" PRIu64
                 ",\n",
                 player->commands, player->vectors, player->repeats, player->silent);
    print_stuck(player);
    gve_told_print(&player->told);
    (void)printf(",\n\"interrupted\":%s,\"waiting\":%s,\"outputs\":%u,\"pwm\":%" PRIu32 "}\n",
                 gve_queue_inta(&unit->queue) ? "true" : "false", gve_queue_runs(&unit->queue) ? "true" : "false",
                 (unsigned)run->machine.outputs, run->machine.pwm_permille);
}
