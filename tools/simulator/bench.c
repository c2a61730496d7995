#include "bench.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base_tick.h"
#include "json.h"
#include "motion_plan.h"
#include "rkm04.h"
#include "rkm04_kind.h"
#include "run.h"
#include "step_generator.h"
#include "units.h"

enum {
    MEASURE_NS = 500000000, /* a measurement takes at least this long */
    SIMULATED_SECONDS = 20,
    MOVES_MAX = 100,
    SEGMENTS_MAX = 32, /* of one move; a plan has a few more only where a leg lasts for hours */
};

/* Whole moves, one after the other: of first_steps, first_steps + 1 and so on to last_steps. */
struct bench_mix {
    const char *name;
    uint32_t start_speed;
    uint32_t speed;
    uint32_t acceleration;
    uint32_t first_steps;
    uint32_t last_steps;
};

static const struct bench_mix bench_mixes[] = {
    {"S100 V16000 A60000 F16000000", 100, 16000, 60000, 16000000, 16000000},
    {"S1 V16000 A1 F16000000", 1, 16000, 1, 16000000, 16000000},
    {"S100 V16000 A60000 F4000", 100, 16000, 60000, 4000, 4000},
    {"S100 V1000 A2000 F1 to F100", 100, 1000, 2000, 1, 100},
};

struct laid_move {
    uint32_t start_tick;
    uint32_t segments;
    struct step_segment segment[SEGMENTS_MAX];
};

struct laid_mix {
    uint32_t moves;
    uint64_t pulses;
    struct laid_move move[MOVES_MAX];
};

/* Too large for the stack. */
struct bench {
    struct laid_mix laid;
    struct run run;
    struct rkm04 unit;
};

/* Walks along a move as the step interrupt does. */
static void walk_move(const struct laid_move *move)
{
    struct step_generator generator;
    step_generator_start(&generator, move->start_tick);
    for (uint32_t i = 0; i < move->segments; i++) {
        step_generator_load(&generator, &move->segment[i]);
        for (uint32_t left = move->segment[i].steps - 1U; left > 0; left--) {
            (void)step_generator_next(&generator);
        }
    }
}

/* Plans the moves, each at another tick. */
static void lay_mix(const struct bench_mix *mix, struct laid_mix *laid)
{
    struct motion_order order = {.sections = 1, .start_speed_steps_per_s = mix->start_speed};
    order.section[0].speed_steps_per_s = mix->speed;
    order.section[0].accel_steps_per_s2 = mix->acceleration;
    laid->moves = 0;
    laid->pulses = 0;
    for (uint32_t steps = mix->first_steps; steps <= mix->last_steps; steps++) {
        struct motion_plan plan;
        struct laid_move *move = &laid->move[laid->moves];
        order.section[0].steps = steps;
        move->start_tick = laid->moves * TICK_HZ;
        move->segments = 0;
        motion_plan_begin(&plan, &order, move->start_tick);
        while (move->segments < SEGMENTS_MAX && motion_plan_next(&plan, &move->segment[move->segments])) {
            laid->pulses += move->segment[move->segments].steps;
            move->segments++;
        }
        laid->moves++;
    }
}

static uint64_t per_second(uint64_t count, uint64_t ns)
{
    return count * (NS_PER_SECOND / 1000U) / (ns / 1000U);
}

static uint64_t pulses_per_second(const struct laid_mix *laid)
{
    uint64_t pulses = 0;
    uint64_t start_ns = units_real_ns();
    uint64_t ns = 0;
    while (ns < MEASURE_NS) {
        for (uint32_t i = 0; i < laid->moves; i++) {
            walk_move(&laid->move[i]);
        }
        pulses += laid->pulses;
        ns = units_real_ns() - start_ns;
    }
    return per_second(pulses, ns);
}

static uint64_t plans_per_second(const struct bench_mix *mix, struct laid_mix *laid)
{
    uint64_t plans = 0;
    uint64_t start_ns = units_real_ns();
    uint64_t ns = 0;
    while (ns < MEASURE_NS) {
        lay_mix(mix, laid);
        plans += laid->moves;
        ns = units_real_ns() - start_ns;
    }
    return per_second(plans, ns);
}

static void print_generator(struct laid_mix *laid)
{
    size_t count = sizeof bench_mixes / sizeof bench_mixes[0];
    (void)printf("{\"generator\":[");
    for (size_t i = 0; i < count; i++) {
        lay_mix(&bench_mixes[i], laid);
        (void)printf("%s{\"move\":\"%s\",\"pulses_per_second\":%" PRIu64 "}", i == 0 ? "\n" : ",\n",
                     bench_mixes[i].name, pulses_per_second(laid));
    }
    const struct bench_mix *shortest = &bench_mixes[count - 1U];
    (void)printf("],\n\"planner\":{\"move\":\"%s\",\"moves_per_second\":%" PRIu64 "},\n", shortest->name,
                 plans_per_second(shortest, laid));
}

static void print_simulation(struct run *run, struct rkm04 *unit)
{
    static const char request[] = "\x02"
                                  "0S2000 V16000 A60000 G+";
    uint8_t answer[MESSAGES_ANSWER_BYTES_MAX];
    run_init(run, &rkm04_kind, unit, 0);
    run_begin(run);
    (void)rkm04_message(unit, (const uint8_t *)request, (uint32_t)strlen(request), answer);
    run_until(run, (uint64_t)SIMULATED_SECONDS * TICK_HZ);
    (void)printf("\"simulation\":{\"program\":\"%s\",\"motors\":%d,\"seconds\":%d,\"pulses\":%" PRIu64 ",\"ratio\":",
                 request + 2, UNIT_MOTORS, SIMULATED_SECONDS, run->machine.pulses);
    json_print_fixed(run_milli_ratio(run), 3);
    (void)printf("}}\n");
}

enum exit_status bench_print(void)
{
    struct bench *bench = malloc(sizeof *bench);
    if (bench == NULL) {
        complain("there is not memory enough for a unit; close other programs");
        return EXIT_REFUSED;
    }
    print_generator(&bench->laid);
    print_simulation(&bench->run, &bench->unit);
    free(bench);
    return finish_output();
}
