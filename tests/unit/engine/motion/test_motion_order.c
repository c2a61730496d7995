/* Orders of moves and of runs without end. */
#include "motion_order.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

void test_an_order_of_an_endless_section_has_no_end(void)
{
    const struct motion_order order = {.section = {motion_order_endless(100, 2000)}, .sections = 1};

    TEST_ASSERT_TRUE(motion_order_is_endless(&order));
    TEST_ASSERT_EQUAL_UINT32(100, order.section[0].speed_steps_per_s);
    TEST_ASSERT_EQUAL_UINT32(2000, order.section[0].accel_steps_per_s2);
}

void test_the_longest_move_has_an_end(void)
{
    const struct motion_order order = {.section = {{MOTION_SECTION_STEPS_MAX, 1, 1}}, .sections = 1};

    TEST_ASSERT_FALSE(motion_order_is_endless(&order));
}
