#include "unity.h"

#include "base_tick.h"
#include "hal_line.h"
#include "host_machine.h"

enum {
    SENT_MAX = 400,
    SCRIPT_MAX = HOST_LINE_HEARD_MAX + 10
};

#define EPOCH UINT64_C(5000000000)

static struct host_machine machine;
static struct host_line_byte script[SCRIPT_MAX];

static struct {
    uint64_t tick;
    uint8_t value;
} sent[SENT_MAX];
static unsigned sent_count;
static unsigned passes;
static unsigned to_give; /* bytes that main still wants to send */

static void on_line(void *context, uint64_t tick, uint8_t value)
{
    (void)context;
    TEST_ASSERT_LESS_THAN_UINT(SENT_MAX, sent_count);
    sent[sent_count].tick = tick;
    sent[sent_count].value = value;
    sent_count++;
}

static uint64_t pass(void *context)
{
    (void)context;
    passes++;
    while (to_give > 0 && hal_line_write((uint8_t)to_give)) {
        to_give--;
    }
    return TICK_NEVER;
}

void setUp(void)
{
    host_machine_init(&machine, EPOCH);
    host_machine_select(&machine);
    machine.listener.line = on_line;
    sent_count = 0;
    passes = 0;
    to_give = 0;
}

void tearDown(void)
{
}

/* `length` bytes that count up from 0, `apart` ticks from each other, from `first` on. */
static void plan(uint64_t first, uint64_t apart, uint32_t length)
{
    for (uint32_t i = 0; i < length; i++) {
        script[i] = (struct host_line_byte){.tick = first + i * apart, .value = (uint8_t)i};
    }
    host_machine_set_line(&machine, script, length);
}

static void run_until(uint64_t tick)
{
    host_machine_run(&machine, tick, pass, NULL, NULL);
}

void test_a_byte_is_heard_at_its_tick(void)
{
    struct hal_line_byte byte;
    plan(1000, 1, 1);
    run_until(1000);
    TEST_ASSERT_FALSE(hal_line_read(&byte));
    run_until(1001);
    TEST_ASSERT_TRUE(hal_line_read(&byte));
    TEST_ASSERT_EQUAL_UINT64(EPOCH + 1000, byte.tick);
    TEST_ASSERT_EQUAL_HEX8(0, byte.value);
    TEST_ASSERT_FALSE(byte.broken);
    TEST_ASSERT_FALSE(hal_line_read(&byte));
}

void test_a_byte_makes_a_pass_of_main(void)
{
    plan(1000, 1000, 3);
    run_until(10000);
    TEST_ASSERT_EQUAL_UINT(1 + 3, passes);
}

void test_bytes_of_one_tick_come_together_up_to_the_end_of_a_line(void)
{
    struct hal_line_run run;
    run_until(5000);
    plan(1000, 1, 40);
    run_until(5001);
    TEST_ASSERT_TRUE(hal_line_read_run(&run, 2));
    TEST_ASSERT_EQUAL_UINT32(3, run.count);
    TEST_ASSERT_EQUAL_UINT64(EPOCH + 5000, run.tick);
    TEST_ASSERT_EQUAL_HEX8(2, run.bytes[2]);
    TEST_ASSERT_TRUE(hal_line_read_run(&run, 2));
    TEST_ASSERT_EQUAL_UINT32(HAL_LINE_RUN_MAX, run.count);
    TEST_ASSERT_EQUAL_HEX8(3, run.bytes[0]);
    TEST_ASSERT_TRUE(hal_line_read_run(&run, 2));
    TEST_ASSERT_EQUAL_UINT32(40 - 3 - HAL_LINE_RUN_MAX, run.count);
    TEST_ASSERT_FALSE(hal_line_read_run(&run, 2));
}

void test_bytes_of_different_ticks_and_broken_ones_come_apart(void)
{
    struct hal_line_run run;
    script[0] = (struct host_line_byte){.tick = 5, .value = 7};
    script[1] = (struct host_line_byte){.tick = 6, .value = 8, .broken = true};
    script[2] = (struct host_line_byte){.tick = 6, .value = 9};
    script[3] = (struct host_line_byte){.tick = 6, .value = 10, .broken = true};
    host_machine_set_line(&machine, script, 4);
    run_until(10);
    for (uint8_t i = 0; i < 4; i++) {
        TEST_ASSERT_TRUE(hal_line_read_run(&run, 0));
        TEST_ASSERT_EQUAL_UINT32(1, run.count);
        TEST_ASSERT_EQUAL_HEX8(7 + i, run.bytes[0]);
        TEST_ASSERT_EQUAL(i % 2U != 0, run.broken);
        TEST_ASSERT_EQUAL_UINT64(EPOCH + (i == 0 ? 5U : 6U), run.tick);
    }
    TEST_ASSERT_FALSE(hal_line_read_run(&run, 0));
}

static void wake_after_byte(void *context, uint64_t tick, uint8_t value)
{
    (void)context;
    (void)value;
    host_machine_wake(&machine, tick + 500);
}

void test_who_hears_a_byte_may_want_a_pass_of_main(void)
{
    machine.listener.line = wake_after_byte;
    to_give = 1;
    run_until(HOST_LINE_BYTE_TICKS + 501);
    TEST_ASSERT_EQUAL_UINT(1 + 1, passes);
}

void test_bytes_that_are_past_come_at_once(void)
{
    struct hal_line_byte byte;
    run_until(5000);
    plan(1000, 1000, 3);
    run_until(5001);
    for (uint8_t i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(hal_line_read(&byte));
        TEST_ASSERT_EQUAL_HEX8(i, byte.value);
        TEST_ASSERT_EQUAL_UINT64(EPOCH + 5000, byte.tick);
    }
}

void test_a_broken_byte_is_told(void)
{
    struct hal_line_byte byte;
    script[0] = (struct host_line_byte){.tick = 5, .value = 7, .broken = true};
    host_machine_set_line(&machine, script, 1);
    run_until(10);
    TEST_ASSERT_TRUE(hal_line_read(&byte));
    TEST_ASSERT_TRUE(byte.broken);
}

void test_what_main_does_not_read_in_time_is_lost_and_marked(void)
{
    struct hal_line_byte byte;
    plan(1000, 10, HOST_LINE_HEARD_MAX + 3);
    run_until(100000);
    for (unsigned i = 0; i < HOST_LINE_HEARD_MAX; i++) {
        TEST_ASSERT_TRUE(hal_line_read(&byte));
        TEST_ASSERT_EQUAL_HEX8(i, byte.value);
        TEST_ASSERT_EQUAL(i == HOST_LINE_HEARD_MAX - 1, byte.broken);
    }
    TEST_ASSERT_FALSE(hal_line_read(&byte));
}

void test_what_comes_after_bytes_were_lost_is_good(void)
{
    struct hal_line_byte byte;
    plan(1000, 10, HOST_LINE_HEARD_MAX + 3);
    run_until(100000);
    while (hal_line_read(&byte)) {
    }
    plan(200000, 10, 1);
    run_until(300000);
    TEST_ASSERT_TRUE(hal_line_read(&byte));
    TEST_ASSERT_FALSE(byte.broken);
}

void test_a_byte_takes_ten_bits_at_19200_bd(void)
{
    TEST_ASSERT_EQUAL_UINT64(10 * (uint64_t)TICK_HZ, HOST_LINE_BYTE_TICKS * UINT64_C(19200));
    to_give = 2;
    run_until(1000000);
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    TEST_ASSERT_EQUAL_UINT64(HOST_LINE_BYTE_TICKS, sent[0].tick);
    TEST_ASSERT_EQUAL_UINT64(2 * HOST_LINE_BYTE_TICKS, sent[1].tick);
}

void test_bytes_can_be_sent_in_no_time(void)
{
    enum {
        BYTES = 250
    };
    host_machine_set_byte_ticks(&machine, 0);
    to_give = BYTES;
    run_until(1);
    TEST_ASSERT_EQUAL_UINT(BYTES, sent_count);
    TEST_ASSERT_EQUAL_UINT8(1, sent[BYTES - 1].value);
    TEST_ASSERT_EQUAL_UINT64(0, sent[BYTES - 1].tick);
    TEST_ASSERT_TRUE(hal_line_is_idle());
}

void test_the_next_tick_is_that_of_the_next_byte(void)
{
    plan(1000, 500, 2);
    run_until(1000);
    TEST_ASSERT_EQUAL_UINT64(1000, host_machine_next_tick(&machine));
    run_until(1001);
    TEST_ASSERT_EQUAL_UINT64(1500, host_machine_next_tick(&machine));
    run_until(1501);
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, host_machine_next_tick(&machine));
}

void test_bytes_beyond_the_room_are_refused_and_main_is_called_again(void)
{
    enum {
        BYTES = 250
    };
    to_give = BYTES;
    run_until((BYTES + 1) * (uint64_t)HOST_LINE_BYTE_TICKS);
    TEST_ASSERT_EQUAL_UINT(BYTES, sent_count);
    for (unsigned i = 0; i < BYTES; i++) {
        TEST_ASSERT_EQUAL_UINT8(BYTES - i, sent[i].value);
        TEST_ASSERT_EQUAL_UINT64((i + 1) * (uint64_t)HOST_LINE_BYTE_TICKS, sent[i].tick);
    }
    TEST_ASSERT_LESS_THAN_UINT(10, passes);
}

void test_the_line_is_idle_when_all_has_been_sent(void)
{
    TEST_ASSERT_TRUE(hal_line_is_idle());
    to_give = 1;
    run_until(HOST_LINE_BYTE_TICKS);
    TEST_ASSERT_FALSE(hal_line_is_idle());
    run_until(HOST_LINE_BYTE_TICKS + 1);
    TEST_ASSERT_TRUE(hal_line_is_idle());
}

void test_the_line_is_quiet_unless_a_byte_is_on_its_way_or_unread(void)
{
    struct hal_line_byte byte;
    const uint64_t end = UINT64_C(3) * HOST_LINE_BYTE_TICKS;
    plan(end, 0, 1);
    run_until(end - HOST_LINE_BYTE_TICKS);
    TEST_ASSERT_TRUE(hal_line_is_quiet());
    run_until(end - HOST_LINE_BYTE_TICKS + 1U);
    TEST_ASSERT_FALSE(hal_line_is_quiet());
    run_until(end + 1U);
    TEST_ASSERT_FALSE(hal_line_is_quiet());
    TEST_ASSERT_TRUE(hal_line_read(&byte));
    TEST_ASSERT_TRUE(hal_line_is_quiet());
}

void test_nobody_needs_to_listen(void)
{
    machine.listener.line = NULL;
    to_give = 3;
    run_until(1000000);
    TEST_ASSERT_TRUE(hal_line_is_idle());
}

void test_a_restart_loses_the_bytes_in_the_machine(void)
{
    struct hal_line_byte byte;
    plan(1000, 1000, 3);
    to_give = 3;
    run_until(1500);
    host_machine_restart(&machine);
    TEST_ASSERT_TRUE(hal_line_is_idle());
    TEST_ASSERT_FALSE(hal_line_read(&byte));
    run_until(2500);
    TEST_ASSERT_TRUE(hal_line_read(&byte));
    TEST_ASSERT_EQUAL_HEX8(1, byte.value);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
}

void test_the_node_is_1_unless_set(void)
{
    TEST_ASSERT_EQUAL_UINT8(1, hal_line_node());
    host_machine_set_node(&machine, 16);
    host_machine_restart(&machine);
    TEST_ASSERT_EQUAL_UINT8(16, hal_line_node());
}
