/*
 * The bench image: the unit as in the image of the board, all of it, but moves come from a table that is put into the
 * flash from outside, so that they may be faster than the language allows (up to STEP_SPEED_MAX). The line is served
 * meanwhile. For the virtual board: `tools/rkm04 bench --target stm32` writes the table and reads the report.
 */
#include "hal_board.h"
#include "hal_time.h"
#include "rkm04.h"

enum {
    AHEAD_TICKS = 5 * TICKS_PER_MS, /* all moves have been laid by then */
};

/* 32-bit words only, so that the layout is plain. */
struct bench_move {
    uint32_t steps; /* 0: this motor rests */
    uint32_t start_speed_steps_per_s;
    uint32_t speed_steps_per_s;
    uint32_t accel_steps_per_s2;
    uint32_t delay_ticks; /* it begins later than the first motor by this */
};

struct bench_table {
    struct bench_move move[UNIT_MOTORS];
    uint32_t stop_at_late; /* not 0: nothing matters after the first late step */
    uint32_t guards;       /* inputs that stop every move while they are 1; bit 0 is input 1 */
};

struct bench_report {
    uint32_t late_steps;
    int32_t position_steps[UNIT_MOTORS];
    uint32_t moves; /* that have ended */
};

extern const struct bench_table bench_table;
const struct bench_table bench_table = {.stop_at_late = 0};

extern struct bench_report bench_report;
struct bench_report bench_report;

void bench_done(void);

/* The table as it is in the flash, not as the compiler knows it. */
static const struct bench_table *table(void)
{
    const struct bench_table *found = &bench_table;
    __asm__ volatile("" : "+r"(found));
    return found;
}

/* Whoever watches the run sees when this is reached: the report is there. */
__attribute__((noinline)) void bench_done(void)
{
    __asm__ volatile("nop" ::: "memory");
}

static void start_move(struct rkm04 *unit, unsigned motor, uint64_t tick)
{
    const struct bench_move *move = &table()->move[motor];
    struct motion_order order = {.sections = 1, .start_speed_steps_per_s = move->start_speed_steps_per_s};
    order.section[0] = (struct motion_section){
        .steps = move->steps,
        .speed_steps_per_s = move->speed_steps_per_s,
        .accel_steps_per_s2 = move->accel_steps_per_s2,
    };
    const struct axis_guards guards = {.stop_high = (uint8_t)table()->guards};
    if (move->steps != 0) {
        axis_begin(&unit->axis[motor], &order, false, tick + move->delay_ticks, &guards);
    }
}

static bool is_moving(const struct rkm04 *unit)
{
    bool moving = false;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        moving = moving || axis_is_moving(&unit->axis[motor]);
    }
    return moving;
}

/* One pass, as in the main of the unit; the interpreters rest, so the ends of moves are looked for here. */
static void pass(struct rkm04 *unit)
{
    uint64_t wake = rkm04_poll(unit);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        axis_poll(&unit->axis[motor]);
    }
    hal_board_idle(wake);
}

static void report(const struct rkm04 *unit)
{
    bench_report.late_steps = hal_board_late_steps();
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        bench_report.position_steps[motor] = (int32_t)axis_position_steps(&unit->axis[motor]);
        bench_report.moves += axis_is_moving(&unit->axis[motor]) || table()->move[motor].steps == 0 ? 0U : 1U;
    }
    bench_done();
}

int main(void)
{
    static struct rkm04 unit;
    hal_board_init();
    rkm04_init(&unit);
    rkm04_start(&unit);
    uint64_t start = hal_time_now() + AHEAD_TICKS;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        start_move(&unit, motor, start);
    }
    while (is_moving(&unit) && (table()->stop_at_late == 0 || hal_board_late_steps() == 0)) {
        pass(&unit);
    }
    report(&unit);
    for (;;) {
        pass(&unit);
    }
}
