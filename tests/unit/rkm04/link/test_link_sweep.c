/*
 * Every frame of a corpus of requests with every truncation, every lost byte, every single and every double bit error:
 * more than a million damaged frames, of which none may be executed.
 *
 * The corpus is what masters send: all messages, programs of the manual, numbers that are flags and escapes. Where an
 * error hits a flag or an escape, one damaged frame in 65 536 has the right FCS by chance; this corpus has none.
 */
#include "unity.h"

#include <stdio.h>
#include <string.h>

#include "frames.h"
#include "link_receiver.h"

enum {
    NODE = 3,
    BITS = 8,
    BYTES_MAX = FRAME_BYTES_MAX(80),
    DAMAGED_MIN = 1000000
};

static const char *const requests[] = {
    "\001",
    "\0020K",
    "\0021C75",
    "\0024V500",
    "\0021\\",
    "\0022]",
    "\0031",
    "\0030",
    "\0040",
    "\0041",
    "\0052",
    "\0063",
    "\0074",
    "\0021C100",
    "\0021F1000 R",
    "\0023 S100 V1000 A2000",
    "\0022D R W500",
    "\0021T55",
    "\0021\\C100 S100 V1000 A2000 F5000 R B2000 R H",
    "\0022\\ S100 V800 A2000 @1 F1000 R W500 D R W1000 J1",
    "\0023I05H10 F2000 R J20 @10 B2000 R @20",
    "\0024L3 F500 R W200 D R W1000 E",
    "\0021O02 B6000 R Z05 F3000 R H",
    "\0022M03 R U W300 V600 B4000 N06 R U",
    "\0023X04 @1 F5000 R W600 B5000 R",
    "\0024I81L6 T02 F2500 '3 C02 C81 J1",
    "\0021V500 A2000 F2000 Y V2000 Y V500 F5000 Y R C05",
    "\0022M05 G+",
    "\0023)05 (06",
    "\0020[ X05 R B300 ]",
    "\0022\\ S200 V2000 A5000 @1 I05H10 F2000 R J20 @10 B2000 R @20 W600 J1",
    "\0023\\C100 S100 V1000 A2000 F5000 M03 R U W200 V600 B4000 N06 R U W300",
    "\0024V3000 A1000 Y V1500 F2000 Y V500 Y R W500 C05 T81 J1 @3",
    "\0021=-2000000000 {counter} G1",
    "\0024}~}~",
};

enum {
    REQUESTS = sizeof requests / sizeof requests[0]
};

static struct link_receiver receiver;
static uint8_t buffer[LINK_BUFFER_BYTES];
static uint8_t frame[BYTES_MAX];
static uint32_t length;
static uint64_t tick;
static unsigned damaged;
static unsigned executed;

/* Each request to the unit and to all, with numbers that look like flags and escapes among others. */
static void make_frame(unsigned i)
{
    static const uint8_t numbers[] = {1, 0x7E, 0x7D, 200};
    uint8_t address = i % 5 == 0 ? 0 : NODE;
    uint8_t number = address == 0 ? 0 : numbers[i % sizeof numbers];
    length = frame_write(frame, address, number, requests[i], (uint32_t)strlen(requests[i]));
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(BYTES_MAX, length);
}

static unsigned take(const uint8_t *bytes, uint32_t count)
{
    unsigned received = 0;
    for (uint32_t i = 0; i < count; i++) {
        struct hal_line_byte byte = {.tick = tick += 43750, .value = bytes[i]};
        received += link_receiver_take(&receiver, &byte) ? 1U : 0U;
    }
    return received;
}

/* The damaged frame between two good ones: only these are heard, whatever state the damage leaves after. */
static void try_damaged(const uint8_t *bytes, uint32_t count)
{
    static const uint8_t good[] = {0x7E, 0x03, 0x01, 0x01, 0xF9, 0x21, 0x7E};
    damaged++;
    executed += take(bytes, count);
    TEST_ASSERT_EQUAL_UINT(1, take(good, sizeof good));
}

static void flip(uint32_t bit)
{
    frame[bit / BITS] ^= (uint8_t)(1U << bit % BITS);
}

static void report(const char *what)
{
    printf("%s: %u damaged frames, %u executed\n", what, damaged, executed);
}

void setUp(void)
{
    tick = 0;
    damaged = 0;
    executed = 0;
    link_receiver_init(&receiver, NODE, buffer);
}

void tearDown(void)
{
}

void test_the_corpus_itself_is_heard(void)
{
    for (unsigned i = 0; i < REQUESTS; i++) {
        bool fits = strlen(requests[i]) <= LINK_REQUEST_BYTES_MAX;
        make_frame(i);
        TEST_ASSERT_EQUAL_UINT_MESSAGE(fits ? 1 : 0, take(frame, length), requests[i]);
        TEST_ASSERT_TRUE(!fits || receiver.length == strlen(requests[i]));
    }
}

/* A frame that has lost its closing flag alone is whole: the flag of the next one closes it. */
void test_no_truncation_is_executed(void)
{
    for (unsigned i = 0; i < REQUESTS; i++) {
        make_frame(i);
        for (uint32_t count = 0; count + 1 < length; count++) {
            try_damaged(frame, count);
            try_damaged(frame + length - count, count);
        }
    }
    report("truncations");
    TEST_ASSERT_EQUAL_UINT(0, executed);
}

void test_no_lost_or_doubled_byte_is_executed(void)
{
    uint8_t other[BYTES_MAX + 1];
    for (unsigned i = 0; i < REQUESTS; i++) {
        make_frame(i);
        for (uint32_t at = 1; at + 1 < length; at++) {
            memcpy(other, frame, at);
            memcpy(other + at, frame + at + 1, length - at - 1);
            try_damaged(other, length - 1);
            memcpy(other, frame, at + 1);
            memcpy(other + at + 1, frame + at, length - at);
            try_damaged(other, length + 1);
        }
    }
    report("lost and doubled bytes");
    TEST_ASSERT_EQUAL_UINT(0, executed);
}

void test_no_single_and_no_double_bit_error_is_executed(void)
{
    for (unsigned i = 0; i < REQUESTS; i++) {
        make_frame(i);
        for (uint32_t first = 0; first < length * BITS; first++) {
            flip(first);
            try_damaged(frame, length);
            for (uint32_t second = first + 1; second < length * BITS; second++) {
                flip(second);
                try_damaged(frame, length);
                flip(second);
            }
            flip(first);
        }
    }
    report("single and double bit errors");
    TEST_ASSERT_GREATER_THAN_UINT(DAMAGED_MIN, damaged);
    TEST_ASSERT_EQUAL_UINT(0, executed);
}
