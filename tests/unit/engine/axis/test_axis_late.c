#include "base_tick.h"
#include "mock_hal_driver.h"
#include "mock_hal_run.h"
#include "mock_hal_step.h"
#include "mock_hal_time.h"
#include "mock_hal_trace.h"
#include "axis.h"
#include "unity.h"

#include "late_rig.h"

/* Changes of speed that are planned late, and a queue that is filled late. */

void setUp(void)
{
    hal_driver_enable_Ignore();
    late_rig_init();
}

void tearDown(void)
{
}

/* The pulse after which the interval is another. */
static unsigned first_change(void)
{
    unsigned k = 1;
    while (pulse_tick[k] - pulse_tick[k - 1U] == pulse_tick[1] - pulse_tick[0]) {
        k++;
    }
    return k;
}

void test_a_change_of_speed_takes_effect_at_the_first_pulse_that_leaves_the_lead(void)
{
    start(&fast, 10);
    lead_ticks = 2 * 5250 + 1;

    change_speed(8000);
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT(13, first_change());
}

void test_planning_within_the_lead_is_in_time_at_the_first_try(void)
{
    start(&fast, 10);
    lead_ticks = 2 * 5250 + 1;
    planning_ticks = 2 * 5250;

    change_speed(8000);
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT(13, first_change());
    TEST_ASSERT_EQUAL_UINT(1, cuts_tried);
}

/* The lead ends at pulse 12, planning lasts nearly until pulse 13; the second lead, twice as long and 1 us, ends just
 * after pulse 16. */
void test_planning_that_takes_longer_than_the_lead_is_tried_again_with_twice_the_lead(void)
{
    start(&fast, 10);
    lead_ticks = 5250 + 2625;
    planning_ticks = 3 * 5250 - 1;

    change_speed(8000);
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT(17, first_change());
    TEST_ASSERT_EQUAL_UINT(2, cuts_tried);
}

void test_a_change_of_speed_that_was_tried_again_keeps_the_target(void)
{
    start(&fast, 10);
    lead_ticks = 5250 + 2625;
    planning_ticks = 3 * 5250 - 1;

    change_speed(8000);
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(1000, pulses);
    TEST_ASSERT_EQUAL_UINT(2, cuts_tried);
    TEST_ASSERT_EQUAL_UINT(1, changes_traced);
}

void test_a_change_that_is_planned_after_the_end_of_the_move_changes_nothing(void)
{
    start(&fast, 10);
    lead_ticks = 1;
    planning_ticks = 1000 * 5250;

    change_speed(8000);

    TEST_ASSERT_EQUAL_UINT(1, cuts_tried);
    TEST_ASSERT_EQUAL_UINT(0, changes_traced);
    run_to_the_end();
    TEST_ASSERT_EQUAL_UINT64(1000, pulses);
}

void test_a_change_of_speed_that_cannot_be_planned_within_a_second_is_given_up(void)
{
    static const struct motion_order slow = {
        .section = {{1000, 100, 2000}},
        .start_speed_steps_per_s = 100,
        .sections = 1,
    };
    start(&slow, 10);
    lead_ticks = (TICK_HZ - TICKS_PER_US) / 2U;
    planning_ticks = 2U * (uint64_t)TICK_HZ;

    change_speed(50);
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT(1, cuts_tried);
    TEST_ASSERT_EQUAL_UINT(0, changes_traced);
    TEST_ASSERT_EQUAL_UINT64(1000, pulses);
}

void test_a_change_of_speed_that_the_move_ends_before_is_not_traced(void)
{
    start(&fast, 998);
    lead_ticks = 3 * 5250;

    change_speed(8000);
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT(0, changes_traced);
    TEST_ASSERT_EQUAL_UINT64(1000, pulses);
}

/* Ten sections of one step: a cut hands over the first two, and before main comes to the rest they are used up. */
static void run_dry(void)
{
    struct motion_order order = {.start_speed_steps_per_s = 16000, .sections = MOTION_SECTIONS};
    for (unsigned i = 0; i < MOTION_SECTIONS; i++) {
        order.section[i] = (struct motion_section){1, 16000, 60000};
    }
    start(&order, 1);
    handing_ticks = 6 * 5250;

    change_speed(15999);
    TEST_ASSERT_FALSE(is_waiting());
}

/* Pulse 2 is the next one when the change comes. */
void test_a_change_hands_over_two_segments_for_the_time_until_main_lays_the_others(void)
{
    run_dry();

    TEST_ASSERT_EQUAL_UINT64(2 + 2, pulses);
    run_to_the_end();
}

void test_a_queue_that_ran_dry_after_a_cut_is_filled_and_goes_on(void)
{
    run_dry();

    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(MOTION_SECTIONS, pulses);
    TEST_ASSERT_EQUAL_INT64(MOTION_SECTIONS, axis_position_steps(&axis));
}

void test_a_queue_that_ran_dry_goes_on_as_soon_as_it_is_fed(void)
{
    run_dry();

    TEST_ASSERT_TRUE(axis_feed(&axis));
    TEST_ASSERT_TRUE(is_waiting());
    run_to_the_end();

    TEST_ASSERT_EQUAL_UINT64(MOTION_SECTIONS, pulses);
}
