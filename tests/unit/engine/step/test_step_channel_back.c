#include "mock_hal_step.h"
#include "step_channel.h"
#include "unity.h"

#include "channel_rig.h"

/* Pulses laid ahead over borders of segments, taken back, and laid again: each comes at the tick that it has where one
 * is laid at a time. */

enum {
    ACCEL = 2000 * (int32_t)STEP_ACCEL_PER_ACCEL,
    RAMP = 10,   /* pulses of the ramp up, and of the one down */
    SINGLES = 4, /* segments of one pulse */
    CRUISE = 7,
    TOTAL = 2 * RAMP + SINGLES + CRUISE,
    SEGMENTS = SINGLES + 3,
    AHEAD = 16, /* pulses, over five borders at the most */
};

static struct step_segment plan[SEGMENTS];
static uint32_t expected[TOTAL + 1]; /* tick of pulse k; of 0, the start */
static unsigned at_once;             /* pulses laid by one question at most */

/* Appends a segment that goes on from pulse `pulse`, after which `generator` stands. */
static void plan_segment(unsigned place, struct step_generator *generator, uint32_t steps, int32_t accel)
{
    struct step_segment segment = {
        .residual = generator->residual,
        .slope = generator->slope,
        .accel = accel,
        .tick = generator->tick,
        .pace_ticks = (uint32_t)(STEP_QUANTA / generator->slope),
        .steps = steps,
    };
    step_generator_aim(&segment, (uint32_t)(STEP_QUANTA / generator->slope));
    plan[place] = segment;
    step_generator_load(generator, &segment);
    for (uint32_t i = 1; i < steps; i++) {
        (void)step_generator_next(generator);
    }
}

static void make_plan(void)
{
    struct step_generator generator = {.slope = STEP_QUANTA / INTERVAL, .tick = START};
    unsigned place = 0;
    plan_segment(place++, &generator, RAMP, ACCEL);
    while (place <= SINGLES) {
        plan_segment(place++, &generator, 1, 0);
    }
    plan_segment(place++, &generator, CRUISE, 0);
    plan_segment(place, &generator, RAMP, -ACCEL);
}

static void begin_plan(unsigned ahead)
{
    laid.ahead = ahead;
    laid.at_once = at_once;
    step_channel_begin(&channel, START, false);
    for (unsigned place = 0; place < SEGMENTS; place++) {
        TEST_ASSERT_TRUE(step_channel_push(&channel, &plan[place]));
    }
    step_channel_run(&channel);
}

/* From the pulse made last on. */
static void assert_expected_to_the_end(void)
{
    while (step_channel_is_running(&channel)) {
        uint32_t tick = laid_make_pulse();
        TEST_ASSERT_EQUAL_UINT32(expected[laid.made], tick);
        TEST_ASSERT_EQUAL_UINT64(laid.made, step_channel_pulses(&channel));
    }
    TEST_ASSERT_EQUAL_UINT32(TOTAL, laid.made);
    TEST_ASSERT_EQUAL_UINT32(expected[TOTAL], step_channel_end_tick(&channel));
    TEST_ASSERT_EQUAL_UINT32(STEP_QUEUE_SEGMENTS, step_channel_room(&channel));
}

static void begin_and_make(unsigned ahead, uint32_t made)
{
    channel_rig_init();
    begin_plan(ahead);
    make_pulses(made);
}

void setUp(void)
{
    at_once = LAID_MAX;
    channel_rig_init();
    make_plan();
    begin_plan(1);
    expected[0] = START;
    for (uint32_t pulse = 1; pulse <= TOTAL; pulse++) {
        expected[pulse] = laid_make_pulse();
    }
    TEST_ASSERT_FALSE(step_channel_is_running(&channel));
    channel_rig_init();
}

void tearDown(void)
{
    channel_rig_check();
}

void test_any_number_of_pulses_laid_ahead_come_at_the_same_ticks(void)
{
    for (unsigned ahead = 1; ahead <= TOTAL + 2; ahead++) {
        for (at_once = 1; at_once <= ahead; at_once++) {
            channel_rig_init();
            begin_plan(ahead);
            assert_expected_to_the_end();
        }
    }
}

/* What the plan has after a pulse: the rest of its segment and all later ones. Returns how many segments. */
static unsigned rest_of_plan(const struct step_cursor *at, struct step_segment rest[SEGMENTS])
{
    unsigned count = 0;
    uint64_t end = 0;
    for (unsigned place = 0; place < SEGMENTS; place++) {
        uint64_t begin = end;
        end += plan[place].steps;
        if (step_cursor_pulse(at) <= begin) {
            rest[count++] = plan[place];
        } else if (step_cursor_pulse(at) < end) {
            struct step_generator next = at->generator;
            (void)step_generator_next(&next);
            rest[count] = plan[place];
            rest[count].residual = next.residual;
            rest[count].slope = next.slope;
            rest[count].tick = next.tick;
            rest[count++].steps = (uint32_t)(end - step_cursor_pulse(at));
        }
    }
    return count;
}

/* Replaces all after a pulse by the same. */
static bool replace_by_the_same(uint32_t pulse)
{
    struct step_cursor at;
    struct step_segment rest[SEGMENTS];
    TEST_ASSERT_TRUE(step_channel_look_ahead(&channel, expected[pulse], &at));
    TEST_ASSERT_EQUAL_UINT64(pulse, step_cursor_pulse(&at));
    TEST_ASSERT_EQUAL_UINT32(expected[pulse], at.generator.tick);
    unsigned count = rest_of_plan(&at, rest);
    return step_channel_replace(&channel, &at, rest, count);
}

void test_pulses_taken_back_to_any_pulse_and_laid_again_come_at_the_same_ticks(void)
{
    for (uint32_t made = 0; made < TOTAL; made++) {
        for (uint32_t pulse = made + 1; pulse <= TOTAL; pulse++) {
            begin_and_make(AHEAD, made);
            uint32_t last = laid.laid;

            TEST_ASSERT_TRUE(replace_by_the_same(pulse));

            TEST_ASSERT_EQUAL_UINT32(pulse < last ? last - pulse : 0, laid.back);
            TEST_ASSERT_EQUAL_UINT32(last, laid.laid);
            assert_expected_to_the_end();
        }
    }
}

/* Two replacements and then a halt: the way back of each leads over what the ones before have left. */
static void replace_twice_and_halt(uint32_t made, uint32_t first, uint32_t second)
{
    begin_and_make(AHEAD, made);
    TEST_ASSERT_TRUE(replace_by_the_same(first));
    TEST_ASSERT_TRUE(replace_by_the_same(second));
    make_pulses(1);
    TEST_ASSERT_EQUAL_UINT32(expected[made + 1], laid.last_tick);

    step_channel_halt(&channel);

    TEST_ASSERT_EQUAL_UINT64(made + 1, step_channel_pulses(&channel));
    TEST_ASSERT_EQUAL_UINT32(expected[made + 1], step_channel_end_tick(&channel));
}

void test_what_was_replaced_can_be_replaced_and_halted_again(void)
{
    static const unsigned places[] = {1, 2, 3, 5, LAID_MAX};
    for (unsigned i = 0; i < sizeof places / sizeof *places; i++) {
        at_once = places[i];
        for (uint32_t made = 0; made + 3 < TOTAL; made++) {
            for (uint32_t first = made + 1; first <= made + AHEAD && first < TOTAL; first++) {
                for (uint32_t second = made + 1; second <= TOTAL; second += 3) {
                    replace_twice_and_halt(made, first, second);
                }
            }
        }
    }
}

/* What follows is another ramp: no place on the old one may serve as the way back. */
static void replace_by_a_brake(uint32_t made, uint32_t pulse)
{
    struct step_cursor at;
    struct step_cursor found;
    begin_and_make(AHEAD, made);
    TEST_ASSERT_TRUE(step_channel_look_ahead(&channel, expected[pulse], &at));
    struct step_generator generator = at.generator;
    struct step_segment other = {
        .residual = generator.residual,
        .slope = generator.slope,
        .accel = -ACCEL,
        .tick = generator.tick,
        .steps = 2 * AHEAD,
    };
    step_generator_aim(&other, generator.interval);
    TEST_ASSERT_TRUE(step_channel_replace(&channel, &at, &other, 1));
    for (uint32_t next = made + 1U; next <= pulse + 2U * AHEAD; next++) {
        TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, laid_next_tick(), &found));
        TEST_ASSERT_EQUAL_UINT64(next, step_cursor_pulse(&found));
        TEST_ASSERT_EQUAL_UINT32(laid_make_pulse(), found.generator.tick);
    }
    TEST_ASSERT_FALSE(step_channel_is_running(&channel));
}

void test_after_a_replacement_every_pulse_is_found_where_it_was_laid(void)
{
    for (at_once = 1; at_once <= AHEAD; at_once++) {
        for (uint32_t made = 0; made < TOTAL; made++) {
            for (uint32_t pulse = made + 1; pulse <= TOTAL; pulse++) {
                replace_by_a_brake(made, pulse);
            }
        }
    }
}

void test_a_replacement_that_is_too_late_lays_again_what_came_back(void)
{
    for (uint32_t made = 0; made + 2 < TOTAL; made++) {
        for (unsigned too_late = 2; too_late < AHEAD; too_late++) {
            begin_and_make(AHEAD, made);
            uint32_t last = laid.laid;
            laid.too_late = too_late;

            TEST_ASSERT_EQUAL(made + too_late <= made + 1, replace_by_the_same(made + 1));

            TEST_ASSERT_EQUAL_UINT32(last, laid.laid);
            assert_expected_to_the_end();
        }
    }
}

void test_a_replacement_at_the_last_pulse_that_cannot_be_taken_back_is_in_time(void)
{
    for (uint32_t made = 0; made + AHEAD < TOTAL; made++) {
        for (uint32_t too_late = 1; too_late <= AHEAD; too_late++) {
            begin_and_make(AHEAD, made);
            laid.too_late = too_late;

            TEST_ASSERT_TRUE(replace_by_the_same(made + too_late));

            assert_expected_to_the_end();
        }
    }
}

void test_a_halt_among_pulses_laid_ahead_ends_with_the_last_one_made(void)
{
    for (uint32_t made = 0; made < TOTAL; made++) {
        begin_and_make(AHEAD, made);

        step_channel_halt(&channel);

        TEST_ASSERT_EQUAL_UINT(0, laid_waiting());
        TEST_ASSERT_FALSE(step_channel_is_running(&channel));
        TEST_ASSERT_EQUAL_INT64(made, step_channel_position(&channel));
        TEST_ASSERT_EQUAL_UINT32(expected[made], step_channel_end_tick(&channel));
    }
}

void test_a_halt_that_is_too_late_for_some_pulses_ends_with_them(void)
{
    for (uint32_t made = 0; made + AHEAD < TOTAL; made++) {
        for (unsigned too_late = 1; too_late <= AHEAD; too_late++) {
            begin_and_make(AHEAD, made);
            laid.too_late = too_late;

            step_channel_halt(&channel);

            TEST_ASSERT_EQUAL_UINT64(made, step_channel_pulses(&channel));
            TEST_ASSERT_EQUAL_UINT(too_late, run_to_the_end());
            TEST_ASSERT_EQUAL_UINT64(made + too_late, step_channel_pulses(&channel));
            TEST_ASSERT_EQUAL_UINT32(expected[made + too_late], step_channel_end_tick(&channel));
        }
    }
}

/* Brakes as soon as so many pulses have been made; the ticks go into `tick`. */
static unsigned brake_after(unsigned ahead, uint32_t made, uint32_t tick[TOTAL])
{
    struct step_cursor at;
    begin_and_make(ahead, made);
    TEST_ASSERT_TRUE(step_channel_find_pulse(&channel, laid_next_tick(), &at));
    TEST_ASSERT_EQUAL_UINT64(made + 1, step_cursor_pulse(&at));
    TEST_ASSERT_TRUE(step_channel_brake(&channel, ACCEL, made + 6, &at));
    unsigned count = 0;
    while (step_channel_is_running(&channel)) {
        tick[count++] = laid_make_pulse();
    }
    return count;
}

void test_a_brake_among_pulses_laid_ahead_makes_the_pulses_of_one_at_a_time(void)
{
    uint32_t one_at_a_time[TOTAL];
    uint32_t tick[TOTAL];
    for (uint32_t made = 0; made < TOTAL; made++) {
        TEST_ASSERT_EQUAL_UINT(6, brake_after(1, made, one_at_a_time));

        TEST_ASSERT_EQUAL_UINT(6, brake_after(AHEAD, made, tick));

        TEST_ASSERT_EQUAL_UINT32_ARRAY(one_at_a_time, tick, 6);
    }
}
