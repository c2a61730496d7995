/*
 * A Modbus server by itself: frames in as hexadecimal text, with a CRC of an implementation of its own, requests and
 * answers looked at one by one. For tests of positioning/modbus and of what is built on it.
 */
#ifndef MODBUS_RIG_H
#define MODBUS_RIG_H

#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base_tick.h"
#include "modbus.h"
#include "rig_crc.h"

enum {
    RIG_NODE = 1,
    RIG_RATE_BD = 19200,
    RIG_CHARACTER_BITS = 11,
    RIG_ROOM = 300,
    RIG_TEXT_ROOM = (3 * RIG_ROOM) + 1,
};

#define RIG_CHARACTER_TICKS ((uint64_t)48125)
#define RIG_SILENCE_TICKS ((uint64_t)168437) /* T, 3.5 characters */

struct rig_frame {
    uint8_t bytes[RIG_ROOM];
    uint32_t length;
};

static struct modbus server;
static uint64_t rig_tick;

static inline struct rig_frame rig_bytes(const char *text)
{
    struct rig_frame frame = {.length = 0};
    char *end = NULL;
    for (unsigned long byte = strtoul(text, &end, 16); end != text; byte = strtoul(text, &end, 16)) {
        frame.bytes[frame.length++] = (uint8_t)byte;
        text = end;
    }
    return frame;
}

/* The bytes of a text, and their CRC. */
static inline struct rig_frame rig_sealed(const char *text)
{
    struct rig_frame frame = rig_bytes(text);
    uint16_t crc = rig_crc(frame.bytes, frame.length);
    frame.bytes[frame.length++] = (uint8_t)(crc & 0xFFU);
    frame.bytes[frame.length++] = (uint8_t)(crc >> 8U);
    return frame;
}

static inline void rig_start(uint32_t rate_bd, uint32_t character_bits)
{
    struct modbus_setup setup = {
        .start_tick = rig_tick,
        .rate_bd = rate_bd,
        .character_bits = character_bits,
        .identity = {.objects = {"open firmware", "POS4", "01.00"}},
        .node = RIG_NODE,
    };
    modbus_init(&server, &setup);
}

static inline uint64_t rig_poll_in(uint64_t ticks)
{
    rig_tick += ticks;
    return modbus_poll(&server, rig_tick, false);
}

/* T of silence, and a character in which a byte could still have come. */
static inline void rig_wait(void)
{
    (void)rig_poll_in(RIG_SILENCE_TICKS + RIG_CHARACTER_TICKS);
}

static inline void rig_set_up(void)
{
    rig_tick = 12345678901;
    rig_start(RIG_RATE_BD, RIG_CHARACTER_BITS);
    rig_wait();
}

/* A byte whose end is so long after the end of the one before. */
static inline void rig_take_after(uint64_t ticks, uint8_t value, bool broken)
{
    rig_tick += ticks;
    modbus_take(&server, &(struct hal_line_byte){.tick = rig_tick, .value = value, .broken = broken});
}

static inline void rig_take(const uint8_t *bytes, uint32_t length)
{
    for (uint32_t i = 0; i < length; i++) {
        rig_take_after(RIG_CHARACTER_TICKS, bytes[i], false);
    }
}

static inline void rig_take_frame(const struct rig_frame *frame)
{
    rig_take(frame->bytes, frame->length);
    rig_wait();
}

/* A frame as it stands in the text, and the silence after it. */
static inline void rig_take_text(const char *text)
{
    struct rig_frame frame = rig_bytes(text);
    rig_take_frame(&frame);
}

/* Likewise, with its CRC added. */
static inline void rig_take_sealed(const char *text)
{
    struct rig_frame frame = rig_sealed(text);
    rig_take_frame(&frame);
}

/* Bytes as text, blanks between them. */
static inline void rig_put_text(char room[RIG_TEXT_ROOM], const struct rig_frame *frame)
{
    room[0] = '\0';
    for (uint32_t i = 0; i < frame->length; i++) {
        (void)snprintf(&room[i * 3U], 4, "%02X ", frame->bytes[i]);
    }
    if (frame->length != 0U) {
        room[frame->length * 3U - 1U] = '\0';
    }
}

/* What goes out, as text. */
static inline const char *rig_sent(void)
{
    static char out[RIG_TEXT_ROOM];
    struct rig_frame frame = {.length = 0};
    for (; modbus_is_sending(&server); modbus_advance(&server)) {
        frame.bytes[frame.length++] = modbus_byte(&server);
    }
    rig_put_text(out, &frame);
    return out;
}

/* Sends what has been answered. */
static inline void assert_sent(const char *text)
{
    (void)rig_poll_in(0);
    TEST_ASSERT_EQUAL_STRING(text, rig_sent());
}

/* The bytes of a text and their CRC go out. */
static inline void assert_sent_sealed(const char *text)
{
    char expected[RIG_TEXT_ROOM];
    struct rig_frame frame = rig_sealed(text);
    rig_put_text(expected, &frame);
    assert_sent(expected);
}

static inline void assert_nothing_sent(void)
{
    assert_sent("");
}

static inline void assert_count(uint32_t expected, enum modbus_count count)
{
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(expected, server.counts[count], modbus_count_text(count));
}

/* All counts but these two are 0; a count of 0 for MODBUS_COUNTS_TOTAL: one. */
static inline void assert_only(uint32_t first, enum modbus_count of_first, uint32_t second, enum modbus_count of_second)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_COUNTS_TOTAL; i++) {
        uint32_t expected = i == (unsigned)of_first ? first : i == (unsigned)of_second ? second : 0U;
        assert_count(expected, (enum modbus_count)i);
    }
}

#endif
