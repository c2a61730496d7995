/* Holds at any time after a change to a slow feed: it stands, goes on, and no pulse comes at a wrong time. */
#include "pos_rig.h"

#include "hal_time.h"

enum {
    HOLD_MS = 400,
    START_TICKS = 580 * TICKS_PER_US, /* after the pass in which a feed came */
};

void setUp(void)
{
}

void tearDown(void)
{
}

static void change_then_hold(uint64_t change_us, uint64_t hold_us)
{
    rig_set_up();
    rig_run_ms(10);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 3, 0));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, -10934, 1539, 3));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, UINT32_C(705) << 16U, 1, 3));
    rig_run_ticks(change_us * TICKS_PER_US);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, 29, 1, 3));
    rig_run_ticks(hold_us * TICKS_PER_US);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, 29, 0, 3));
    rig_run_ms(HOLD_MS);
    TEST_ASSERT_EQUAL_HEX(0x0203, rig_status(3));
}

void test_a_hold_after_a_change_to_a_tiny_feed_stands_and_makes_no_pulse_late(void)
{
    for (uint64_t change_us = 600; change_us < 12000; change_us += 300) {
        for (uint64_t hold_us = 0; hold_us < 20000; hold_us += 500) {
            change_then_hold(change_us, hold_us);
        }
    }
}

/* Below the start feed it stands at once, at a place that is planned ahead: in the cruise that a ramp is about to end
 * in. */
static void slow_down(unsigned axis, uint64_t hold_us)
{
    const uint16_t start_feed[] = {120, 0};
    rig_set_up();
    rig_run_ms(10);
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, positioning_write(&unit, 38U + 100U * axis, 2, start_feed));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, axis, 0));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 2000, 500, axis));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, UINT32_C(1200) << 16U, 1, axis));
    rig_run_ms(70);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, UINT32_C(60) << 16U, 1, axis));
    rig_run_ticks(hold_us * TICKS_PER_US);
}

static void control(unsigned axis, int mp)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, UINT32_C(60) << 16U, mp, axis));
}

static void hold(unsigned axis)
{
    control(axis, 0);
    rig_run_ticks(4 * TICKS_PER_US);
}

void test_a_hold_that_is_taken_back_at_once_brings_no_pulse_sooner(void)
{
    static uint64_t undisturbed[RIG_PULSES];
    slow_down(3, 0);
    rig_run_ms(HOLD_MS);
    uint64_t begin = rig_tick[2][0];
    unsigned count = rig_pulses[2];
    memcpy(undisturbed, rig_tick[2], sizeof undisturbed);
    TEST_ASSERT_GREATER_THAN_UINT(100, count);
    for (uint64_t hold_us = 33000; hold_us < 38000; hold_us += 25) {
        slow_down(3, hold_us);
        hold(3);
        control(3, 1);
        rig_run_ms(HOLD_MS);
        for (unsigned i = 0; i < rig_pulses[2] && i < count; i++) {
            TEST_ASSERT_TRUE(rig_tick[2][i] - rig_tick[2][0] + 1U >= undisturbed[i] - begin);
        }
    }
}

/* Of holds at many times those that end in a stand which is too far ahead for the start; at once after the hold, or as
 * late as may be. Returns how many. */
static unsigned start_after_stands(unsigned axis, bool late)
{
    const struct pos_drive *drive = &unit.axes[axis - 1U].drive;
    unsigned starts = 0;
    for (uint64_t hold_us = 35000; hold_us < 36000; hold_us += 25) {
        slow_down(axis, hold_us);
        hold(axis);
        uint64_t motion_tick = drive->start_tick;
        uint64_t rest_tick = pos_drive_rest_tick(drive);
        uint64_t soonest_tick = hal_time_now() + START_TICKS;
        if (late && rest_tick > soonest_tick) {
            rig_run_ticks(rest_tick - soonest_tick);
        }
        control(axis, 1);
        rig_run_ticks(1);
        if (rest_tick >= soonest_tick && drive->start_tick != motion_tick) {
            starts++;
            TEST_ASSERT_EQUAL_UINT64(rest_tick + 1U, drive->start_tick);
        }
    }
    return starts;
}

void test_a_start_that_would_come_before_the_stand_comes_a_tick_after_it(void)
{
    for (unsigned axis = 1; axis <= (unsigned)POS_AXES; axis++) {
        TEST_ASSERT_GREATER_OR_EQUAL_UINT(2, start_after_stands(axis, false));
        TEST_ASSERT_GREATER_OR_EQUAL_UINT(2, start_after_stands(axis, true));
    }
}
