/* What a pass of main does for a group: what it hands over, what it drops, when it wants the next one. */
#include "group_rig.h"

void setUp(void)
{
    begin(AHEAD_TICKS);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

/* Time goes by without a pass, up to a tick of the unit's time. */
static void run_alone_to(uint64_t tick)
{
    busy_until = TICK_NEVER - machine.epoch;
    host_machine_run(&machine, tick - machine.epoch, poll, NULL, NULL);
    TEST_ASSERT_EQUAL_UINT64(tick, hal_time_now());
}

static uint32_t handed_over(unsigned motor)
{
    return STEP_QUEUE_SEGMENTS - step_channel_room(&channels[motor]);
}

/* ---- what is handed over --------------------------------------------------------------------------------------- */

void test_a_pass_hands_over_all_that_is_due_within_20_ms(void)
{
    for (unsigned i = 0; i < RING; i++) {
        add(0, 0, 20, 0, 10000);
    }
    start();
    uint64_t until = hal_time_now() + 20 * TICKS_PER_MS;
    uint32_t due = 0;
    while (due < group.path.laid && ring[due].entered.high < until) {
        due++;
    }
    TEST_ASSERT_LESS_THAN_UINT32(RING, due);
    TEST_ASSERT_GREATER_THAN_UINT32(5, due);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(due, handed_over(2));
}

void test_main_may_stay_away_for_20_ms(void)
{
    add(2000, -700, 300, 1, 20000);
    start();
    run_us(50000);
    for (unsigned i = 0; i < 3; i++) {
        (void)group_poll(&group);
        run_alone_to(hal_time_now() + 20 * TICKS_PER_MS);
    }
    busy_until = 0;
    run_to_the_end();
    assert_arrived();
}

void test_a_queue_is_filled_to_its_last_place(void)
{
    begin_ring(AHEAD_TICKS, LONG_RING);
    for (unsigned i = 0; i < LONG_RING; i++) {
        add(3, 0, 0, 0, 100000);
    }
    start();
    TEST_ASSERT_EQUAL_UINT32(0, step_channel_room(&channels[0]));
    run_to_the_end();
    assert_arrived();
}

void test_main_is_woken_for_half_of_a_queue(void)
{
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_UINT8(STEP_QUEUE_SEGMENTS / 2, channels[motor].wake_room);
    }
}

/* The tick of the next pass that a pass asks for; it began at `begin`. */
static uint64_t plan_for(uint64_t ticks, uint64_t *begin)
{
    static uint32_t speed = 10000;
    begin_ring(AHEAD_TICKS, LONG_RING);
    for (unsigned i = 0; i < LONG_RING; i++) {
        add(20, 10, 0, 0, 10000);
    }
    start();
    run_alone_to(hal_time_now() + 5 * TICKS_PER_MS);
    group_set_speeds(&group, &(struct group_speeds){.of = slow, .context = &speed});
    group.speeds_wait = true;
    laying_ticks = ticks;
    *begin = hal_time_now();
    uint64_t next = group_poll(&group);
    machine.late_steps = 0;
    return next;
}

void test_a_pass_that_has_had_its_time_comes_back_at_once(void)
{
    uint64_t begin;
    uint64_t next = plan_for(80 * TICKS_PER_US, &begin);
    TEST_ASSERT_EQUAL_UINT64(begin, next);
    next = plan_for(80 * TICKS_PER_US - 1, &begin);
    TEST_ASSERT_EQUAL_UINT64(begin + 80 * TICKS_PER_US - 1 + 4 * TICKS_PER_MS, next);
}

/* ---- when main is asked for ------------------------------------------------------------------------------------ */

void test_a_group_wants_a_pass_after_4_ms_or_just_after_its_end(void)
{
    add(1000, 0, 0, 0, 10000);
    start();
    uint64_t end_tick = TICK_NEVER;
    while (end_tick == TICK_NEVER) {
        run_alone_to(hal_time_now() + 3 * TICKS_PER_MS);
        uint64_t next = group_poll(&group);
        if (next != hal_time_now() + 4 * TICKS_PER_MS) {
            end_tick = next;
        }
    }
    TEST_ASSERT_LESS_THAN_UINT64(hal_time_now() + 4 * TICKS_PER_MS, end_tick);
    TEST_ASSERT_EQUAL_UINT64(group_end_tick(&group) + 1U, end_tick);
    run_alone_to(end_tick);
    (void)group_poll(&group);
    TEST_ASSERT_TRUE(group_take_end(&group));
    assert_arrived();
}

void test_a_group_that_stands_wants_none(void)
{
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, group_poll(&group));
}

/* ---- room ------------------------------------------------------------------------------------------------------ */

void test_a_section_makes_room_a_millisecond_after_its_end(void)
{
    for (unsigned i = 0; i < RING; i++) {
        add(100, 0, 0, 0, 20000);
    }
    start();
    for (uint32_t section = 1; section < RING; section++) {
        uint64_t over = ring[section].entered.high + TICKS_PER_MS;
        run_alone_to(over);
        (void)group_poll(&group);
        TEST_ASSERT_EQUAL_UINT32(section - 1U, group_first(&group));
        run_alone_to(over + 1U);
        (void)group_poll(&group);
        TEST_ASSERT_EQUAL_UINT32(section, group_first(&group));
        TEST_ASSERT_EQUAL_UINT32(section, group_room(&group));
    }
    busy_until = 0;
    run_to_the_end();
    TEST_ASSERT_EQUAL_UINT32(RING, group_room(&group));
}

/* ---- begin and end --------------------------------------------------------------------------------------------- */

void test_dir_of_each_axis_stands_from_the_start_on(void)
{
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        int32_t way[PATH_AXES] = {50, 50, 50, 50};
        way[motor] = -50;
        begin(AHEAD_TICKS);
        run_us(10);
        add(way[0], way[1], way[2], way[3], 20000);
        uint64_t now = machine.now;
        TEST_ASSERT_TRUE(group_start(&group, hal_time_now() + START_TICKS));
        TEST_ASSERT_EQUAL_UINT64(now, turned_tick[motor]);
        run_to_the_end();
        assert_arrived();
    }
}

static unsigned turns;

static void count_turn(void *context, uint64_t tick, unsigned motor, bool backward)
{
    direction_seen(context, tick, motor, backward);
    turns += motor == 1 ? 1U : 0U;
}

void test_dir_of_an_axis_without_a_pulse_stays(void)
{
    machine.listener.direction = count_turn;
    turns = 0;
    for (unsigned i = 0; i < 4; i++) {
        add(20, i % 2 == 0 ? -20 : 20, 0, 0, 20000);
        start();
        run_to_the_end();
        add(20, 0, 0, 0, 20000);
        start();
        run_to_the_end();
        TEST_ASSERT_EQUAL_UINT(i + 1U, turns);
    }
}

void test_the_drivers_are_on_from_the_start(void)
{
    add(20, 0, 0, 0, 20000);
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, machine.enabled_tick);
    start();
    TEST_ASSERT_NOT_EQUAL_UINT64(TICK_NEVER, machine.enabled_tick);
    run_to_the_end();
}

void test_what_goes_on_has_no_cause_to_end(void)
{
    add(2000, 0, 0, 0, 20000);
    start();
    run_us(50000);
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    run_to_the_end();
    start();
    TEST_ASSERT_EQUAL(AXIS_CAUSE_NONE, group_cause(&group));
    run_to_the_end();
    assert_arrived();
}

void test_a_motion_is_over_with_the_last_pulse_of_whichever_axis_though_that_is_late(void)
{
    for (unsigned axis = 0; axis < UNIT_MOTORS; axis++) {
        int32_t way[PATH_AXES] = {0};
        way[axis] = 30;
        begin(0);
        machine.faults.late_step_ticks = 3 * TICKS_PER_MS;
        add(way[0], way[1], way[2], way[3], 20000);
        start();
        run_to_the_end();
        assert_arrived();
        TEST_ASSERT_GREATER_THAN_UINT64(0, machine.late_steps);
        machine.late_steps = 0;
    }
}

void test_a_stop_before_the_first_pulse_is_over_at_once(void)
{
    add(200, 0, 0, 0, 20000);
    TEST_ASSERT_TRUE(group_start(&group, hal_time_now() + 100 * TICKS_PER_MS));
    run_us(1000);
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    run_us(100);
    TEST_ASSERT_TRUE(group_take_end(&group));
    start();
    run_to_the_end();
    assert_arrived();
}

/* At 20 steps/s the pulses of the ramp are farther apart than what is handed over ahead. */
void test_a_slow_stop_is_over_with_its_last_pulse(void)
{
    struct path_vector vector = vector_of(100, 0, 0, 0, 20);
    vector.accel = 50 * STEP_ACCEL_PER_ACCEL;
    TEST_ASSERT_TRUE(group_add(&group, &vector));
    ordered[0] = 100;
    start();
    run_us(2000000);
    int64_t at = position[0];
    TEST_ASSERT_TRUE(group_stop(&group, AXIS_CAUSE_COMMAND));
    run_to_the_end();
    TEST_ASSERT_INT64_WITHIN(1, at + 5, position[0]);
    at = position[0];
    run_us(1000000);
    TEST_ASSERT_EQUAL_INT64(at, position[0]);
    start();
    run_to_the_end();
    assert_arrived();
}

static void expect_steady_steps(void)
{
    made[0] = 0;
    add(20, 0, 0, 0, 1000);
    start();
    run_to_the_end();
    assert_arrived();
    for (unsigned i = 1; i < 20; i++) {
        TEST_ASSERT_UINT64_WITHIN(1, made_tick[0][i - 1U] + TICKS_PER_MS, made_tick[0][i]);
    }
}

void test_a_start_speed_stays_when_all_is_forgotten(void)
{
    group_set_manner(&group, &(struct group_manner){.start_speed = 1000 * PATH_SPEED_UNITS});
    expect_steady_steps();
    group_forget(&group);
    expect_steady_steps();
}

void test_a_motor_that_is_connected_again_follows_its_axis_alone(void)
{
    group_connect(&group, 3, &channels[3], 0);
    group_connect(&group, 3, &channels[3], 3);
    add(50, 0, 0, 7, 20000);
    start();
    run_to_the_end();
    assert_arrived();
}
