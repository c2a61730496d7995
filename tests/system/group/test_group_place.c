/* Where a stop or a change of speed takes effect, and that it needs no pass of main. */
#include "group_rig.h"

enum {
    SECTIONS = 60,
    LEAD_TICKS = 330 * TICKS_PER_US,
    LOOK_TICKS = 56,  /* for each section that is looked at */
    STEP_TICKS = 420, /* at 200 000 steps/s */
};

void setUp(void)
{
    begin(AHEAD_TICKS);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

static void be_busy(void)
{
    busy_until = machine.now + 650U * TICKS_PER_US;
}

static void run_busy(void)
{
    run_us(650);
    busy_until = 0;
}

static void add_to_all(int32_t way)
{
    add(way, way, way, way, 200000);
}

/* All axes, at 200 000 steps/s in the first of many vectors. */
static void begin_fast(int32_t each)
{
    begin_ring(AHEAD_TICKS, LONG_RING);
    add_to_all(40000);
    for (unsigned i = 2; i < SECTIONS; i++) {
        add_to_all(each);
    }
    add_to_all(40000);
    start();
    run_us(250000);
}

static uint64_t place_tick(void)
{
    return group.path.origin.entry.time.high;
}

static void expect_place_at(uint64_t tick)
{
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(tick, place_tick());
    TEST_ASSERT_LESS_THAN_UINT64(tick + STEP_TICKS + 1U, place_tick());
}

/* ---- when ------------------------------------------------------------------------------------------------------ */

void test_a_stop_takes_effect_at_the_first_step_after_its_lead(void)
{
    begin_fast(2000);
    uint64_t now = hal_time_now();
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    expect_place_at(now + LEAD_TICKS);
    run_to_the_end();
}

void test_other_speeds_take_effect_later_by_the_time_that_their_sections_need(void)
{
    uint32_t speed = 20000;
    const struct group_speeds speeds = {.of = slow, .context = &speed};
    begin_fast(2000);
    uint64_t now = hal_time_now();
    group_set_speeds(&group, &speeds);
    TEST_ASSERT_EQUAL_UINT32(SECTIONS, group_end(&group) - group_first(&group));
    expect_place_at(now + LEAD_TICKS + SECTIONS * LOOK_TICKS);
    run_to_the_end();
    assert_arrived();
}

void test_sections_that_are_over_need_no_time(void)
{
    uint32_t speed = 20000;
    const struct group_speeds speeds = {.of = slow, .context = &speed};
    begin_fast(2000);
    while (group_first(&group) < 20) {
        run_us(1000);
    }
    uint64_t now = hal_time_now();
    uint64_t sections = group_end(&group) - group_first(&group);
    group_set_speeds(&group, &speeds);
    expect_place_at(now + LEAD_TICKS + sections * LOOK_TICKS);
    run_to_the_end();
    assert_arrived();
}

void test_a_vector_that_joins_takes_effect_later_by_a_look_at_each_section(void)
{
    for (unsigned i = 0; i < 4; i++) {
        add(200, 0, 0, 0, 20000);
    }
    start();
    while (!path_is_laid(&group.path)) {
        run_us(500);
    }
    uint64_t now = hal_time_now();
    add(2000, 0, 0, 0, 20000);
    uint64_t sections = group_end(&group) - group_first(&group);
    (void)group_poll(&group);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(now + LEAD_TICKS + sections * LOOK_TICKS, place_tick());
    TEST_ASSERT_LESS_THAN_UINT64(now + TICKS_PER_MS, place_tick());
    run_to_the_end();
    assert_arrived();
}

void test_at_a_slow_speed_the_next_step_is_waited_for(void)
{
    uint32_t speed = 200;
    const struct group_speeds speeds = {.of = slow, .context = &speed};
    add(300, 0, 0, 0, 100);
    start();
    run_us(1003000);
    group_set_speeds(&group, &speeds);
    uint64_t at = place_tick() - machine.epoch;
    unsigned next = made[0];
    TEST_ASSERT_GREATER_THAN_UINT64(machine.now + TICKS_PER_MS, at);
    run_us(20000);
    TEST_ASSERT_UINT64_WITHIN(1, made_tick[0][next], at);
    run_to_the_end();
    assert_arrived();
}

/* Asks for other speeds so many ticks before the next step at 100 steps/s, after which a change may come between steps.
 * Tells how much sooner than the step it takes effect. */
static int64_t ask_before_step(uint64_t ticks)
{
    uint32_t speed = 200;
    const struct group_speeds speeds = {.of = slow, .context = &speed};
    begin(AHEAD_TICKS);
    group_set_manner(&group, &(struct group_manner){.between_steps = true});
    add(300, 0, 0, 0, 100);
    start();
    run_us(1003000);
    uint64_t step = made_tick[0][made[0] - 1U] + 2 * 10 * TICKS_PER_MS;
    host_machine_run(&machine, step - ticks, poll, NULL, NULL);
    group_set_speeds(&group, &speeds);
    int64_t sooner = (int64_t)(step - (place_tick() - machine.epoch));
    run_to_the_end();
    assert_arrived();
    return sooner;
}

void test_between_steps_a_step_is_waited_for_if_it_comes_half_a_millisecond_later(void)
{
    const uint64_t lead = LEAD_TICKS + LOOK_TICKS;
    const uint64_t patience = 500 * TICKS_PER_US;
    TEST_ASSERT_INT64_WITHIN(1, 0, ask_before_step(lead + patience - 2U));
    TEST_ASSERT_INT64_WITHIN(2, patience + 3, ask_before_step(lead + patience + 3U));
}

/* What is due within `keep_us` cannot be taken back; whether the stop has been planned at once. */
static bool is_planned_though_kept(uint32_t keep_us)
{
    begin(10 * TICKS_PER_MS);
    add(1000, 0, 0, 0, 10000);
    start();
    run_us(60000);
    machine.faults.keep_ticks = keep_us * TICKS_PER_US;
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    bool planned = atomic_load(&group.state) == AXIS_STOPPING;
    machine.faults.keep_ticks = 0;
    run_to_the_end();
    TEST_ASSERT_TRUE(group_has_rest(&group));
    start();
    run_to_the_end();
    assert_arrived();
    return planned;
}

void test_a_place_is_looked_for_up_to_eight_leads_ahead(void)
{
    TEST_ASSERT_TRUE(is_planned_though_kept(300));
    TEST_ASSERT_TRUE(is_planned_though_kept(1200));
    TEST_ASSERT_TRUE(is_planned_though_kept(2600));
    TEST_ASSERT_FALSE(is_planned_though_kept(2800));
}

void test_what_is_due_before_a_place_is_handed_over_at_once(void)
{
    for (uint32_t phase = 0; phase < 60; phase++) {
        begin(AHEAD_TICKS);
        for (unsigned i = 0; i < RING; i++) {
            add(7, 50, 20, i % 2 != 0 ? 61 : -61, 20000);
        }
        start();
        run_us(500);
        (void)poll(NULL);
        busy_until = TICK_NEVER - machine.epoch;
        host_machine_run(&machine, machine.now + 20 * TICKS_PER_MS - 31U * phase - 1U, poll, NULL, NULL);
        TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
        TEST_ASSERT_EQUAL_UINT(AXIS_STOPPING, atomic_load(&group.state));
        busy_until = 0;
        run_to_the_end();
        start();
        run_to_the_end();
        assert_arrived();
    }
}

/* Each vector of a step is handed over by itself. */
void test_a_step_at_a_place_is_handed_over_at_once(void)
{
    for (uint64_t phase = 0; phase < 71; phase++) {
        begin_ring(AHEAD_TICKS, LONG_RING);
        for (unsigned i = 0; i < LONG_RING; i++) {
            add(1, 0, 0, 0, 1201);
        }
        start();
        run_us(2000);
        (void)poll(NULL);
        busy_until = TICK_NEVER - machine.epoch;
        host_machine_run(&machine, machine.now + 20 * TICKS_PER_MS - 997U * phase - 1U, poll, NULL, NULL);
        TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
        TEST_ASSERT_EQUAL_UINT(AXIS_STOPPING, atomic_load(&group.state));
        busy_until = 0;
        run_to_the_end();
        start();
        run_to_the_end();
        assert_arrived();
    }
}

void test_the_speed_at_a_step_is_that_of_the_path(void)
{
    begin_fast(2000);
    TEST_ASSERT_EQUAL_UINT32(200000 * PATH_SPEED_UNITS, group_speed_at(&group, 0, 30000));
    TEST_ASSERT_UINT32_WITHIN(1, 100000 * PATH_SPEED_UNITS, group_speed_at(&group, 0, 5000));
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    run_to_the_end();
}

/* ---- without main ---------------------------------------------------------------------------------------------- */

/* Down from 200 000 steps/s in 20 000 steps; the first 0.33 ms take 66. */
static void expect_stop_from(int64_t at)
{
    run_busy();
    run_to_the_end();
    TEST_ASSERT_INT64_WITHIN(3, at + 66 + 20000, position[0]);
    start();
    run_to_the_end();
    assert_arrived();
}

void test_a_stop_needs_no_pass_of_main(void)
{
    begin_fast(2000);
    be_busy();
    int64_t at = position[0];
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    expect_stop_from(at);
}

void test_a_stop_by_an_input_needs_no_pass_of_main(void)
{
    begin_fast(2000);
    be_busy();
    int64_t at = position[0];
    TEST_ASSERT_TRUE(group_stop_isr(&group, AXIS_CAUSE_HIGH));
    group_plan_isr(&group);
    expect_stop_from(at);
}

void test_after_a_stop_that_takes_effect_in_short_vectors_main_may_stay_away(void)
{
    begin_fast(20);
    while (group.path.laid < 2) {
        run_us(1000);
    }
    uint64_t border = ring[1].entered.high - machine.epoch;
    host_machine_run(&machine, border - 300U * TICKS_PER_US, poll, NULL, NULL);
    be_busy();
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    run_busy();
    run_to_the_end();
    TEST_ASSERT_TRUE(group_has_rest(&group));
    start();
    run_to_the_end();
    assert_arrived();
}

void test_other_speeds_need_no_pass_of_main(void)
{
    uint32_t speed = 150000;
    const struct group_speeds speeds = {.of = slow, .context = &speed};
    begin_fast(2000);
    be_busy();
    group_set_speeds(&group, &speeds);
    TEST_ASSERT_FALSE(group.speeds_wait);
    run_busy();
    run_to_the_end();
    assert_arrived();
}

/* ---- speeds that cannot take effect ----------------------------------------------------------------------------- */

void test_a_group_that_stands_or_comes_to_rest_takes_speeds_at_once(void)
{
    uint32_t speed = 5000;
    const struct group_speeds speeds = {.of = slow, .context = &speed};
    add(300, 0, 0, 0, 50000);
    group_set_speeds(&group, &speeds);
    TEST_ASSERT_FALSE(group.speeds_wait);
    TEST_ASSERT_EQUAL_UINT32(5000 * PATH_SPEED_UNITS, ring[0].vector.speed);
    start();
    uint64_t end_tick = TICK_NEVER;
    while (!path_is_laid(&group.path)) {
        run_us(1000);
    }
    end_tick = group_end_tick(&group) - machine.epoch;
    host_machine_run(&machine, end_tick - 200U * TICKS_PER_US, poll, NULL, NULL);
    speed = 7000;
    group_set_speeds(&group, &speeds);
    TEST_ASSERT_FALSE(group.speeds_wait);
    TEST_ASSERT_EQUAL_UINT32(7000 * PATH_SPEED_UNITS, ring[0].vector.speed);
    run_to_the_end();
    assert_arrived();
}

void test_a_group_that_is_being_stopped_takes_speeds_at_once(void)
{
    uint32_t speed = 5000;
    const struct group_speeds speeds = {.of = slow, .context = &speed};
    add(3000, 0, 0, 0, 50000);
    start();
    run_us(100000);
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    group_set_speeds(&group, &speeds);
    TEST_ASSERT_FALSE(group.speeds_wait);
    TEST_ASSERT_EQUAL_UINT32(5000 * PATH_SPEED_UNITS, ring[0].vector.speed);
    run_to_the_end();
}
