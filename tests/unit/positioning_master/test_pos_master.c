/* The master of positioning units against the server of one, on a line that loses, damages, echoes and is late. */
#include "unity.h"

#include <string.h>

#include "modbus.h"
#include "pos_master.h"

enum {
    NODE = 3,
    OTHER_NODE = 4,
    BAUD = 19200,
    PATIENCE_MS = 300,
    ATTEMPTS = 4,
    FOREVER_MS = 60000,
    LINE_BYTES_MAX = 1U << 16U,
    NEXT_MS = 3, /* more than 3.5 characters */
};

#define MS UINT64_C(1000000)

static const uint8_t read_two[] = {MODBUS_READ, 0, 10, 0, 2};
static const uint8_t write_two[] = {MODBUS_WRITE, 0, 100, 0, 2, 4, 1, 2, 3, 4};
static const uint8_t write_one[] = {MODBUS_WRITE_ONE, 0, 100, 7, 8};
static const uint8_t identify[] = {MODBUS_IDENTIFY, 14, 1, 0};
static const uint8_t store[] = {MODBUS_WRITE, 0, 40, 0, 1, 2, 0, 1};
static const uint16_t values[MODBUS_READ_MAX] = {0x0102, 0x0304};

/* What is under way to the master, in the order of time. */
static struct {
    uint64_t ns;
    uint8_t byte;
} line[LINE_BYTES_MAX];
static uint32_t line_from;
static uint32_t line_to;

static struct pos_master master;
static struct modbus unit;
static uint64_t now_ns;
static uint64_t sent_ns; /* when the last frame began to go out */
static uint64_t answer_ms;
static unsigned frames; /* that the master has sent */
static unsigned executed;
static unsigned requests_to_lose; /* the next ones do not get to the unit */
static unsigned answers_to_lose;
static unsigned answers_to_damage;
static enum modbus_exception exception;
static bool echo;
static bool off; /* nobody is there */

void setUp(void)
{
    const struct modbus_setup setup = {
        .rate_bd = BAUD,
        .character_bits = POS_MASTER_CHARACTER_BITS,
        .identity = {{"open firmware", "POS4", "01.00"}},
        .node = NODE,
    };
    pos_master_init(&master, BAUD, false);
    modbus_init(&unit, &setup);
    now_ns = 100 * MS;
    line_from = line_to = 0;
    answer_ms = 5;
    frames = executed = requests_to_lose = answers_to_lose = answers_to_damage = 0;
    exception = MODBUS_EXCEPTION_NONE;
    echo = off = false;
}

void tearDown(void)
{
}

static bool happens(unsigned *times)
{
    bool does = *times > 0;
    *times -= does ? 1U : 0U;
    return does;
}

static void say_at(uint64_t ns, uint8_t byte)
{
    line[line_to].ns = ns;
    line[line_to].byte = byte;
    line_to++;
}

static void say_all(uint64_t ms, const uint8_t *bytes, uint32_t length)
{
    for (uint32_t i = 0; i < length; i++) {
        say_at(now_ns + ms * MS, bytes[i]);
    }
}

/* A frame of any content after `ms`. */
static void say_frame(uint64_t ms, const uint8_t *content, uint32_t length)
{
    uint8_t frame[MODBUS_FRAME_BYTES_MAX];
    memcpy(frame, content, length);
    say_all(ms, frame, pos_master_seal(frame, length));
}

static uint64_t tick_of(uint64_t ns)
{
    return ns * TICKS_PER_MS / MS;
}

static void execute(const struct modbus_request *request)
{
    if (exception != MODBUS_EXCEPTION_NONE) {
        modbus_refuse(&unit, exception);
        return;
    }
    executed++;
    modbus_answer(&unit, request->read_count > 0 ? values : NULL);
}

/* The unit hears a frame; what it answers is lost, damaged, or on its way. */
static void give_to_unit(void)
{
    uint64_t end_ns = now_ns;
    for (uint32_t i = 0; i < master.out_length; i++) {
        end_ns += master.byte_ns;
        struct hal_line_byte byte = {.tick = tick_of(end_ns), .value = master.sent.bytes[i]};
        modbus_take(&unit, &byte);
        TEST_ASSERT_NULL(modbus_next(&unit));
    }
    uint64_t tick = tick_of(end_ns + 2 * master.gap_ns);
    (void)modbus_poll(&unit, tick, true);
    const struct modbus_request *request = modbus_next(&unit);
    if (request != NULL) {
        execute(request);
        (void)modbus_poll(&unit, tick + 1U, true);
    }
    bool lost = happens(&answers_to_lose);
    bool damaged = happens(&answers_to_damage);
    for (uint32_t i = 0; modbus_is_sending(&unit); i++, modbus_advance(&unit)) {
        if (!lost) {
            say_at(end_ns + answer_ms * MS, modbus_byte(&unit) ^ (uint8_t)(damaged && i == 3U));
        }
    }
}

static void carry(void)
{
    frames++;
    sent_ns = now_ns;
    if (echo) {
        say_all(0, master.sent.bytes, master.out_length);
    }
    if (!happens(&requests_to_lose) && !off) {
        give_to_unit();
    }
    master.out_length = 0;
}

/* What its owner does, each ms. */
static enum pos_master_end pass(void)
{
    uint8_t bytes[MODBUS_FRAME_BYTES_MAX];
    uint32_t length = 0;
    while (line_from < line_to && line[line_from].ns <= now_ns && length < sizeof bytes) {
        bytes[length++] = line[line_from++].byte;
    }
    pos_master_take(&master, bytes, length, now_ns);
    enum pos_master_end end = pos_master_poll(&master, now_ns);
    if (master.out_length > 0) {
        carry();
    }
    return end;
}

static enum pos_master_end finish(void)
{
    for (unsigned ms = 0; ms < FOREVER_MS; ms++) {
        enum pos_master_end end = pass();
        if (end != POS_MASTER_WAITS) {
            return end;
        }
        now_ns += MS;
    }
    TEST_FAIL_MESSAGE("the request does not end");
    return POS_MASTER_WAITS;
}

static void begin(uint8_t node, uint32_t attempts, const uint8_t *request, uint32_t length)
{
    const struct pos_master_order order = {
        .node = node,
        .length = length,
        .patience_ms = PATIENCE_MS,
        .attempts = attempts,
    };
    memcpy(master.request, request, length);
    pos_master_ask(&master, &order, now_ns);
}

static enum pos_master_end ask(const uint8_t *request, uint32_t length)
{
    begin(NODE, ATTEMPTS, request, length);
    return finish();
}

static void expect_answer(const uint8_t *answer, uint32_t length)
{
    TEST_ASSERT_EQUAL(length, pos_master_answer_length(&master));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(answer, pos_master_answer(&master), length);
}

static const uint8_t two_read[] = {MODBUS_READ, 4, 1, 2, 3, 4};

static void expect_two(enum pos_master_end end)
{
    TEST_ASSERT_EQUAL(POS_MASTER_ANSWERED, end);
    expect_answer(two_read, sizeof two_read);
}

static enum pos_master_end read(void)
{
    return ask(read_two, sizeof read_two);
}

/* ---- what is answered -------------------------------------------------------------------------------------------- */

void test_a_read_has_the_values_in_its_answer(void)
{
    expect_two(read());
    TEST_ASSERT_EQUAL(1, frames);
}

void test_a_write_and_an_identification_are_answered(void)
{
    static const uint8_t written[] = {MODBUS_WRITE, 0, 100, 0, 2};
    TEST_ASSERT_EQUAL(POS_MASTER_ANSWERED, ask(write_two, sizeof write_two));
    expect_answer(written, sizeof written);
    now_ns += NEXT_MS * MS;
    TEST_ASSERT_EQUAL(POS_MASTER_ANSWERED, ask(write_one, sizeof write_one));
    expect_answer(write_one, sizeof write_one);
    now_ns += NEXT_MS * MS;
    TEST_ASSERT_EQUAL(POS_MASTER_ANSWERED, ask(identify, sizeof identify));
    TEST_ASSERT_EQUAL(7 + 2 + 13 + 2 + 4 + 2 + 5, pos_master_answer_length(&master));
    TEST_ASSERT_EQUAL(3, frames);
}

void test_a_refusal_is_not_repeated(void)
{
    static const uint8_t refused[] = {MODBUS_READ | MODBUS_REFUSED, MODBUS_EXCEPTION_ADDRESS};
    exception = MODBUS_EXCEPTION_ADDRESS;
    TEST_ASSERT_EQUAL(POS_MASTER_REFUSED, read());
    expect_answer(refused, sizeof refused);
    TEST_ASSERT_EQUAL(1, frames);
}

void test_what_a_gateway_says_of_an_absent_unit_is_asked_again(void)
{
    exception = (enum modbus_exception)POS_MASTER_AWAY;
    TEST_ASSERT_EQUAL(POS_MASTER_ABSENT, read());
    TEST_ASSERT_EQUAL(ATTEMPTS, frames);
}

void test_a_broadcast_ends_when_it_has_gone_out_and_the_units_had_their_time(void)
{
    begin(MODBUS_ADDRESS_BROADCAST, ATTEMPTS, write_one, sizeof write_one);
    TEST_ASSERT_EQUAL(POS_MASTER_ANSWERED, finish());
    TEST_ASSERT_EQUAL(1, frames);
    TEST_ASSERT_EQUAL(1, executed);
    TEST_ASSERT_EQUAL(0, pos_master_answer_length(&master));
    TEST_ASSERT_GREATER_OR_EQUAL(sent_ns + POS_MASTER_TURN_MS * MS, now_ns);
}

void test_an_answer_that_comes_in_pieces_is_taken(void)
{
    uint8_t frame[MODBUS_FRAME_BYTES_MAX] = {NODE};
    memcpy(frame + 1, two_read, sizeof two_read);
    uint32_t length = pos_master_seal(frame, 1 + sizeof two_read);
    off = true;
    begin(NODE, 1, read_two, sizeof read_two);
    for (uint32_t i = 0; i < length; i++) {
        say_all(200 + (POS_MASTER_REST_MS / 2) * (uint64_t)i, frame + i, 1);
    }
    expect_two(finish());
}

void test_the_answer_is_found_among_noise(void)
{
    static const uint8_t noise[] = {NODE, MODBUS_READ, 200, NODE, 0xFF};
    say_all(30, noise, sizeof noise);
    answer_ms = 40;
    expect_two(read());
    TEST_ASSERT_EQUAL(1, frames);
}

/* ---- echoes ------------------------------------------------------------------------------------------------------ */

void test_an_echo_is_no_answer(void)
{
    echo = true;
    expect_two(read());
    now_ns += NEXT_MS * MS;
    TEST_ASSERT_EQUAL(POS_MASTER_ANSWERED, ask(write_two, sizeof write_two));
    TEST_ASSERT_EQUAL(2, frames);
}

void test_nothing_but_an_echo_is_told(void)
{
    echo = off = true;
    TEST_ASSERT_EQUAL(POS_MASTER_ECHOED, read());
    TEST_ASSERT_EQUAL(ATTEMPTS, frames);
}

void test_an_echo_does_not_shorten_the_patience(void)
{
    echo = true;
    answer_ms = PATIENCE_MS - 10;
    expect_two(read());
    TEST_ASSERT_EQUAL(1, frames);
}

void test_a_damaged_answer_after_an_echo_is_damage(void)
{
    echo = true;
    answers_to_damage = ATTEMPTS;
    TEST_ASSERT_EQUAL(POS_MASTER_DAMAGED, read());
}

/* ---- loss and damage --------------------------------------------------------------------------------------------- */

void test_a_lost_request_is_sent_again(void)
{
    requests_to_lose = ATTEMPTS - 1;
    expect_two(read());
    TEST_ASSERT_EQUAL(ATTEMPTS, frames);
    TEST_ASSERT_EQUAL(1, executed);
}

void test_a_lost_answer_is_asked_for_again(void)
{
    answers_to_lose = 1;
    expect_two(read());
    TEST_ASSERT_EQUAL(2, executed);
}

void test_silence_ends_after_all_attempts(void)
{
    off = true;
    TEST_ASSERT_EQUAL(POS_MASTER_SILENT, read());
    TEST_ASSERT_EQUAL(ATTEMPTS, frames);
    begin(NODE, 1, read_two, sizeof read_two);
    TEST_ASSERT_EQUAL(POS_MASTER_SILENT, finish());
    TEST_ASSERT_EQUAL(ATTEMPTS + 1, frames);
}

void test_a_damaged_answer_is_asked_for_again_when_the_line_rests(void)
{
    uint64_t begin_ns = now_ns;
    answers_to_damage = 1;
    expect_two(read());
    TEST_ASSERT_EQUAL(2, frames);
    TEST_ASSERT_LESS_THAN((PATIENCE_MS - 50) * MS, sent_ns - begin_ns);
    TEST_ASSERT_GREATER_OR_EQUAL(POS_MASTER_REST_MS * MS, sent_ns - begin_ns);
}

void test_damage_is_told_from_silence_and_from_frames_of_others(void)
{
    static const uint8_t others[] = {OTHER_NODE, MODBUS_READ, 2, 0, 1};
    uint64_t begin_ns = now_ns;
    answers_to_damage = ATTEMPTS;
    TEST_ASSERT_EQUAL(POS_MASTER_DAMAGED, read());
    TEST_ASSERT_LESS_THAN(ATTEMPTS * (POS_MASTER_REST_MS + 50) * MS, now_ns - begin_ns);
    off = true;
    now_ns += 1000 * MS;
    begin(NODE, 1, read_two, sizeof read_two);
    say_frame(30, others, sizeof others);
    say_frame(40, others, sizeof others);
    TEST_ASSERT_EQUAL(POS_MASTER_SILENT, finish());
}

void test_the_answer_of_another_unit_or_to_another_function_is_none(void)
{
    static const uint8_t others[] = {OTHER_NODE, MODBUS_READ, 4, 9, 9, 9, 9};
    static const uint8_t other_function[] = {NODE, MODBUS_READ_INPUTS, 4, 9, 9, 9, 9};
    say_frame(25, others, sizeof others);
    say_frame(26, other_function, sizeof other_function);
    answer_ms = 50;
    expect_two(read());
}

void test_a_line_that_hums_does_not_keep_a_request_for_ever(void)
{
    for (unsigned ms = 0; ms < 20000; ms++) {
        static const uint8_t hum = 0x55;
        say_all(ms, &hum, 1);
    }
    uint64_t begin_ns = now_ns;
    begin(NODE, 1, write_one, sizeof write_one);
    off = true;
    TEST_ASSERT_EQUAL(POS_MASTER_DAMAGED, finish());
    TEST_ASSERT_LESS_OR_EQUAL(begin_ns + (POS_MASTER_OTHERS_MS_MAX + 1) * MS, sent_ns);
    TEST_ASSERT_LESS_THAN(begin_ns + 2000 * MS, now_ns);
}

void test_an_answer_is_found_after_more_noise_than_there_is_room_for(void)
{
    uint8_t noise[3 * MODBUS_FRAME_BYTES_MAX];
    memset(noise, NODE, sizeof noise);
    say_all(30, noise, sizeof noise);
    answer_ms = 45;
    expect_two(read());
}

/* ---- times ------------------------------------------------------------------------------------------------------- */

void test_the_silence_between_frames_is_three_and_a_half_characters_or_1750_us(void)
{
    TEST_ASSERT_EQUAL_UINT64(UINT64_C(11) * 1000000000 / BAUD * 7 / 2, master.gap_ns);
    pos_master_init(&master, 115200, false);
    TEST_ASSERT_EQUAL_UINT64(1750000, master.gap_ns);
    pos_master_init(&master, 0, false);
    TEST_ASSERT_EQUAL_UINT64(1750000, master.gap_ns);
}

void test_a_request_goes_out_when_the_line_was_silent_long_enough(void)
{
    expect_two(read());
    uint64_t answered_ns = now_ns;
    expect_two(read());
    TEST_ASSERT_GREATER_OR_EQUAL(answered_ns + master.gap_ns, sent_ns);
    TEST_ASSERT_LESS_OR_EQUAL(answered_ns + NEXT_MS * MS, sent_ns);
}

void test_what_comes_before_the_request_has_gone_out_is_dropped(void)
{
    static const uint8_t stale[] = {NODE, MODBUS_READ, 4, 9, 9, 9, 9};
    say_frame(0, stale, sizeof stale);
    uint64_t begin_ns = now_ns;
    expect_two(read());
    TEST_ASSERT_GREATER_OR_EQUAL(begin_ns + master.gap_ns, sent_ns);
}

void test_an_answer_that_is_too_late_is_not_taken_for_the_next_one(void)
{
    static const uint8_t stale[] = {NODE, MODBUS_READ, 4, 9, 9, 9, 9};
    off = true;
    begin(NODE, 1, read_two, sizeof read_two);
    TEST_ASSERT_EQUAL(POS_MASTER_SILENT, finish());
    say_frame(POS_MASTER_REST_MS - 20, stale, sizeof stale);
    off = false;
    expect_two(read());
    TEST_ASSERT_EQUAL(2, frames);
}

void test_after_a_repeat_a_second_answer_is_waited_for(void)
{
    static const uint8_t second[] = {NODE, MODBUS_READ, 4, 9, 9, 9, 9};
    requests_to_lose = 1;
    expect_two(read());
    say_frame(POS_MASTER_REST_MS - 20, second, sizeof second);
    expect_two(read());
    TEST_ASSERT_EQUAL(3, frames);
    uint64_t answered_ns = now_ns;
    expect_two(read());
    TEST_ASSERT_LESS_OR_EQUAL(answered_ns + NEXT_MS * MS, sent_ns);
}

void test_the_answer_to_store_may_take_its_time(void)
{
    static const uint8_t both[] = {MODBUS_WRITE_AND_READ, 0, 0, 0, 1, 0, 39, 0, 2, 4, 0, 0, 0, 1};
    answer_ms = 2000;
    TEST_ASSERT_EQUAL(POS_MASTER_ANSWERED, ask(store, sizeof store));
    TEST_ASSERT_EQUAL(1, frames);
    TEST_ASSERT_EQUAL(POS_MASTER_STORE_MS, pos_master_more_ms(both, sizeof both));
    TEST_ASSERT_EQUAL(0, pos_master_more_ms(write_one, sizeof write_one));
    TEST_ASSERT_EQUAL(0, pos_master_more_ms(store, 1));
    now_ns += NEXT_MS * MS;
    begin(NODE, 1, write_two, sizeof write_two);
    TEST_ASSERT_EQUAL(POS_MASTER_SILENT, finish());
}

/* ---- requests that are given up ---------------------------------------------------------------------------------- */

void test_one_that_has_not_been_written_owes_nothing(void)
{
    begin(NODE, ATTEMPTS, write_two, sizeof write_two);
    pos_master_poll(&master, now_ns);
    TEST_ASSERT_GREATER_THAN(0, master.out_length);
    uint64_t begin_ns = now_ns;
    expect_two(read());
    TEST_ASSERT_EQUAL_UINT64(begin_ns, sent_ns);
    TEST_ASSERT_EQUAL(1, executed);
}

void test_the_answer_to_one_that_has_been_written_is_dropped(void)
{
    static const uint8_t read_other[] = {MODBUS_READ, 0, 99, 0, 1};
    answer_ms = 60;
    begin(NODE, ATTEMPTS, read_other, sizeof read_other);
    pass();
    TEST_ASSERT_EQUAL(1, frames);
    expect_two(read());
    TEST_ASSERT_EQUAL(2, frames);
}
