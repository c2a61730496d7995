/* The drive of one motor, on the host machine. */
#include <string.h>

#include "base_tick.h"
#include "hal_run.h"
#include "hal_time.h"
#include "host_machine.h"
#include "pos_drive.h"
#include "unity.h"

enum {
    MOTOR = 2,
    ACCEL = 1000000 * STEP_ACCEL_PER_ACCEL,
    AHEAD_TICKS = 512 * TICKS_PER_US,
    START_TICKS = TICKS_PER_MS,
};

#define SPEED(steps_per_s) ((uint32_t)(steps_per_s) * PATH_SPEED_UNITS)
#define SECTION ((uint64_t)INT32_MAX)

static struct host_machine machine;
static struct pos_drive drive;
static struct hal_client client;
static int64_t position;
static uint64_t last_tick; /* of the last pulse */

static unsigned lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    (void)context;
    (void)motor;
    return pos_drive_lay_isr(&drive, room);
}

static void tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
    if (pos_drive_stop_isr(&drive, false)) {
        hal_run_plan();
    }
}

static void plan_isr(void *context)
{
    (void)context;
    pos_drive_plan_isr(&drive);
}

static void step_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    TEST_ASSERT_EQUAL_UINT(MOTOR, motor);
    position += backward ? -1 : 1;
    last_tick = tick;
}

static uint64_t poll(void *context)
{
    (void)context;
    return pos_drive_poll(&drive);
}

static void begin(uint64_t epoch)
{
    host_machine_init(&machine, epoch);
    machine.ahead_ticks = AHEAD_TICKS;
    machine.listener = (struct host_listener){.step = step_seen};
    host_machine_select(&machine);
    memset(&drive, 0xA5, sizeof drive);
    pos_drive_init(&drive, MOTOR);
    client = (struct hal_client){.lay_isr = lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    hal_run_start(&client);
    position = 0;
    last_tick = 0;
}

void setUp(void)
{
    begin(0);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

static void aim(uint64_t pulses, bool backward)
{
    pos_drive_aim(&drive, &(struct pos_measure){.pulses = pulses, .accel = ACCEL, .backward = backward});
}

static void start(uint32_t speed)
{
    pos_drive_start(&drive, speed, machine.epoch + machine.now + START_TICKS);
}

static uint64_t be_late(void *context)
{
    (void)context;
    return TICK_NEVER;
}

static void run_ms_without_main(uint64_t ms)
{
    host_machine_run(&machine, machine.now + ms * TICKS_PER_MS, be_late, NULL, NULL);
}

static void run_ms(uint64_t ms)
{
    host_machine_run(&machine, machine.now + ms * TICKS_PER_MS, poll, NULL, NULL);
}

void test_a_drive_stands_at_0_with_nothing_to_make(void)
{
    TEST_ASSERT_EQUAL_UINT8(MOTOR, drive.motor);
    TEST_ASSERT_EQUAL_INT64(0, pos_drive_steps(&drive));
    TEST_ASSERT_EQUAL_UINT64(0, pos_drive_left(&drive));
    TEST_ASSERT_FALSE(pos_drive_is_busy(&drive));
    TEST_ASSERT_FALSE(pos_drive_is_stirred(&drive));
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, pos_drive_poll(&drive));
    TEST_ASSERT_EQUAL_UINT32(POS_DRIVE_SECTIONS, group_room(&drive.group));
}

void test_a_measure_is_made_to_its_last_pulse_both_ways(void)
{
    aim(1000, false);
    TEST_ASSERT_EQUAL_UINT64(1000, pos_drive_left(&drive));
    start(SPEED(10000));
    run_ms(1000);
    TEST_ASSERT_TRUE(pos_drive_take_end(&drive));
    TEST_ASSERT_FALSE(pos_drive_take_end(&drive));
    TEST_ASSERT_EQUAL_INT64(1000, pos_drive_steps(&drive));
    TEST_ASSERT_EQUAL_UINT64(last_tick, pos_drive_end_tick(&drive));
    aim(1500, true);
    start(SPEED(10000));
    run_ms(1000);
    TEST_ASSERT_TRUE(pos_drive_take_end(&drive));
    TEST_ASSERT_EQUAL_INT64(-500, position);
    TEST_ASSERT_EQUAL_UINT64(0, pos_drive_left(&drive));
    TEST_ASSERT_EQUAL_UINT64(last_tick, pos_drive_end_tick(&drive));
}

void test_the_longest_measure_fills_the_ring_and_the_rest_waits_for_room(void)
{
    const uint64_t pulses = UINT64_C(1) << 40U;
    aim(pulses, true);
    TEST_ASSERT_EQUAL_UINT32(0, group_room(&drive.group));
    TEST_ASSERT_EQUAL_UINT64(pulses - POS_DRIVE_SECTIONS * SECTION, drive.to_add);
    TEST_ASSERT_EQUAL_UINT64(pulses, pos_drive_left(&drive));
    start(SPEED(10000));
    run_ms(1000);
    TEST_ASSERT_EQUAL_UINT32(SPEED(10000), pos_drive_speed(&drive));
    pos_drive_hold(&drive);
    run_ms(100);
    TEST_ASSERT_TRUE(pos_drive_take_end(&drive));
    TEST_ASSERT_EQUAL_UINT64(pulses + (uint64_t)position, pos_drive_left(&drive));
    TEST_ASSERT_EQUAL_UINT64(pulses - POS_DRIVE_SECTIONS * SECTION, drive.to_add);
    aim(10, false);
    TEST_ASSERT_EQUAL_UINT64(0, drive.to_add);
    int64_t stood = position;
    start(SPEED(10000));
    run_ms(100);
    TEST_ASSERT_EQUAL_INT64(stood + 10, position);
}

void test_a_measure_longer_than_a_section_has_its_rest_in_the_next_one(void)
{
    aim(SECTION + 1U, false);
    TEST_ASSERT_EQUAL_UINT64(0, drive.to_add);
    TEST_ASSERT_EQUAL_UINT32(POS_DRIVE_SECTIONS - 2U, group_room(&drive.group));
    aim(SECTION, false);
    TEST_ASSERT_EQUAL_UINT32(POS_DRIVE_SECTIONS - 1U, group_room(&drive.group));
}

/* A section of 2^31 pulses takes hours, so the ring is looked at. From a speed v one stands after v^2 / 2a. */
void test_a_section_may_be_left_as_fast_as_the_rest_allows(void)
{
    aim(SECTION + 100U, false);
    TEST_ASSERT_FALSE(drive.ring[0].vector.straight);
    TEST_ASSERT_TRUE(drive.ring[1].vector.straight);
    pos_drive_start(&drive, SPEED(100000), machine.epoch + machine.now + START_TICKS);
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(2) * 1000000 * 100 * PATH_SPEED_UNITS * PATH_SPEED_UNITS, drive.ring[0].exit2);
}

/* Of a measure that has been handed over but for five pulses. */
void test_the_rest_is_handed_over_when_there_is_room(void)
{
    aim(10, true);
    drive.to_add = 5;
    start(SPEED(1000));
    run_ms(1);
    TEST_ASSERT_EQUAL_UINT64(0, drive.to_add);
    run_ms(100);
    TEST_ASSERT_EQUAL_INT64(-15, position);
}

/* ---- when it is polled ------------------------------------------------------------------------------------------ */

static void assert_stirred_until_the_poll(void)
{
    TEST_ASSERT_TRUE(pos_drive_is_stirred(&drive));
    (void)pos_drive_poll(&drive);
    TEST_ASSERT_FALSE(pos_drive_is_stirred(&drive));
}

void test_whatever_changes_the_plan_stirs_the_drive_until_it_is_polled(void)
{
    aim(100000, false);
    start(SPEED(10000));
    assert_stirred_until_the_poll();
    run_ms(50);
    pos_drive_change(&drive, SPEED(5000));
    assert_stirred_until_the_poll();
    run_ms(50);
    pos_drive_hold(&drive);
    assert_stirred_until_the_poll();
    run_ms(1);
    TEST_ASSERT_TRUE(pos_drive_resume(&drive, SPEED(5000)));
    assert_stirred_until_the_poll();
    run_ms(50);
    pos_drive_fault(&drive);
    assert_stirred_until_the_poll();
    run_ms(50);
    TEST_ASSERT_TRUE(pos_drive_take_end(&drive));
}

/* What it returns is what was found the last time, as long as nothing has happened. */
void test_a_drive_in_a_cruise_is_looked_at_when_it_has_said_or_something_has_happened(void)
{
    aim(100000, false);
    start(SPEED(1000));
    run_ms(100);
    uint64_t now = hal_time_now();
    drive.wake_tick = now + 1U;
    TEST_ASSERT_EQUAL_UINT64(now + 1U, pos_drive_poll(&drive));
    drive.wake_tick = now;
    TEST_ASSERT_TRUE(pos_drive_poll(&drive) > now + 1U);
    drive.wake_tick = now + 1U;
    drive.room++;
    TEST_ASSERT_TRUE(pos_drive_poll(&drive) > now + 1U);
    drive.wake_tick = now + 1U;
    TEST_ASSERT_EQUAL_UINT64(now + 1U, pos_drive_poll(&drive));
    drive.stirred = true;
    TEST_ASSERT_TRUE(pos_drive_poll(&drive) > now + 1U);
}

/* 10 000 steps/s are left within 50 steps. */
void test_a_stop_of_the_tick_interrupt_does_not_wait_for_main(void)
{
    aim(100000, false);
    start(SPEED(10000));
    run_ms(50);
    int64_t before = position;
    host_machine_set_input(&machine, 1, true);
    run_ms_without_main(3);
    run_ms(20);
    TEST_ASSERT_TRUE(pos_drive_take_end(&drive));
    TEST_ASSERT_INT64_WITHIN(5, before + 50, position);
}

void test_the_speed_is_0_before_the_start_and_at_rest(void)
{
    aim(1000, false);
    TEST_ASSERT_EQUAL_UINT32(0, pos_drive_speed(&drive));
    start(SPEED(10000));
    TEST_ASSERT_EQUAL_UINT32(0, pos_drive_speed(&drive));
    run_ms(50);
    TEST_ASSERT_EQUAL_UINT32(SPEED(10000), pos_drive_speed(&drive));
    run_ms(1000);
    TEST_ASSERT_TRUE(pos_drive_take_end(&drive));
    TEST_ASSERT_EQUAL_UINT32(0, pos_drive_speed(&drive));
}

void test_the_speed_is_that_of_the_start_from_the_start_on(void)
{
    pos_drive_aim(&drive, &(struct pos_measure){.pulses = 1000, .accel = ACCEL, .start_speed = SPEED(50)});
    start(SPEED(10000));
    TEST_ASSERT_EQUAL_UINT32(0, pos_drive_speed(&drive));
    run_ms(1);
    TEST_ASSERT_EQUAL_UINT64(drive.start_tick, hal_time_now());
    TEST_ASSERT_EQUAL_UINT32(SPEED(50), pos_drive_speed(&drive));
}

/* Two changes between the first pulse and the second: the speed of the first has been noted. */
void test_the_speed_is_not_that_of_a_motion_before(void)
{
    aim(3, false);
    start(SPEED(10));
    run_ms(150);
    TEST_ASSERT_EQUAL_INT64(1, position);
    pos_drive_change(&drive, SPEED(20));
    pos_drive_change(&drive, SPEED(10));
    TEST_ASSERT_EQUAL_UINT32(SPEED(10), pos_drive_speed(&drive));
    run_ms(500);
    TEST_ASSERT_TRUE(pos_drive_take_end(&drive));
    aim(1000, false);
    start(SPEED(100));
    run_ms(15);
    TEST_ASSERT_EQUAL_INT64(4, position);
    TEST_ASSERT_EQUAL_UINT32(SPEED(100), pos_drive_speed(&drive));
}

void test_only_what_is_held_can_be_resumed(void)
{
    aim(100000, false);
    start(SPEED(10000));
    run_ms(50);
    TEST_ASSERT_FALSE(pos_drive_resume(&drive, SPEED(5000)));
    pos_drive_hold(&drive);
    run_ms(2);
    TEST_ASSERT_TRUE(pos_drive_resume(&drive, SPEED(5000)));
    run_ms(50);
    TEST_ASSERT_EQUAL_UINT32(SPEED(5000), pos_drive_speed(&drive));
    host_machine_set_input(&machine, 1, true);
    run_ms(2);
    TEST_ASSERT_FALSE(pos_drive_resume(&drive, SPEED(5000)));
    run_ms(50);
    TEST_ASSERT_TRUE(pos_drive_take_end(&drive));
    TEST_ASSERT_FALSE(pos_drive_resume(&drive, SPEED(5000)));
}

/* On a ramp whose next pulse is seconds ahead neither a change nor a stop can be planned. */
static void wait_for_a_far_pulse(void)
{
    pos_drive_aim(&drive, &(struct pos_measure){.pulses = 3, .accel = ACCEL / 10000});
    start(SPEED(7));
    run_ms(75);
    pos_drive_change(&drive, SPEED(1) / 4U);
    run_ms(30);
    TEST_ASSERT_EQUAL_INT64(0, position);
}

void test_a_hold_that_is_taken_back_before_it_is_planned_keeps_the_change_that_waits(void)
{
    wait_for_a_far_pulse();
    pos_drive_change(&drive, SPEED(7));
    pos_drive_hold(&drive);
    run_ms(2);
    TEST_ASSERT_TRUE(pos_drive_resume(&drive, SPEED(7)));
    run_ms(800);
    TEST_ASSERT_EQUAL_INT64(3, position);
    TEST_ASSERT_TRUE(pos_drive_take_end(&drive));
}

void test_a_hold_that_is_taken_back_before_it_is_planned_takes_the_speed_that_is_wanted_then(void)
{
    wait_for_a_far_pulse();
    pos_drive_hold(&drive);
    run_ms(2);
    TEST_ASSERT_TRUE(pos_drive_resume(&drive, SPEED(7)));
    run_ms(800);
    TEST_ASSERT_EQUAL_INT64(3, position);
    TEST_ASSERT_TRUE(pos_drive_take_end(&drive));
}

void test_a_fault_brakes_with_its_own_acceleration_also_while_it_is_held(void)
{
    pos_drive_aim(&drive, &(struct pos_measure){.pulses = 100000, .accel = ACCEL / 100, .fault_accel = ACCEL});
    start(SPEED(10000));
    run_ms(2000);
    pos_drive_hold(&drive);
    run_ms(20);
    int64_t before = position;
    pos_drive_fault(&drive);
    run_ms(50);
    TEST_ASSERT_TRUE(pos_drive_take_end(&drive));
    TEST_ASSERT_INT64_WITHIN(20, before + 50, position);
}

void test_a_motion_that_is_held_before_its_first_pulse_ends_at_its_start(void)
{
    begin(UINT64_C(0x1FFFFFFFF) - START_TICKS);
    aim(1000, false);
    start(SPEED(10000));
    pos_drive_hold(&drive);
    run_ms(100);
    TEST_ASSERT_TRUE(pos_drive_take_end(&drive));
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(0x1FFFFFFFF), pos_drive_end_tick(&drive));
    TEST_ASSERT_EQUAL_INT64(0, position);
}

/* The curve is at its end some fraction of a tick before or after the tick of the last pulse. */
void test_a_measure_ends_with_its_last_pulse_and_a_hold_after_it(void)
{
    unsigned later = 0;
    for (unsigned i = 0; i < 200; i++) {
        begin(i);
        aim(10 + i, i % 2U != 0);
        start(SPEED(1000) + 37U * i);
        run_ms(1000);
        TEST_ASSERT_TRUE(pos_drive_take_end(&drive));
        later += last_tick + machine.epoch == group_end_tick(&drive.group) + 1U;
        TEST_ASSERT_EQUAL_UINT64(last_tick + machine.epoch, pos_drive_end_tick(&drive));
    }
    TEST_ASSERT_GREATER_THAN_UINT(0, later);
    aim(1000, false);
    start(SPEED(9999));
    run_ms(50);
    pos_drive_hold(&drive);
    run_ms(50);
    TEST_ASSERT_TRUE(pos_drive_take_end(&drive));
    TEST_ASSERT_EQUAL_UINT64(group_end_tick(&drive.group), pos_drive_end_tick(&drive));
    TEST_ASSERT_TRUE(pos_drive_end_tick(&drive) > last_tick + machine.epoch + 1U);
}
