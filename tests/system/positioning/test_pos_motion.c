/* Measures, feeds and holds of an axis: where pulses come, and when. */
#include "pos_rig.h"

#define FEED(mm_per_min) ((uint32_t)(mm_per_min) << 16U)

enum {
    ACCEL = 500,
    MOVES = 5000,
    MOVES_LONG = 1000000, /* RKM04_LONG=1 */
};

void setUp(void)
{
    rig_set_up();
    rig_run_ms(10);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
}

void tearDown(void)
{
}

static void mode(int32_t len_um)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, len_um, ACCEL, 1));
}

static void control(uint32_t feed, int mp)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, feed, mp, 1));
}

static void move(int32_t len_um)
{
    mode(len_um);
    control(FEED(1000), 1);
    rig_run_ms(2);
    rig_run_until_rest(1, 100000);
    TEST_ASSERT_EQUAL_HEX(POS_STV_POL, rig_values(1).status.status1 & POS_STV_POL);
}

/* 1000 mm/min, 500 mm/s^2, a step of 10 um, way 10 000 um. */
void test_each_pulse_of_the_example_stands_on_its_tick(void)
{
    move(10000);
    uint64_t start = unit.axes[0].start_tick - machine.epoch;
    TEST_ASSERT_EQUAL_UINT(1000, rig_pulses[0]);
    TEST_ASSERT_UINT64_WITHIN(1, 531263, rig_tick[0][0] - start);
    TEST_ASSERT_UINT64_WITHIN(1, 751319, rig_tick[0][1] - start);
    TEST_ASSERT_UINT64_WITHIN(1, 2811200, rig_tick[0][27] - start);
    TEST_ASSERT_UINT64_WITHIN(1, 52668700, rig_tick[0][998] - start);
    TEST_ASSERT_UINT64_WITHIN(1, 53199963, rig_tick[0][999] - start);
}

void test_remainders_are_carried(void)
{
    for (unsigned i = 0; i < 1000; i++) {
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
        move(1);
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    }
    TEST_ASSERT_EQUAL_INT64(100, rig_position[0]);
    TEST_ASSERT_EQUAL_INT32(1000, rig_values(1).position_um);
}

void test_a_measure_is_reached_exactly_whatever_holds_there_were(void)
{
    mode(-10000);
    for (unsigned i = 0; i < 50; i++) {
        control(FEED(300 + 37 * i), 1);
        rig_run_ms(7 + i % 11);
        control(FEED(300 + 37 * i), 0);
        rig_run_ms(1 + (i % 5) * 20);
    }
    control(FEED(1000), 1);
    rig_run_ms(1);
    rig_run_until_rest(1, 10000);
    TEST_ASSERT_EQUAL_INT64(-1000, rig_position[0]);
    TEST_ASSERT_EQUAL_UINT(1000, rig_pulses[0]);
    TEST_ASSERT_EQUAL_HEX(0x0A03, rig_status(1));
}

void test_a_hold_brakes_and_the_measure_is_kept(void)
{
    mode(10000);
    control(FEED(1000), 1);
    rig_run_ms(200);
    TEST_ASSERT_EQUAL_HEX(0x0103, rig_status(1));
    control(FEED(1000), 0);
    rig_run_ms(5);
    TEST_ASSERT_EQUAL_HEX(0x0103, rig_status(1));
    rig_run_ms(40);
    TEST_ASSERT_EQUAL_HEX(0x0003, rig_status(1));
    unsigned pulses = rig_pulses[0];
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_UINT(pulses, rig_pulses[0]);
    TEST_ASSERT_INT32_WITHIN(10, 10000 - 10 * (int32_t)pulses, rig_values(1).way_left_um);
}

void test_a_change_comes_within_a_millisecond_also_between_slow_pulses(void)
{
    mode(1000);
    control(1, 1);
    rig_run_ms(60000);
    TEST_ASSERT_EQUAL_UINT(0, rig_pulses[0]);
    TEST_ASSERT_EQUAL_HEX(0x0103, rig_status(1));
    control(FEED(1000), 1);
    rig_run_ms(10);
    TEST_ASSERT_TRUE(rig_pulses[0] > 0);
    control(FEED(1), 1);
    rig_run_ms(100);
    unsigned pulses = rig_pulses[0];
    control(0, 1);
    rig_run_ms(3);
    TEST_ASSERT_EQUAL_HEX(0x0003, rig_status(1));
    TEST_ASSERT_EQUAL_UINT(pulses, rig_pulses[0]);
}

void test_axes_of_one_pass_start_on_the_same_tick(void)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 2, 6));
    mode(10000);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 10000, ACCEL, 2));
    control(FEED(1000), 1);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, FEED(1000), 1, 2));
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_UINT(1000, rig_pulses[0]);
    TEST_ASSERT_EQUAL_UINT64_ARRAY(rig_tick[0], rig_tick[1], 1000);
}

void test_pos_init_stops_and_only_a_new_measure_moves_it_again(void)
{
    mode(10000);
    control(FEED(1000), 1);
    rig_run_ms(200);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    rig_run_ms(1);
    TEST_ASSERT_EQUAL_HEX(0x0101, rig_status(1));
    control(FEED(1000), 1);
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_HEX(0x0001, rig_status(1));
    int64_t stood = rig_position[0];
    move(1000);
    TEST_ASSERT_EQUAL_INT64(stood + 100, rig_position[0]);
}

void test_a_measure_that_comes_while_it_brakes_waits(void)
{
    mode(10000);
    control(FEED(1000), 1);
    rig_run_ms(200);
    TEST_ASSERT_EQUAL_INT(POS_ERROR_MOVES, pos_mode(&unit, NULL, 1, ACCEL, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    mode(-1000);
    control(FEED(1000), 1);
    rig_run_ms(1);
    TEST_ASSERT_EQUAL_HEX(0x0103, rig_status(1));
    TEST_ASSERT_EQUAL_HEX(POS_CNT_MP | POS_CNT_INIC, rig_control(1));
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_HEX(0x0A03, rig_status(1));
}

/* 3200 steps in 37 000 um: hardly a measure ends at a whole number of either. */
void test_after_many_measures_the_motor_stands_where_their_sum_is(void)
{
    static const uint16_t scale[] = {0, 3200, 0, 37000};
    uint32_t chance = 12345;
    int64_t sum_um = 0;
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, positioning_write(&unit, 130, 4, scale));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    unsigned moves = getenv("RKM04_LONG") != NULL ? MOVES_LONG : MOVES;
    for (unsigned i = 0; i < moves; i++) {
        chance = chance * UINT32_C(1664525) + UINT32_C(1013904223);
        int32_t len_um = (int32_t)(chance >> 16U) % 401 - 200;
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, len_um, UINT16_MAX, 1));
        control(UINT32_MAX, 1);
        rig_run_ms(2);
        rig_run_until_rest(1, 1000);
        sum_um += len_um;
        int64_t double_steps = 2 * sum_um * 3200 + 37000;
        int64_t steps = double_steps >= 0 ? double_steps / 74000 : -((-double_steps + 73999) / 74000);
        TEST_ASSERT_EQUAL_INT64(steps, rig_position[0]);
    }
    (void)printf("%u measures\n", moves);
}

/* 600 mm/min are 1000 steps/s, 100 mm/s^2 10 000 steps/s^2: 0.1 s and 50 steps. */
void test_what_is_above_the_highest_feed_and_acceleration_counts_as_these(void)
{
    static const uint16_t highest[] = {100, 600, 0};
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, 1));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, positioning_write(&unit, 135, 3, highest));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    mode(10000);
    control(FEED(1000), 1);
    rig_run_ms(200);
    TEST_ASSERT_UINT32_WITHIN(FEED(1), FEED(600), rig_values(1).speed);
    rig_run_ms(2000);
    TEST_ASSERT_EQUAL_UINT64(84000, rig_tick[0][61] - rig_tick[0][60]);
    TEST_ASSERT_UINT64_WITHIN(TICKS_PER_MS, 100 * TICKS_PER_MS,
                              rig_tick[0][49] + machine.epoch - unit.axes[0].start_tick);
}
