/* What a command sets, each number at its place, and that it sets nothing else. */
#include "gve_rig.h"

void setUp(void)
{
    rig_set_up();
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

static void expect_modal(const struct gve_modal *expected)
{
    const struct gve_modal *modal = &unit.queue.modal;
    TEST_ASSERT_EQUAL_UINT32(expected->pause_ms, modal->pause_ms);
    TEST_ASSERT_EQUAL_UINT32(expected->short_pulses, modal->short_pulses);
    TEST_ASSERT_EQUAL_UINT32(expected->accel, modal->accel);
    TEST_ASSERT_EQUAL_UINT32(expected->speed, modal->speed);
    TEST_ASSERT_EQUAL_UINT32(expected->brake, modal->brake);
    TEST_ASSERT_EQUAL(expected->corrected, modal->corrected);
    TEST_ASSERT_EQUAL_UINT32_ARRAY(expected->limit, modal->limit, PATH_AXES);
    TEST_ASSERT_EQUAL_UINT32_ARRAY(expected->jump, modal->jump, PATH_AXES);
}

void test_each_setting_is_one_of_its_own(void)
{
    struct gve_modal expected;
    gve_modal_init(&expected);
    expect_modal(&expected);
    rig_expect("0T7", "0");
    expected.pause_ms = 7;
    expect_modal(&expected);
    rig_expect("0$300", "0");
    expected.short_pulses = 300;
    expect_modal(&expected);
    rig_expect("0A50", "0");
    expected.accel = 50;
    expect_modal(&expected);
    rig_expect("0V1234", "0");
    expected.speed = 1234;
    expect_modal(&expected);
    rig_expect("0B4321", "0");
    expected.brake = 4321;
    expect_modal(&expected);
    rig_expect("0VK", "0");
    expected.corrected = true;
    expect_modal(&expected);
    rig_expect("0VL25000,26000,27000,28000", "0");
    memcpy(expected.limit, (const uint32_t[]){25000, 26000, 27000, 28000}, sizeof expected.limit);
    expect_modal(&expected);
    rig_expect("0VJ500,600,700,0", "0");
    memcpy(expected.jump, (const uint32_t[]){500, 600, 700, 0}, sizeof expected.jump);
    expect_modal(&expected);
    rig_expect("0VN", "0");
    expected.corrected = false;
    expect_modal(&expected);
}

void test_a_reference_run_has_its_numbers_in_their_order(void)
{
    const struct gve_home_order *order = &unit.queue.home.order;
    rig_send("!0WZ-12,1000,34,500\r");
    TEST_ASSERT_EQUAL_UINT(2, order->axis);
    TEST_ASSERT_EQUAL_INT32(-12, order->way);
    TEST_ASSERT_EQUAL_UINT32(1000, order->speed);
    TEST_ASSERT_EQUAL_INT32(34, order->way_back);
    TEST_ASSERT_EQUAL_UINT32(500, order->speed_back);
    rig_run_ms(1000);
}

void test_after_n_all_axes_are_at_0_and_go_on_from_there(void)
{
    rig_expect("0L1,2,3,4", "0");
    rig_run_ms(500);
    rig_expect("0N", "0");
    rig_expect("0P4", "0,0,0,0,0");
    rig_expect("0L5,6,7,8", "0");
    rig_run_ms(500);
    rig_expect("0P4", "0,5,6,7,8");
}

static void enter_two(void)
{
    rig_expect("0H", "8");
    rig_expect("0V1000", "8");
    rig_expect("0C1000", "8");
    rig_expect("0V2000", "8");
    rig_expect("0C0,1000", "8");
    rig_expect("0V3000", "8");
}

/* In sixteenths of a pulse/s. */
static void expect_speeds(uint32_t first, uint32_t second)
{
    TEST_ASSERT_EQUAL_UINT32(first * (PATH_SPEED_UNITS / 16U), unit.queue.ring[0].vector.speed);
    TEST_ASSERT_EQUAL_UINT32(second * (PATH_SPEED_UNITS / 16U), unit.queue.ring[1].vector.speed);
}

void test_xm_and_xa_take_the_last_v_and_xu_and_xd_do_not(void)
{
    enter_two();
    expect_speeds(16 * 1000, 16 * 2000);
    rig_expect("0XU", "8");
    TEST_ASSERT_EQUAL_UINT32(GVE_FACTOR_ONE * 17U / 16U, unit.queue.factor);
    expect_speeds(17 * 1000, 17 * 2000);
    rig_expect("0XD", "8");
    TEST_ASSERT_EQUAL_UINT32(GVE_FACTOR_ONE * 255U / 256U, unit.queue.factor);
    TEST_ASSERT_EQUAL_UINT32(255000, unit.queue.ring[0].vector.speed);
    TEST_ASSERT_EQUAL_UINT32(2 * 255000, unit.queue.ring[1].vector.speed);
    rig_expect("0XM200", "8");
    TEST_ASSERT_EQUAL_UINT32(2U * GVE_FACTOR_ONE, unit.queue.factor);
    expect_speeds(16 * 6000, 16 * 6000);
    rig_set_up();
    enter_two();
    rig_expect("0XM200", "8");
    expect_speeds(16 * 6000, 16 * 6000);
    rig_expect("0V4000", "8");
    rig_expect("0XA", "8");
    expect_speeds(16 * 4000, 16 * 4000);
}
