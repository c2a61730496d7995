/*
 * Two masters on one line, each with a unit of its own, that know nothing of each other: they talk at the same time,
 * into each other's requests and into the answers. Bytes that overlap come garbled, half of them without an error of
 * their own. Each master repeats by the rules of line.md, after a pause that differs by chance.
 */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "line_bench.h"
#include "unity.h"

enum {
    SIDES = 2, /* a master and its unit */
    REQUESTS = 1200,
    STEPS_PER_BYTE = 5,
    FRAME_MAX = 64, /* on this line */
    INCOMING_MAX = 8,
    ATTEMPTS_MAX = 30,
    VALUES_APART = 10000,
    PATIENCE_STEPS = 2000, /* 200 ms */
    PAUSE_STEPS = 10,      /* 1 ms, times a random byte */
    LIMIT_STEPS = 15 * 60 * 10000,
};

#define STEP_TICKS ((uint64_t)HOST_LINE_BYTE_TICKS / STEPS_PER_BYTE)

struct master {
    uint8_t frame[FRAME_BYTES_MAX(16)];
    uint32_t length;
    uint32_t next;     /* the byte that is on the line or will be; `length`: all are out */
    uint32_t phase;    /* steps that it has been on the line */
    uint32_t wait;     /* steps until it sends, or sends again */
    uint32_t made;     /* requests that have been answered */
    uint32_t attempts; /* of the request in progress */
    uint32_t repeats;
    uint8_t number;
    uint8_t heard[FRAME_MAX];
    uint32_t heard_length;
};

struct side {
    struct bench bench;
    struct master master;
    struct host_line_byte incoming[2][INCOMING_MAX]; /* for the unit: what it hears now, and what it will */
    uint32_t incoming_count;
    unsigned filling;
    bool garbled[2]; /* the byte on the line of the master, of the unit */
};

static struct side sides[SIDES];
static uint32_t collisions;

/* The first two requests begin the session; then each sets the position counter, or asks for it. */
static void prepare_request(unsigned which)
{
    struct master *master = &sides[which].master;
    char message[16] = {MESSAGES_VERSION};
    size_t length = 1;
    if (master->made >= 2 && master->made % 2 == 0) {
        length = (size_t)snprintf(message, sizeof message, "%c1=%u", MESSAGES_SET_COMMAND,
                                  which * VALUES_APART + (unsigned)master->made);
    } else if (master->made >= 2) {
        length = (size_t)snprintf(message, sizeof message, "%c1", MESSAGES_GET_POSITION);
    }
    master->number = (uint8_t)(master->number == UINT8_MAX ? 1 : master->number + 1U);
    master->length = frame_write(master->frame, (uint8_t)(which + 1U), master->number, message, (uint32_t)length);
    master->next = 0;
    master->attempts = 0;
    master->wait = 1U + line_random_byte();
}

static void assert_answer(unsigned which, const uint8_t *content, uint32_t length)
{
    const struct master *master = &sides[which].master;
    char expected[32];
    size_t expected_length = 4;
    if (master->made < 2) {
        expected_length = (size_t)snprintf(expected, sizeof expected, "%c\x10" RKM04_VERSION, MESSAGES_VERSION);
    } else if (master->made % 2 == 0) {
        memcpy(expected, "\0021\0\0", expected_length);
    } else {
        expected_length = (size_t)snprintf(expected, sizeof expected, "%c1\x0a%10u", MESSAGES_GET_POSITION,
                                           which * VALUES_APART + (unsigned)master->made - 1U);
    }
    TEST_ASSERT_EQUAL_UINT32(expected_length, length);
    TEST_ASSERT_EQUAL_MEMORY(expected, content, length);
}

/* A flag has come. */
static void take_frame(unsigned which)
{
    struct master *master = &sides[which].master;
    uint8_t content[FRAME_MAX];
    uint32_t length = frame_read(content, master->heard, master->heard_length);
    master->heard_length = 1;
    bool answers = length >= 3 && content[0] == (0x80U | (which + 1U)) && content[1] == master->number;
    if (answers && master->next == master->length && master->made < REQUESTS) {
        assert_answer(which, content + 2, length - 2U);
        master->made++;
        prepare_request(which);
    }
}

static void master_hear(unsigned which, uint8_t value)
{
    struct master *master = &sides[which].master;
    if (value == 0x7E) {
        master->heard[0] = value;
        master->heard[master->heard_length++] = value;
        take_frame(which);
    } else if (master->heard_length < FRAME_MAX - 1) {
        master->heard[master->heard_length++] = value;
    }
}

static bool is_unit_driving(const struct side *side)
{
    return side->bench.machine.line.to_send_count != 0;
}

static bool is_master_driving(const struct master *master)
{
    return master->made < REQUESTS && master->wait == 0 && master->next < master->length;
}

/* A byte ends: all hear it that do not talk themselves. */
static void deliver(unsigned from, bool of_unit, uint8_t value)
{
    bool *garbled = &sides[from].garbled[of_unit ? 1 : 0];
    bool broken = *garbled && line_random_byte() % 2 == 0;
    value = *garbled ? value ^ line_random_byte() : value;
    collisions += *garbled ? 1U : 0U;
    *garbled = false;
    for (unsigned i = 0; i < SIDES; i++) {
        struct side *side = &sides[i];
        if (!is_unit_driving(side) && !(of_unit && i == from)) {
            TEST_ASSERT_LESS_THAN_UINT32(INCOMING_MAX, side->incoming_count);
            side->incoming[side->filling][side->incoming_count++] =
                (struct host_line_byte){.tick = bench_now(&side->bench), .value = value, .broken = broken};
        }
        if (!broken && !is_master_driving(&side->master) && (of_unit || i != from)) {
            master_hear(i, value);
        }
    }
}

static void on_line(void *context, uint64_t tick, uint8_t value)
{
    (void)tick;
    deliver(context == &sides[0].bench ? 0 : 1, true, value);
}

static void master_step(unsigned which)
{
    struct master *master = &sides[which].master;
    if (master->made == REQUESTS) {
        return;
    }
    if (master->wait != 0) {
        master->wait--;
    } else if (master->next < master->length) {
        if (++master->phase == STEPS_PER_BYTE) {
            master->phase = 0;
            master->next++;
            deliver(which, false, master->frame[master->next - 1U]);
        }
        master->wait = master->next < master->length ? 0 : PATIENCE_STEPS + (uint32_t)line_random_byte() * PAUSE_STEPS;
    } else {
        TEST_ASSERT_LESS_THAN_UINT32_MESSAGE(ATTEMPTS_MAX, ++master->attempts, "no answer gets through");
        master->repeats++;
        master->next = 0;
    }
}

static void unit_step(struct side *side)
{
    host_machine_set_line(&side->bench.machine, side->incoming[side->filling], side->incoming_count);
    side->filling ^= 1U;
    side->incoming_count = 0;
    bench_run_ticks(&side->bench, STEP_TICKS);
}

/* More than one talks. */
static void garble(void)
{
    unsigned talking = 0;
    for (unsigned i = 0; i < SIDES; i++) {
        talking += (is_master_driving(&sides[i].master) ? 1U : 0U) + (is_unit_driving(&sides[i]) ? 1U : 0U);
    }
    for (unsigned i = 0; i < SIDES && talking > 1; i++) {
        sides[i].garbled[0] = sides[i].garbled[0] || is_master_driving(&sides[i].master);
        sides[i].garbled[1] = sides[i].garbled[1] || is_unit_driving(&sides[i]);
    }
}

static bool is_done(void)
{
    return sides[0].master.made == REQUESTS && sides[1].master.made == REQUESTS;
}

void setUp(void)
{
    collisions = 0;
    for (unsigned i = 0; i < SIDES; i++) {
        struct side *side = &sides[i];
        memset(side, 0, sizeof *side);
        bench_init(&side->bench);
        host_machine_set_node(&side->bench.machine, (uint8_t)(i + 1U));
        bench_restart(&side->bench);
        side->bench.machine.listener.line = on_line;
        side->master.heard[0] = 0x7E;
        side->master.heard_length = 1;
        side->master.number = line_random_byte();
        prepare_request(i);
    }
}

void tearDown(void)
{
    for (unsigned i = 0; i < SIDES; i++) {
        bench_check(&sides[i].bench);
    }
}

/* What has been executed is what stands in the memory: each command once, in its order, and nothing else. */
static void assert_executed_once(unsigned which)
{
    static char expected[MESSAGES_ANSWER_BYTES_MAX];
    int length = 0;
    for (unsigned made = 2; made < REQUESTS; made += 2) {
        length += snprintf(expected + length, sizeof expected - (size_t)length, "=%u", which * VALUES_APART + made);
    }
    host_machine_select(&sides[which].bench.machine);
    TEST_ASSERT_EQUAL_STRING(expected, bench_ask(&sides[which].bench, MESSAGES_GET_COMMAND, 1));
}

void test_two_masters_that_talk_at_once_get_their_answers_and_all_is_executed_once(void)
{
    uint32_t steps = 0;
    for (; !is_done(); steps++) {
        TEST_ASSERT_LESS_THAN_UINT32(LIMIT_STEPS, steps);
        garble();
        for (unsigned i = 0; i < SIDES; i++) {
            master_step(i);
        }
        for (unsigned i = 0; i < SIDES; i++) {
            unit_step(&sides[i]);
        }
    }
    uint32_t repeats = sides[0].master.repeats + sides[1].master.repeats;
    uint32_t known = 0;
    for (unsigned i = 0; i < SIDES; i++) {
        known += sides[i].bench.unit.line.link.receiver.counts[LINK_COUNT_REPEATS];
        assert_executed_once(i);
    }
    printf("%u requests, %" PRIu32 " repeats, %" PRIu32 " of them of executed requests, %" PRIu32
           " garbled bytes, %" PRIu32 " s\n",
           SIDES * REQUESTS, repeats, known, collisions, steps / 10000U);
    TEST_ASSERT_GREATER_THAN_UINT32(50, known);
    TEST_ASSERT_GREATER_THAN_UINT32(50, repeats - known);
}
