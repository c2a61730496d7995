/* A hold at any time after a change to a tiny feed: it stands, and no pulse comes at a wrong time. */
#include "pos_rig.h"

enum {
    HOLD_MS = 400,
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
