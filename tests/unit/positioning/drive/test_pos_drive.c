/* The drive of one motor, on the host machine. */
#include "base_tick.h"
#include "hal_run.h"
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

static void run_ms(uint64_t ms)
{
    host_machine_run(&machine, machine.now + ms * TICKS_PER_MS, poll, NULL, NULL);
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
