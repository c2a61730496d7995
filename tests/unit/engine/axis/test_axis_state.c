/* The table of the states: what the header shows is what the code says, entry by entry. */
#include "axis_state.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void assert_row(enum axis_state state, const enum axis_state expected[AXIS_EVENTS])
{
    for (unsigned event = 0; event < AXIS_EVENTS; event++) {
        TEST_ASSERT_EQUAL_INT(expected[event], axis_state_next(state, (enum axis_event)event));
    }
}

void test_a_standing_axis_can_begin_or_be_refused(void)
{
    assert_row(AXIS_STANDING, (enum axis_state[AXIS_EVENTS]){[AXIS_BEGIN] = AXIS_MOVING, [AXIS_REFUSE] = AXIS_ENDED});
}

void test_a_moving_axis_can_be_stopped_halted_or_come_to_its_end(void)
{
    assert_row(AXIS_MOVING, (enum axis_state[AXIS_EVENTS]){
                                [AXIS_STOP] = AXIS_BRAKING, [AXIS_HALT] = AXIS_STOPPING, [AXIS_LAST] = AXIS_ENDED});
}

void test_a_braking_axis_takes_no_second_stop(void)
{
    assert_row(AXIS_BRAKING,
               (enum axis_state[AXIS_EVENTS]){
                   [AXIS_PLANNED] = AXIS_STOPPING, [AXIS_RESUME] = AXIS_MOVING, [AXIS_LAST] = AXIS_ENDED});
}

void test_a_stopping_axis_comes_to_rest_or_is_resumed(void)
{
    assert_row(AXIS_STOPPING, (enum axis_state[AXIS_EVENTS]){[AXIS_RESUME] = AXIS_MOVING, [AXIS_LAST] = AXIS_ENDED});
}

void test_an_ended_axis_waits_for_its_owner(void)
{
    assert_row(AXIS_ENDED, (enum axis_state[AXIS_EVENTS]){[AXIS_TAKE] = AXIS_STANDING});
}

void test_no_event_leads_out_of_no_state(void)
{
    TEST_ASSERT_EQUAL_INT(6, AXIS_STATES);
    for (unsigned event = 0; event < AXIS_EVENTS; event++) {
        TEST_ASSERT_EQUAL_INT(AXIS_SAME, axis_state_next(AXIS_SAME, (enum axis_event)event));
    }
}
