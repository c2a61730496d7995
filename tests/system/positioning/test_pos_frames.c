/* The frames of line.md, byte for byte: unit 1 with delivered settings, just started, moves axis 1 by 10 mm. */
#include "pos_rig.h"

void setUp(void)
{
    rig_set_up();
    rig_run_ms(10);
}

void tearDown(void)
{
}

static void take(void)
{
    rig_expect("01 06 00 64 01 01 08 45", "01 06 00 64 01 01 08 45");
}

static void move(void)
{
    rig_expect("01 10 00 64 00 08 10 02 02 00 00 00 00 27 10 01 F4 00 01 03 E8 00 00 D6 42", "01 10 00 64 00 08 80 10");
}

/* Runs until a request that is sent now is answered with what is so `ms` after the first tick of the motion: it has
 * come with T after it. */
static void run_until(uint64_t ms, uint32_t bytes)
{
    uint64_t start = unit.axes[0].start_tick - machine.epoch;
    uint64_t request = bytes * (uint64_t)machine.line.byte_ticks + (7U * (uint64_t)machine.line.byte_ticks) / 2U;
    rig_run_ticks(start + ms * TICKS_PER_MS - request - machine.now);
}

void test_an_axis_is_taken_and_moved_by_ten_millimetres(void)
{
    take();
    move();
    run_until(300, 8);
    rig_expect("01 04 00 6E 00 08 90 11", "01 04 10 01 03 00 00 02 02 00 00 00 00 00 00 00 00 12 70 28 86");
    run_until(400, 37);
    rig_expect(
        "01 17 02 08 00 10 01 F4 00 0C 18 00 00 01 F4 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 0E "
        "5B",
        "01 17 20 01 03 00 00 00 00 18 EC 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 D6 "
        "89");
}

void test_a_request_that_is_repeated_is_answered_again_and_not_executed_again(void)
{
    take();
    move();
    rig_run_ms(100);
    move();
    rig_run_until_rest(1, 5000);
    TEST_ASSERT_EQUAL_INT64(1000, rig_position[0]);
    TEST_ASSERT_EQUAL_HEX(0x0803, rig_status(1));
    move();
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_INT64(1000, rig_position[0]);
}

void test_the_upper_word_of_feed_stands_alone(void)
{
    take();
    move();
    rig_expect("01 06 00 6A 01 F4 A9 C1", "01 06 00 6A 01 F4 A9 C1");
    TEST_ASSERT_EQUAL_HEX32(0x01F40000, unit.axes[0].feed);
}

void test_what_is_wrong_gets_its_exception(void)
{
    rig_expect("01 06 00 66 00 00 69 D5", "01 86 02 C3 A1");
    rig_expect("01 06 00 64 03 09 08 E3", "01 86 03 02 61");
    rig_expect("01 01 00 00 00 08 3D CC", "01 81 01 81 90");
    take();
    rig_expect("01 10 00 82 00 04 08 00 00 0C 80 00 00 9C 40 24 21", "01 90 06 CC 02");
}

void test_a_broadcast_is_executed_and_not_answered(void)
{
    take();
    move();
    rig_expect("00 06 00 64 03 03 89 35", "");
    rig_run_until_rest(1, 1000);
    TEST_ASSERT_EQUAL_HEX(0, rig_status(1));
    TEST_ASSERT_TRUE(rig_position[0] < 1000);
}

void test_the_unit_says_what_it_is(void)
{
    rig_expect(
        "01 2B 0E 01 00 70 77",
        "01 2B 0E 01 81 00 00 03 00 0D 6F 70 65 6E 20 66 69 72 6D 77 61 72 65 01 04 50 4F 53 34 02 05 30 31 2E 30 30 "
        "BE 9B");
}
