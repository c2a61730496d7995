/* The messages, byte by byte (spec, section 2), with the stages below as they are, on the host machine. */
#include "messages.h"
#include "unity.h"

#include <string.h>

#include "base_tick.h"
#include "epoch.h"
#include "host_machine.h"

enum {
    GUARD = 0xA5
};

static struct host_machine machine;
static struct io io;
static struct interpreter_shared shared;
static struct store store;
static struct axis axis[UNIT_MOTORS];
static struct interpreter interpreter[UNIT_MOTORS];
static struct messages messages;
static uint8_t answer[MESSAGES_ANSWER_BYTES_MAX + 1];
static uint32_t answer_length;
static uint8_t request[MESSAGES_REQUEST_BYTES_MAX + 1];

static unsigned lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    (void)context;
    return axis_lay_isr(&axis[motor], room);
}

static void tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
}

static void plan_isr(void *context)
{
    (void)context;
}

void setUp(void)
{
    static const struct hal_client client = {.lay_isr = lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    host_machine_init(&machine, epoch_random());
    host_machine_select(&machine);
    io_init(&io);
    interpreter_shared_init(&shared, &io);
    store_init(&store);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        axis_init(&axis[motor], motor);
        interpreter_init(&interpreter[motor], motor, &axis[motor], &shared);
    }
    messages = (struct messages){
        .interpreters = interpreter, .shared = &shared, .store = &store, .version = "01.02,06.03.2009"};
    hal_run_start(&client);
    answer[MESSAGES_ANSWER_BYTES_MAX] = GUARD;
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_HEX8(GUARD, answer[MESSAGES_ANSWER_BYTES_MAX]);
}

static void send(const void *bytes, uint32_t length)
{
    answer_length = messages_answer(&messages, bytes, length, machine.epoch + machine.now, answer);
}

/* A message without zero bytes. */
static void send_text(const char *text)
{
    send(text, (uint32_t)strlen(text));
}

static void assert_answer(const void *bytes, uint32_t length)
{
    TEST_ASSERT_EQUAL_UINT32(length, answer_length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(bytes, answer, length);
}

static void assert_answer_text(const char *text)
{
    assert_answer(text, (uint32_t)strlen(text));
}

static uint64_t poll(void *context)
{
    uint64_t wake = TICK_NEVER;
    (void)context;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        uint64_t next = interpreter_poll(&interpreter[motor], machine.epoch + machine.now);
        wake = next < wake ? next : wake;
    }
    return wake;
}

static void run_ms(uint32_t milliseconds)
{
    host_machine_run(&machine, machine.now + (uint64_t)milliseconds * TICKS_PER_MS, poll, NULL, NULL);
}

void test_version_tells_version_and_date(void)
{
    send_text("\1");
    assert_answer_text("\1\x10"
                       "01.02,06.03.2009");
}

void test_set_command_of_the_manual(void)
{
    send_text("\2"
              "3C100");
    assert_answer("\2"
                  "3\0",
                  4);
    send_text("\2"
              "1");
    assert_answer("\2"
                  "1\0",
                  4);
}

void test_set_command_gives_the_text_to_the_motor(void)
{
    send_text("\2"
              "3 M5 {comment}");
    send_text("\5"
              "3");
    assert_answer_text("\5"
                       "3M05");
    send_text("\5"
              "2");
    assert_answer_text("\5"
                       "2");
}

void test_set_command_for_motor_0_gives_the_text_to_all(void)
{
    send_text("\2"
              "0C100");
    assert_answer("\2"
                  "0\0",
                  4);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_UINT32(1, interpreter[motor].memory.written);
    }
}

void test_set_command_tells_a_wrong_value_with_its_command(void)
{
    send_text("\2"
              "1T01V0");
    assert_answer("\2"
                  "1\1V",
                  4);
}

void test_set_command_tells_an_unknown_character(void)
{
    send_text("\2"
              "1T01?");
    assert_answer("\2"
                  "1\2?",
                  4);
}

void test_set_command_tells_the_first_error_only(void)
{
    send_text("\2"
              "1T01q V0");
    assert_answer("\2"
                  "1\2q",
                  4);
}

TEST_CASE('0')
TEST_CASE('4')
void test_set_command_with_an_error_stores_nothing(uint8_t motor)
{
    uint8_t message[] = {2, motor, 'T', '1', '?'};
    send(message, sizeof message);
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        TEST_ASSERT_EQUAL_UINT32(0, interpreter[i].memory.written);
    }
}

void test_set_command_warns_of_an_overflow_on_any_motor(void)
{
    for (uint32_t i = 0; i < PROGRAM_COMMANDS_MAX; i++) {
        send_text("\2"
                  "2V5");
        assert_answer("\2"
                      "2\0",
                      4);
    }
    send_text("\2"
              "0V5");
    assert_answer("\2"
                  "0\3",
                  4);
}

/* In Windows-1250 the call character may be 0xB4. */
TEST_CASE('\'')
TEST_CASE('"')
TEST_CASE('`')
TEST_CASE(0xB4)
void test_set_command_takes_every_call_character(uint8_t character)
{
    uint8_t message[] = {2, '1', character, '7'};
    send(message, sizeof message);
    send_text("\5"
              "1");
    assert_answer_text("\5"
                       "1'7");
}

void test_set_command_without_a_motor_is_flag_1(void)
{
    send("\2", 1);
    assert_answer("\2\0\1", 4);
}

TEST_CASE('0' - 1)
TEST_CASE('5')
TEST_CASE(0)
TEST_CASE(1)
TEST_CASE(255)
void test_set_command_with_a_wrong_motor_is_flag_1_with_that_byte(uint8_t motor)
{
    uint8_t message[] = {2, motor, 'T', '1'};
    uint8_t expected[] = {2, motor, 1, motor};
    send(message, sizeof message);
    assert_answer(expected, sizeof expected);
}

TEST_CASE(3, '5')
TEST_CASE(4, '5')
TEST_CASE(5, '5')
TEST_CASE(6, '/')
TEST_CASE(7, 0)
void test_other_messages_with_a_wrong_motor_are_unknown(uint8_t number, uint8_t motor)
{
    uint8_t message[] = {number, motor};
    uint8_t expected[] = {255, number, 0, 0};
    send(message, sizeof message);
    assert_answer(expected, sizeof expected);
}

TEST_CASE(3)
TEST_CASE(4)
TEST_CASE(5)
TEST_CASE(6)
TEST_CASE(7)
void test_other_messages_without_a_motor_are_unknown(uint8_t number)
{
    uint8_t expected[] = {255, number, 0, 0};
    send(&number, 1);
    assert_answer(expected, sizeof expected);
}

TEST_CASE(0)
TEST_CASE(8)
TEST_CASE(50)
TEST_CASE(254)
TEST_CASE(255)
void test_an_unknown_message_is_answered_by_255(uint8_t number)
{
    uint8_t message[] = {number, '1', 'x'};
    uint8_t expected[] = {255, number, 0, 0};
    send(message, sizeof message);
    assert_answer(expected, sizeof expected);
}

TEST_CASE(5)
TEST_CASE(6)
TEST_CASE(7)
void test_messages_of_one_motor_refuse_motor_0(uint8_t number)
{
    uint8_t message[] = {number, '0'};
    send(message, sizeof message);
    TEST_ASSERT_EQUAL_UINT32(2 + 15, answer_length);
    TEST_ASSERT_EQUAL_UINT8(number, answer[0]);
    TEST_ASSERT_EQUAL_STRING_LEN("0ERROR COMMAND! ", &answer[1], 16);
}

void test_bytes_after_what_a_message_needs_are_ignored(void)
{
    send_text("\1 and more");
    TEST_ASSERT_EQUAL_UINT32(18, answer_length);
    send_text("\4"
              "1 and more");
    TEST_ASSERT_EQUAL_UINT32(13, answer_length);
    send_text("\7"
              "1 and more");
    TEST_ASSERT_EQUAL_UINT32(11, answer_length);
}

void test_an_empty_message_has_no_answer(void)
{
    send("", 0);
    TEST_ASSERT_EQUAL_UINT32(0, answer_length);
}

void test_the_longest_message_is_taken(void)
{
    memset(request, ' ', sizeof request);
    memcpy(request,
           "\2"
           "1T01",
           5);
    send(request, MESSAGES_REQUEST_BYTES_MAX);
    assert_answer("\2"
                  "1\0",
                  4);
    TEST_ASSERT_EQUAL_UINT32(1, interpreter[0].memory.written);
}

void test_an_over_long_message_is_not_taken_and_has_no_answer(void)
{
    memset(request, ' ', sizeof request);
    memcpy(request,
           "\2"
           "1T01",
           5);
    send(request, MESSAGES_REQUEST_BYTES_MAX + 1);
    TEST_ASSERT_EQUAL_UINT32(0, answer_length);
    TEST_ASSERT_EQUAL_UINT32(0, interpreter[0].memory.written);
}

void test_position_of_the_manual(void)
{
    send_text("\4"
              "1");
    assert_answer_text("\4"
                       "1\n         0");
}

TEST_CASE(45823, "1\n     45823")
TEST_CASE(-7, "1\n        -7")
TEST_CASE(2147483647, "1\n2147483647")
TEST_CASE(-999999999, "1\n-999999999")
TEST_CASE(-1234567890, "1\v-1234567890")
void test_a_position_is_right_aligned_and_never_cut(int position, const char *expected)
{
    axis_set_position(&axis[0], position);
    send_text("\4"
              "1");
    TEST_ASSERT_EQUAL_UINT32(1 + strlen(expected), answer_length);
    TEST_ASSERT_EQUAL_STRING_LEN(expected, &answer[1], strlen(expected));
}

void test_the_positions_of_all_motors(void)
{
    axis_set_position(&axis[0], 1);
    axis_set_position(&axis[1], -22);
    axis_set_position(&axis[2], -12345678901);
    send_text("\4"
              "0");
    assert_answer_text("\4"
                       "0\n         1\n       -22\f-12345678901\n         0");
}

void test_the_ends_of_the_position_counter_fit(void)
{
    axis_set_position(&axis[0], INT64_MIN);
    send_text("\4"
              "1");
    assert_answer_text("\4"
                       "1\x14"
                       "-9223372036854775808");
}

void test_get_command_of_the_manual(void)
{
    send_text("\2"
              "2C100");
    send_text("\5"
              "2");
    assert_answer_text("\5"
                       "2C100");
}

void test_no_move_has_no_break_points(void)
{
    send_text("\6"
              "2");
    assert_answer_text("\6"
                       "2  0;[]");
}

/* S100 to V500 under 2000: 60 steps up, 60 steps down. */
void test_the_break_points_of_a_move(void)
{
    send_text("\2"
              "2V500F1000R");
    run_ms(10);
    send_text("\6"
              "2");
    assert_answer_text("\6"
                       "2  4;[(1;100),(60;500),(940;500),(1000;0)]");
}

void test_a_run_without_end_has_no_last_break_point(void)
{
    send_text("\2"
              "2V500G+");
    run_ms(10);
    send_text("\6"
              "2");
    assert_answer_text("\6"
                       "2  2;[(1;100),(60;500)]");
}

void test_the_longest_table_fits(void)
{
    for (unsigned i = 0; i < MOTION_SECTIONS; i++) {
        send_text(i % 2 == 0 ? "\2"
                               "2S2000A60000V16000F16000000Y"
                             : "\2"
                               "2V15000Y");
        run_ms(1);
    }
    send_text("\2"
              "2R");
    run_ms(1);
    send_text("\6"
              "2");
    TEST_ASSERT_EQUAL_STRING_LEN(";[(1;2000),(2100;16000)", &answer[5], 23);
    TEST_ASSERT_EQUAL_STRING_LEN("(160000000;0)]", &answer[answer_length - 14], 14);
}

void test_progress_of_a_motor_that_has_done_nothing(void)
{
    send_text("\7"
              "4");
    assert_answer_text("\7"
                       "4     0; 0");
}

/* As in the manual: 45823 steps made, the fifth command. */
void test_progress_of_the_manual(void)
{
    send_text("\2"
              "4S2000V2000");
    send_text("\2"
              "4F160000@1R");
    run_ms(22911 + 1);
    send_text("\7"
              "4");
    assert_answer_text("\7"
                       "4 45823; 5");
}

void test_progress_is_0_steps_when_the_move_is_over(void)
{
    send_text("\2"
              "4S1000F5R");
    run_ms(100);
    send_text("\7"
              "4");
    assert_answer_text("\7"
                       "4     0; 3");
}

TEST_CASE('1', 1)
TEST_CASE('0', 4)
void test_store_flash_stores(uint8_t motor, unsigned motors)
{
    static uint8_t text[STORE_TEXT_BYTES_MAX];
    uint8_t message[] = {3, motor};
    uint8_t expected[] = {3, motor, 0};
    send_text("\2"
              "0C100");
    send(message, sizeof message);
    assert_answer(expected, sizeof expected);
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        TEST_ASSERT_EQUAL_UINT32(i < motors ? 4 : 0, store_load(&store, i, text));
    }
}

void test_store_flash_for_all_motors_tells_the_first_error_and_stores_the_others(void)
{
    static uint8_t text[STORE_TEXT_BYTES_MAX];
    send_text("\2"
              "0C100");
    machine.faults.flash_fail_at = 1;
    send_text("\3"
              "0");
    assert_answer("\3"
                  "0\1",
                  3);
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        TEST_ASSERT_EQUAL_UINT32(i == 0 ? 0 : 4, store_load(&store, i, text));
    }
}
