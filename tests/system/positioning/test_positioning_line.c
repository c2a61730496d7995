#include "unity.h"

#include "modbus_rig.h"
#include "pos_bench.h"

static struct pos_bench bench;
static uint64_t tick;

static uint32_t *axis_1(void)
{
    return bench.registers.axes[0];
}

void setUp(void)
{
    tick = 55555555555;
    pos_bench_init(&bench, 1, tick);
    tick += RIG_SILENCE_TICKS + RIG_CHARACTER_TICKS;
    pos_bench_poll(&bench, tick);
}

void tearDown(void)
{
    TEST_ASSERT_FALSE(modbus_is_sending(&bench.server));
}

/* A request as it stands in the text, and its answer; empty: there is none. */
static void assert_exchange(const char *request, const char *answered)
{
    char text[RIG_TEXT_ROOM];
    struct rig_frame frame = rig_bytes(request);
    struct rig_frame answer = {.length = 0};
    for (uint32_t i = 0; i < frame.length; i++) {
        tick += RIG_CHARACTER_TICKS;
        pos_bench_take(&bench, &(struct hal_line_byte){.tick = tick, .value = frame.bytes[i]});
    }
    tick += RIG_SILENCE_TICKS + RIG_CHARACTER_TICKS;
    pos_bench_poll(&bench, tick);
    for (; modbus_is_sending(&bench.server); modbus_advance(&bench.server)) {
        answer.bytes[answer.length++] = modbus_byte(&bench.server);
    }
    rig_put_text(text, &answer);
    TEST_ASSERT_EQUAL_STRING(answered, text);
}

/* The registers as the unit of the contract's example has them so long after the start. */
static void move_to(uint32_t micrometres)
{
    axis_1()[POS_AXIS_STATUS] = 0x0103;
    axis_1()[POS_AXIS_DONE] = 0x0202;
    axis_1()[POS_AXIS_POSITION] = micrometres;
}

void test_the_frames_of_a_move_are_taken_and_answered_byte_for_byte(void)
{
    uint32_t next = 0;
    assert_exchange("01 06 00 64 01 01 08 45", "01 06 00 64 01 01 08 45");
    TEST_ASSERT_EQUAL_HEX32(0x0101, pos_write_next(&bench.write, POS_USE_INSTRUCTION, &next)->value);
    assert_exchange("01 10 00 64 00 08 10 02 02 00 00 00 00 27 10 01 F4 00 01 03 E8 00 00 D6 42",
                    "01 10 00 64 00 08 80 10");
    TEST_ASSERT_EQUAL_UINT32(10000, axis_1()[POS_AXIS_LEN]);
    TEST_ASSERT_EQUAL_UINT32(500, axis_1()[POS_AXIS_ACCEL]);
    TEST_ASSERT_EQUAL_UINT32(1, axis_1()[POS_AXIS_CONTROL]);
    TEST_ASSERT_EQUAL_HEX32(0x03E80000, axis_1()[POS_AXIS_FEED]);
    move_to(4720);
    assert_exchange("01 04 00 6E 00 08 90 11", "01 04 10 01 03 00 00 02 02 00 00 00 00 00 00 00 00 12 70 28 86");
    move_to(6380);
    assert_exchange("01 17 02 08 00 10 01 F4 00 0C 18 00 00 01 F4 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
                    "00 00 00 0E 5B",
                    "01 17 20 01 03 00 00 00 00 18 EC 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
                    "00 00 00 D6 89");
    TEST_ASSERT_EQUAL_UINT32(0, axis_1()[POS_AXIS_CONTROL]);
    TEST_ASSERT_EQUAL_HEX32(0x01F40000, axis_1()[POS_AXIS_FEED]);
    assert_exchange("01 06 00 6A 01 F4 A9 C1", "01 06 00 6A 01 F4 A9 C1");
    TEST_ASSERT_EQUAL_UINT32(5, bench.executed);
}

void test_the_frames_that_are_refused_are_answered_byte_for_byte_and_change_nothing(void)
{
    struct pos_registers before = bench.registers;
    bench.busy_axes = 1;
    assert_exchange("01 06 00 66 00 00 69 D5", "01 86 02 C3 A1");
    assert_exchange("01 06 00 64 03 09 08 E3", "01 86 03 02 61");
    assert_exchange("01 10 00 82 00 04 08 00 00 0C 80 00 00 9C 40 24 21", "01 90 06 CC 02");
    assert_exchange("01 01 00 00 00 08 3D CC", "01 81 01 81 90");
    TEST_ASSERT_EQUAL_MEMORY(&before, &bench.registers, sizeof before);
    TEST_ASSERT_EQUAL_UINT32(0, bench.executed);
}

void test_a_broadcast_is_executed_without_an_answer(void)
{
    uint32_t next = 0;
    assert_exchange("00 06 00 64 03 03 89 35", "");
    TEST_ASSERT_EQUAL_HEX32(0x0303, pos_write_next(&bench.write, POS_USE_INSTRUCTION, &next)->value);
    TEST_ASSERT_EQUAL_UINT32(1, bench.executed);
}

void test_the_unit_tells_what_it_is(void)
{
    assert_exchange("01 2B 0E 01 00 70 77",
                    "01 2B 0E 01 81 00 00 03 00 0D 6F 70 65 6E 20 66 69 72 6D 77 61 72 65 01 04 50 4F 53 34 02 05 30 "
                    "31 2E 30 30 BE 9B");
}

/* Sends a request without its CRC; the exception, or 0. */
static unsigned exception_of(const char *request)
{
    struct rig_frame frame = rig_sealed(request);
    for (uint32_t i = 0; i < frame.length; i++) {
        tick += RIG_CHARACTER_TICKS;
        pos_bench_take(&bench, &(struct hal_line_byte){.tick = tick, .value = frame.bytes[i]});
    }
    tick += RIG_SILENCE_TICKS + RIG_CHARACTER_TICKS;
    pos_bench_poll(&bench, tick);
    uint8_t bytes[3] = {0};
    for (uint32_t i = 0; modbus_is_sending(&bench.server); modbus_advance(&bench.server), i++) {
        if (i < sizeof bytes) {
            bytes[i] = modbus_byte(&bench.server);
        }
    }
    return (bytes[1] & 0x80U) != 0U ? bytes[2] : 0U;
}

void test_what_is_wrong_in_several_ways_is_refused_in_the_order_1_3_2_3_6(void)
{
    bench.busy_axes = 1;
    TEST_ASSERT_EQUAL_UINT(1, exception_of("01 07"));
    TEST_ASSERT_EQUAL_UINT(3, exception_of("01 10 00 32 00 01 02 00"));
    TEST_ASSERT_EQUAL_UINT(2, exception_of("01 10 00 9A 00 03 06 00 00 00 00 00 00"));
    TEST_ASSERT_EQUAL_UINT(2, exception_of("01 10 00 83 00 01 02 00 00"));
    TEST_ASSERT_EQUAL_UINT(3, exception_of("01 06 00 86 00 02"));
    TEST_ASSERT_EQUAL_UINT(6, exception_of("01 06 00 86 00 01"));
    TEST_ASSERT_EQUAL_UINT(6, exception_of("01 06 00 1E 00 0A"));
    TEST_ASSERT_EQUAL_UINT(6, exception_of("01 06 00 28 00 01"));
    TEST_ASSERT_EQUAL_UINT(0, exception_of("01 06 00 EA 00 01"));
}

void test_a_write_whose_read_is_refused_is_not_executed(void)
{
    struct pos_registers before = bench.registers;
    TEST_ASSERT_EQUAL_UINT(2, exception_of("01 17 00 6F 00 06 00 68 00 01 02 01 F4"));
    TEST_ASSERT_EQUAL_MEMORY(&before, &bench.registers, sizeof before);
    TEST_ASSERT_EQUAL_UINT(0, exception_of("01 17 00 6F 00 05 00 68 00 01 02 01 F4"));
    TEST_ASSERT_EQUAL_UINT32(500, axis_1()[POS_AXIS_ACCEL]);
}

void test_only_registers_without_write_access_are_input_registers(void)
{
    TEST_ASSERT_EQUAL_UINT(0, exception_of("01 04 00 6E 00 12"));
    TEST_ASSERT_EQUAL_UINT(2, exception_of("01 04 00 64 00 08"));
    TEST_ASSERT_EQUAL_UINT(0, exception_of("01 03 00 64 00 08"));
}
