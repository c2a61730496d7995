/* Motors that move together on a path, on the host machine: positions, ticks and DIR at the pins. */
#include "group_rig.h"

void setUp(void)
{
    begin(AHEAD_TICKS);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

/* The path's own ticks, without a group. */
static void assert_ticks_of_the_path(uint64_t start_tick)
{
    static struct path path;
    static struct path_section sections[RING];
    path_init(&path, sections, RING, hal_step_turn_us());
    for (uint32_t i = 0; i < group_end(&group); i++) {
        TEST_ASSERT_TRUE(path_add(&path, &ring[i].vector));
    }
    TEST_ASSERT_TRUE(path_start(&path, start_tick));
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        struct step_generator generator = {0};
        struct path_segment next;
        unsigned pulse = 0;
        while (path_next(&path, axis, TICK_NEVER, &next)) {
            step_generator_load(&generator, &next.segment);
            for (uint32_t k = 0; k < next.segment.steps; k++, pulse++) {
                uint32_t tick = k == 0 ? generator.tick : step_generator_next(&generator);
                TEST_ASSERT_EQUAL_UINT32(tick, (uint32_t)(machine.epoch + made_tick[axis][pulse]));
            }
        }
        TEST_ASSERT_EQUAL_UINT(pulse, made[axis]);
    }
}

void test_every_pulse_of_a_chain_comes_at_the_tick_of_its_path(void)
{
    for (uint32_t ahead = 0; ahead <= AHEAD_TICKS; ahead += AHEAD_TICKS) {
        begin(ahead);
        add_zigzag();
        uint64_t start_tick = hal_time_now() + START_TICKS;
        start();
        run_to_the_end();
        assert_arrived();
        assert_ticks_of_the_path(start_tick);
    }
}

void test_a_group_without_vectors_does_not_start(void)
{
    TEST_ASSERT_FALSE(group_start(&group, hal_time_now() + START_TICKS));
    TEST_ASSERT_FALSE(group_is_busy(&group));
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, group_poll(&group));
}

static void hold_and_go_on(uint64_t microseconds)
{
    add_zigzag();
    start();
    run_us(microseconds);
    bool stops = group_stop(&group, AXIS_CAUSE_COMMAND);
    TEST_ASSERT_EQUAL(group_is_busy(&group) && group_cause(&group) == AXIS_CAUSE_COMMAND, stops);
    run_to_the_end();
    int64_t rest[UNIT_MOTORS] = {position[0], position[1], position[2], position[3]};
    run_us(20000);
    TEST_ASSERT_EQUAL_INT64_ARRAY(rest, position, UNIT_MOTORS);
    if (group_has_rest(&group)) {
        start();
        run_to_the_end();
    }
    assert_arrived();
}

void test_a_path_that_was_stopped_at_any_time_goes_on_to_its_end(void)
{
    for (uint32_t ahead = 0; ahead <= AHEAD_TICKS; ahead += AHEAD_TICKS) {
        for (uint64_t us = 100; us < 260000; us += 1777) {
            begin(ahead);
            hold_and_go_on(us);
        }
    }
}

void test_a_stop_takes_effect_within_half_a_millisecond(void)
{
    for (uint64_t us = 60000; us < 70000; us += 97) {
        begin(AHEAD_TICKS);
        add(5000, 0, 0, 0, 50000);
        start();
        run_us(us);
        TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
        uint64_t asked = machine.now;
        int64_t at = position[0];
        run_to_the_end();
        /* 50 000 steps/s for 0.5 ms, a step, and 1250 steps of the ramp */
        TEST_ASSERT_LESS_OR_EQUAL_INT64(at + 25 + 1 + 1250, position[0]);
        TEST_ASSERT_LESS_OR_EQUAL_UINT64(asked + 51 * TICKS_PER_MS, made_tick[0][made[0] - 1U]);
    }
}

void test_an_input_stops_the_path_by_the_plan_interrupt(void)
{
    add_zigzag();
    start();
    run_us(20000);
    stop_asked = true;
    tick_isr(NULL, hal_time_now());
    TEST_ASSERT_EQUAL_INT(AXIS_CAUSE_HIGH, group_cause(&group));
    run_to_the_end();
    TEST_ASSERT_TRUE(group_has_rest(&group));
    stop_asked = false;
    start();
    run_to_the_end();
    assert_arrived();
}

void test_a_second_stop_changes_nothing(void)
{
    add_zigzag();
    start();
    run_us(20000);
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    TEST_ASSERT_FALSE(group_stop(&group, AXIS_CAUSE_HIGH));
    run_to_the_end();
    TEST_ASSERT_EQUAL_INT(AXIS_CAUSE_COMMAND, group_cause(&group));
    TEST_ASSERT_FALSE(group_stop(&group, AXIS_CAUSE_FAULT));
}

void test_what_is_forgotten_after_a_stop_is_not_made(void)
{
    add_zigzag();
    start();
    run_us(20000);
    (void)group_stop(&group, AXIS_CAUSE_COMMAND);
    run_to_the_end();
    group_forget(&group);
    TEST_ASSERT_FALSE(group_has_rest(&group));
    TEST_ASSERT_EQUAL_UINT32(RING, group_room(&group));
    int64_t at = position[0];
    add(-100, 0, 0, 0, 5000);
    start();
    run_to_the_end();
    TEST_ASSERT_EQUAL_INT64(at - 100, position[0]);
}

void test_speeds_change_at_any_time_and_the_path_arrives(void)
{
    for (uint64_t us = 100; us < 120000; us += 1777) {
        uint32_t speed = 3000;
        const struct group_speeds speeds = {.of = slow, .context = &speed};
        begin(AHEAD_TICKS);
        add_zigzag();
        start();
        run_us(us);
        group_set_speeds(&group, &speeds);
        run_us(7000);
        speed = 60000;
        group_set_speeds(&group, &speeds);
        run_to_the_end();
        assert_arrived();
    }
}

void test_a_slower_speed_acts_within_half_a_millisecond(void)
{
    uint32_t speed = 10000;
    const struct group_speeds speeds = {.of = slow, .context = &speed};
    add(10000, 0, 0, 0, 40000);
    start();
    run_us(80000);
    int64_t at = position[0];
    group_set_speeds(&group, &speeds);
    run_us(100000);
    /* 40 000 steps/s for 0.5 ms, down in 750 steps and 30 ms, then 10 000 steps/s */
    TEST_ASSERT_INT64_WITHIN(25, at + 20 + 750 + 700, position[0]);
    run_to_the_end();
    assert_arrived();
}

void test_vectors_that_come_while_the_path_moves_join_it(void)
{
    for (uint64_t us = 500; us < 40000; us += 1117) {
        begin(AHEAD_TICKS);
        add(400, 100, 0, 0, 20000);
        start();
        run_us(us);
        bool busy = group_is_busy(&group) && !group_take_end(&group);
        add(400, 100, 3, 0, 20000);
        add(-100, 400, 0, 9, 20000);
        if (!busy) {
            start();
        }
        run_to_the_end();
        if (group_has_rest(&group)) {
            start();
            run_to_the_end();
        }
        assert_arrived();
    }
}

void test_a_long_chain_passes_through_a_short_ring(void)
{
    unsigned added = 0;
    int32_t way = 1;
    while (group_room(&group) > 0) {
        add(60, 60 * way, 20, -7, 30000);
        way = -way;
        added++;
    }
    start();
    while (added < 300) {
        run_us(2000);
        while (group_room(&group) > 0 && added < 300) {
            add(60, 60 * way, 20, -7, 30000);
            way = -way;
            added++;
        }
    }
    run_to_the_end();
    assert_arrived();
}

void test_two_motors_may_follow_one_axis(void)
{
    group_connect(&group, 3, &channels[3], 1);
    add(500, -200, 30, 0, 20000);
    start();
    run_to_the_end();
    TEST_ASSERT_EQUAL_INT64(-200, position[3]);
    TEST_ASSERT_EQUAL_UINT64_ARRAY(made_tick[1], made_tick[3], 200);
}
