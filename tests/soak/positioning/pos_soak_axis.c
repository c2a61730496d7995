#include "pos_soak_axis.h"

#include <stdlib.h>

#include "soak_chance.h"

enum {
    INIT = 1,
    MODE = 2,
    MODE_ABS = 4,
    STATUS_JEDE = 0x0100,
    STATUS_POL = 0x0800,
    STATUS_DISP = 0x0001,
    IMAGE = 520, /* STATUS, ERROR, POSITION of each axis */
    IMAGE_WORDS = 4,
    STEPS_REGISTER = 30, /* STEPS, MICROMETRES */
    BACKLASH_REGISTER = 41,
    WORDS = 8,             /* INSTRUCTION to FEED */
    CYCLE_STEPS_MIN = 750, /* half of the highest rate */
    SHORT_UM = 2000,
    ACCEL_MIN = 200,
    ACCEL_MAX = 65535,
    FEED_SPREAD = 8, /* feeds are up to an eighth under the highest */
    SLOW_BITS = 28,
    HELD_MAX = 40,
    SLOW_MAX = 20,
};

/* One in so many. */
enum {
    OFTEN = 4,
    SOMETIMES = 8,
    RARELY = 256,
    SELDOM = 8192,
};

struct pos_soak_setting {
    uint32_t steps;
    uint32_t micrometres;
    uint32_t backlash_um;
    int64_t backlash_steps;
    bool faithful;
};

static const struct pos_soak_setting settings[UNIT_MOTORS] = {
    {.steps = 1, .micrometres = 10, .faithful = true},
    {.steps = 7, .micrometres = 3, .faithful = true},
    {.steps = 3200, .micrometres = 31416, .backlash_um = 50, .backlash_steps = 5},
    {.steps = 1001, .micrometres = 9973},
};

/* Of 1/65 536 mm/min, at 100 000 steps/s with a step of a micrometre. */
#define FEED_OF_STEPS_PER_UM (UINT64_C(60) * 65536U * POS_SOAK_RATE_MAX / 1000U)

static bool one_in(const struct pos_soak_axis *axis, uint32_t count)
{
    return chance_below(axis->chance, count) == 0U;
}

/* floor(a * b / c + 1/2) */
static int64_t half_up(int64_t a, int64_t b, int64_t c)
{
    int64_t twice = 2 * a * b + c;
    int64_t whole = twice / (2 * c);
    return whole * 2 * c > twice ? whole - 1 : whole;
}

static int64_t step_of(const struct pos_soak_axis *axis, int64_t base, int64_t way)
{
    return base + half_up(way, axis->steps, axis->micrometres);
}

static struct pos_soak_motor *motor_of(const struct pos_soak_axis *axis)
{
    return &axis->soak->motors[axis->number - 1U];
}

static unsigned register_of(const struct pos_soak_axis *axis, unsigned offset)
{
    return 100U * axis->number + offset;
}

static uint16_t high_word(uint32_t value)
{
    return (uint16_t)(value >> 16U);
}

static uint16_t low_word(uint32_t value)
{
    return (uint16_t)(value & 0xFFFFU);
}

void pos_soak_fast_image(struct pos_soak *soak, unsigned first, uint32_t count, const uint16_t *words)
{
    pos_soak_write_and_read(soak, (uint16_t)first, count, words, IMAGE, (uint32_t)IMAGE_WORDS * UNIT_MOTORS);
}

void pos_soak_axis_begin(struct pos_soak_axis *axis, struct pos_soak *soak, unsigned number, uint64_t *chance)
{
    const struct pos_soak_setting *own = &settings[number - 1U];
    *axis = (struct pos_soak_axis){
        .soak = soak,
        .chance = chance,
        .number = number,
        .faithful = own->faithful,
        .steps = own->steps,
        .micrometres = own->micrometres,
        .feed_max = (uint32_t)(FEED_OF_STEPS_PER_UM * own->micrometres / own->steps),
    };
    const uint16_t words[] = {high_word(own->steps), low_word(own->steps), high_word(own->micrometres),
                              low_word(own->micrometres)};
    const uint16_t backlash[] = {(uint16_t)own->backlash_um};
    pos_soak_write(soak, (uint16_t)register_of(axis, STEPS_REGISTER), sizeof words / sizeof words[0], words,
                   2 * POS_SOAK_CYCLE_MS);
    pos_soak_write(soak, (uint16_t)register_of(axis, BACKLASH_REGISTER), 1, backlash, 2 * POS_SOAK_CYCLE_MS);
    motor_of(axis)->backlash = own->backlash_steps;
    motor_of(axis)->slack = own->backlash_steps;
}

/* ---- what it is told ------------------------------------------------------------------------------------------- */

void pos_soak_axis_feed(struct pos_soak_axis *axis, uint16_t *words)
{
    if (axis->held == 0U && one_in(axis, 2 * RARELY)) {
        axis->held = 1U + chance_below(axis->chance, HELD_MAX);
        axis->holds++;
    }
    if (axis->slow == 0U && one_in(axis, RARELY)) {
        axis->slow = 1U + chance_below(axis->chance, SLOW_MAX);
    }
    uint32_t feed = axis->feed_max - chance_below(axis->chance, axis->feed_max / (uint32_t)FEED_SPREAD);
    if (axis->slow != 0U) {
        feed = UINT32_C(1) << chance_below(axis->chance, SLOW_BITS);
        axis->slow--;
    }
    bool permitted = axis->held == 0U;
    if (!permitted) {
        axis->held--;
        permitted = one_in(axis, 2);
        feed = permitted ? 0U : feed;
    }
    words[0] = permitted ? 1U : 0U;
    words[1] = high_word(feed);
    words[2] = low_word(feed);
    axis->feeds++;
}

static void instruct(struct pos_soak_axis *axis, unsigned code, int32_t len_um)
{
    uint32_t accel_bits = chance_below(axis->chance, 9);
    uint32_t accel = (uint32_t)ACCEL_MIN << accel_bits;
    uint16_t words[WORDS] = {
        (uint16_t)((unsigned)axis->instruction << 8U | code),
        0,
        high_word((uint32_t)len_um),
        low_word((uint32_t)len_um),
        (uint16_t)(accel < (uint32_t)ACCEL_MAX ? accel : (uint32_t)ACCEL_MAX),
    };
    axis->instruction = (uint16_t)((axis->instruction + 1U) % 256U);
    pos_soak_axis_feed(axis, &words[5]);
    pos_soak_fast_image(axis->soak, register_of(axis, 0), WORDS, words);
}

void pos_soak_axis_take(struct pos_soak_axis *axis)
{
    instruct(axis, INIT, 0);
}

/* A way that takes no more time than is left, at half the highest rate. */
static int32_t some_way(const struct pos_soak_axis *axis, uint64_t cycles_left)
{
    uint64_t most = cycles_left * (uint64_t)CYCLE_STEPS_MIN * (uint64_t)axis->micrometres / (uint64_t)axis->steps;
    most = one_in(axis, OFTEN) ? (uint64_t)SHORT_UM : most;
    uint32_t way = chance_below(axis->chance, most < (uint64_t)INT32_MAX ? (uint32_t)most + 1U : (uint32_t)INT32_MAX);
    return one_in(axis, 2) ? (int32_t)way : -(int32_t)way;
}

static void measure(struct pos_soak_axis *axis, uint64_t cycles_left)
{
    int32_t len_um = some_way(axis, cycles_left);
    int64_t here_um = half_up(motor_of(axis)->position, axis->micrometres, axis->steps);
    int64_t there_um = here_um + len_um;
    bool absolute = !axis->faithful && llabs(there_um) <= INT32_MAX && one_in(axis, OFTEN);
    axis->next_base = absolute ? 0 : axis->base;
    axis->next_way = absolute ? there_um : axis->way + len_um;
    axis->doing = POS_SOAK_MOVES;
    axis->measures++;
    instruct(axis, absolute ? MODE_ABS : MODE, absolute ? (int32_t)there_um : len_um);
}

bool pos_soak_axis_instruct(struct pos_soak_axis *axis, uint64_t cycles_left)
{
    bool gives_up = axis->doing == POS_SOAK_MOVES && !axis->faithful && one_in(axis, SELDOM);
    if (gives_up) {
        axis->doing = POS_SOAK_GIVES_UP;
        axis->given_up++;
        instruct(axis, INIT, 0);
    } else if (axis->doing != POS_SOAK_RESTS || cycles_left == 0U) {
        return false;
    } else if (one_in(axis, SOMETIMES)) {
        instruct(axis, INIT, 0);
    } else {
        measure(axis, cycles_left);
    }
    return true;
}

/* ---- what it does ---------------------------------------------------------------------------------------------- */

static void see_position(const struct pos_soak_axis *axis, int64_t steps)
{
    struct pos_soak *soak = axis->soak;
    uint32_t told = pos_soak_long(soak, (axis->number - 1U) * IMAGE_WORDS + 2U);
    int64_t wanted_um = half_up(steps, axis->micrometres, axis->steps);
    pos_soak_require(soak, told == (uint32_t)((uint64_t)wanted_um & UINT32_MAX), "POSITION is that of the motor");
}

/* It rests at its measure. */
static void see_end(struct pos_soak_axis *axis)
{
    struct pos_soak_motor *motor = motor_of(axis);
    axis->base = axis->next_base;
    axis->way = axis->next_way;
    axis->doing = POS_SOAK_RESTS;
    pos_soak_require(axis->soak, motor->position == step_of(axis, axis->base, axis->way), "a measure ends on its step");
    see_position(axis, motor->position);
}

static void see_stand(struct pos_soak_axis *axis)
{
    struct pos_soak_motor *motor = motor_of(axis);
    if (motor->position != step_of(axis, axis->base, axis->way)) {
        axis->base = motor->position;
        axis->way = 0;
    }
    axis->doing = POS_SOAK_RESTS;
    see_position(axis, motor->position);
}

void pos_soak_axis_see(struct pos_soak_axis *axis)
{
    unsigned status = pos_soak_word(axis->soak, (axis->number - 1U) * IMAGE_WORDS);
    unsigned error = pos_soak_word(axis->soak, (axis->number - 1U) * IMAGE_WORDS + 1U);
    pos_soak_require(axis->soak, error == 0U && (status & (unsigned)STATUS_DISP) != 0U, "no axis has an error");
    if (axis->doing == POS_SOAK_MOVES && (status & (unsigned)STATUS_POL) != 0U) {
        see_end(axis);
    } else if (axis->doing == POS_SOAK_GIVES_UP && (status & (unsigned)STATUS_JEDE) == 0U) {
        see_stand(axis);
    }
}
