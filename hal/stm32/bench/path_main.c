/*
 * The bench image for paths: the unit as in the image of the board, all of it, but the motors follow the vectors of a
 * table that is put into the flash from outside, through the engine's other door. The line is served meanwhile. For the
 * virtual board: `tools/rkm04 bench --target stm32` writes the table and reads the report.
 */
#include <string.h>

#include "group.h"
#include "hal_board.h"
#include "hal_run.h"
#include "hal_time.h"
#include "rkm04.h"

enum {
    RING = 128,
    KINDS = 2,
    AHEAD_TICKS = 40 * TICKS_PER_MS, /* all that there is room for has been added by then */
};

enum act {
    ACT_NONE,
    ACT_SPEED, /* of all sections, at once */
    ACT_HOLD,  /* by main */
    ACT_INPUT, /* a hold, by the tick and the plan interrupt */
};

/* 32-bit words only, so that the layout is plain. */
struct path_bench_kind {
    int32_t steps[UNIT_MOTORS];
    uint32_t speed_steps_per_s;
};

struct path_bench_table {
    uint32_t vectors;                   /* in all */
    struct path_bench_kind kind[KINDS]; /* the first, the second, and so on in turns */
    uint32_t accel_steps_per_s2;
    uint32_t packet; /* so many are added at once, as soon as there is room for them */
    uint32_t act;
    uint32_t act_ticks; /* from the start on */
    uint32_t act_speed_steps_per_s;
};

struct path_bench_report {
    uint32_t late_steps;
    int32_t position_steps[UNIT_MOTORS];
    uint32_t added;        /* vectors */
    uint32_t path_ticks;   /* from the start to the rest */
    uint32_t add_ticks;    /* the longest time for adding a packet, */
    uint32_t poll_ticks;   /* for handing over segments, */
    uint32_t act_ticks;    /* for the act, */
    uint32_t effect_ticks; /* and from its begin to the place at which it takes effect */
};

extern const struct path_bench_table path_bench_table;
const struct path_bench_table path_bench_table = {.vectors = 0};

extern struct path_bench_report path_bench_report;
struct path_bench_report path_bench_report;

void path_bench_done(void);

struct bench {
    struct group group;
    struct path_section ring[RING];
    struct step_channel channel[UNIT_MOTORS];
    uint64_t start_tick;
    uint64_t act_tick; /* when it began; 0: it is to come */
    _Atomic bool input;
};

static struct bench bench;

/* The memory of all else has no room for it. It holds what the start found there. */
static struct rkm04 unit __attribute__((section(".sram1")));

/* The table as it is in the flash, not as the compiler knows it. */
static const struct path_bench_table *table(void)
{
    const struct path_bench_table *found = &path_bench_table;
    __asm__ volatile("" : "+r"(found));
    return found;
}

/* Whoever watches the run sees when this is reached: the report is there. */
__attribute__((noinline)) void path_bench_done(void)
{
    __asm__ volatile("nop" ::: "memory");
}

static unsigned path_bench_lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    (void)context;
    return step_channel_lay_isr(&bench.channel[motor], room);
}

static void path_bench_tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
    if (atomic_exchange_explicit(&bench.input, false, memory_order_relaxed) &&
        group_stop_isr(&bench.group, AXIS_CAUSE_HIGH)) {
        hal_run_plan();
    }
}

static void path_bench_plan_isr(void *context)
{
    (void)context;
    group_plan_isr(&bench.group);
}

static void longest(uint32_t *ticks, uint64_t since)
{
    uint32_t passed = (uint32_t)(hal_time_now() - since);
    *ticks = passed > *ticks ? passed : *ticks;
}

static void add_vector(uint32_t number)
{
    const struct path_bench_kind *kind = &table()->kind[number % KINDS];
    struct path_vector vector = {
        .speed = kind->speed_steps_per_s * PATH_SPEED_UNITS,
        .accel = table()->accel_steps_per_s2 * STEP_ACCEL_PER_ACCEL,
        .border_speed = UINT32_MAX,
    };
    uint32_t length = 0;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        uint32_t steps = (uint32_t)(kind->steps[motor] < 0 ? -kind->steps[motor] : kind->steps[motor]);
        length = steps > length ? steps : length;
        vector.steps[motor] = kind->steps[motor];
    }
    vector.extent2 = (uint64_t)length * length;
    (void)group_add(&bench.group, &vector);
}

static void add_vectors(void)
{
    uint32_t left = table()->vectors - path_bench_report.added;
    uint32_t packet = table()->packet < left ? table()->packet : left;
    if (packet == 0 || group_room(&bench.group) < packet) {
        return;
    }
    uint64_t begin = hal_time_now();
    for (uint32_t i = 0; i < packet; i++) {
        add_vector(path_bench_report.added++);
    }
    longest(&path_bench_report.add_ticks, begin);
}

static uint32_t act_speed(const void *context, uint32_t section)
{
    (void)context;
    (void)section;
    return table()->act_speed_steps_per_s * PATH_SPEED_UNITS;
}

/* Where the path was planned anew is its origin. */
static void act(uint64_t now)
{
    if (table()->act == ACT_NONE || bench.act_tick != 0 || now < bench.start_tick + table()->act_ticks) {
        return;
    }
    uint64_t begin = hal_time_now();
    bench.act_tick = begin;
    if (table()->act == ACT_SPEED) {
        static const struct group_speeds speeds = {.of = act_speed};
        group_set_speeds(&bench.group, &speeds);
    } else if (table()->act == ACT_HOLD) {
        (void)group_stop(&bench.group, AXIS_CAUSE_COMMAND);
    } else {
        atomic_store_explicit(&bench.input, true, memory_order_relaxed);
        path_bench_tick_isr(NULL, begin);
    }
    longest(&path_bench_report.act_ticks, begin);
    path_bench_report.effect_ticks = (uint32_t)(bench.group.path.origin.entry.time.high - begin);
}

static uint64_t pass(void)
{
    uint64_t begin = hal_time_now();
    uint64_t wake = rkm04_poll(&unit);
    add_vectors();
    act(begin);
    uint64_t group = group_poll(&bench.group);
    longest(&path_bench_report.poll_ticks, begin);
    return group < wake ? group : wake;
}

static void report(void)
{
    path_bench_report.late_steps = hal_board_late_steps();
    path_bench_report.path_ticks = (uint32_t)(group_end_tick(&bench.group) - bench.start_tick);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        path_bench_report.position_steps[motor] = (int32_t)step_channel_position(&bench.channel[motor]);
    }
    path_bench_done();
}

static void start(void)
{
    memset(&unit, 0, sizeof unit);
    rkm04_init(&unit);
    group_init(&bench.group, bench.ring, RING);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        step_channel_init(&bench.channel[motor], motor);
        group_connect(&bench.group, motor, &bench.channel[motor], motor);
    }
    unit.client = (struct hal_client){
        .lay_isr = path_bench_lay_isr, .tick_isr = path_bench_tick_isr, .plan_isr = path_bench_plan_isr};
    rkm04_start(&unit);
    uint64_t ready = hal_time_now() + AHEAD_TICKS;
    while (hal_time_now() < ready) {
        hal_board_idle(pass());
    }
    bench.start_tick = hal_time_now() + TICKS_PER_MS;
    (void)group_start(&bench.group, bench.start_tick);
}

int main(void)
{
    hal_board_init();
    start();
    while (!group_take_end(&bench.group)) {
        hal_board_idle(pass());
    }
    report();
    for (;;) {
        hal_board_idle(rkm04_poll(&unit));
    }
}
