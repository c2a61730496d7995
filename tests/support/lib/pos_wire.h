/*
 * More for tests of the whole positioning unit, after pos_rig.h: frames byte by byte, whole or damaged, with any times
 * between the bytes; and what a unit at rest is, so that it can be seen that nothing has changed.
 * To be included by one test program alone.
 */
#ifndef POS_WIRE_H
#define POS_WIRE_H

#include "modbus_corpus.h"
#include "pos_rig.h"

enum {
    WIRE_CHARACTER_TICKS = 48125,
    WIRE_SILENCE_TICKS = 168437, /* T, at 19 200 Bd */
    WIRE_ANSWER_MS = 200,        /* of the longest one, and more */
    WIRE_ROOM = 600,
    WIRE_NONE = -1,
};

struct wire_frame {
    uint8_t bytes[WIRE_ROOM];
    uint32_t length;
};

static struct host_line_byte wire_script[WIRE_ROOM];
static uint32_t wire_length;
static uint64_t wire_tick; /* of the last byte */

/* What stands in a unit at rest. */
struct wire_state {
    struct pos_registers registers;
    struct {
        struct pos_order order;
        struct pos_frame frame;
        uint32_t feed;
        uint16_t error;
        uint8_t state;
        uint8_t control;
        bool armed;
    } axes[POS_AXES];
    uint32_t flash_operations;
    unsigned pulses;
};

static struct wire_state wire_kept;
static uint32_t wire_counts[MODBUS_COUNTS_TOTAL];

static inline void wire_seal(struct wire_frame *frame)
{
    uint16_t crc = MODBUS_CRC_START;
    for (uint32_t i = 0; i < frame->length; i++) {
        crc = modbus_crc_append(crc, frame->bytes[i]);
    }
    frame->bytes[frame->length++] = (uint8_t)(crc & 0xFFU);
    frame->bytes[frame->length++] = (uint8_t)(crc >> 8U);
}

/* A request of the corpus, or another text, and its CRC. */
static inline struct wire_frame wire_sealed(const char *text)
{
    struct wire_frame frame;
    frame.length = rig_bytes_of(text, frame.bytes);
    wire_seal(&frame);
    return frame;
}

static inline void wire_begin(void)
{
    wire_length = 0;
    wire_tick = machine.now;
    rig_heard_count = 0;
}

/* A byte after so many ticks of silence. */
static inline void wire_put(uint8_t value, uint64_t silence_ticks, bool broken)
{
    wire_tick += silence_ticks + WIRE_CHARACTER_TICKS;
    wire_script[wire_length++] = (struct host_line_byte){.tick = wire_tick, .value = value, .broken = broken};
}

/* Bytes one after the other; `broken` is the place of a bad one, or WIRE_NONE. */
static inline void wire_put_frame(const struct wire_frame *frame, int broken)
{
    for (uint32_t i = 0; i < frame->length; i++) {
        wire_put(frame->bytes[i], 0, (int)i == broken);
    }
}

/* All of it comes, then T of silence, and what is answered goes out. */
static inline void wire_end(void)
{
    host_machine_set_line(&machine, wire_script, wire_length);
    rig_run_ticks(wire_tick - machine.now + WIRE_SILENCE_TICKS + WIRE_CHARACTER_TICKS);
    for (uint32_t i = 0; i < WIRE_ANSWER_MS && (modbus_is_sending(&unit.server) || machine.line.to_send_count != 0);
         i++) {
        rig_run_ms(1);
    }
}

static inline void wire_send(const struct wire_frame *frame)
{
    wire_begin();
    wire_put_frame(frame, WIRE_NONE);
    wire_end();
}

/* Sends a request whose CRC is added. The exception; 0: none. */
static inline unsigned wire_ask(const struct wire_frame *request)
{
    struct wire_frame frame = *request;
    wire_seal(&frame);
    wire_send(&frame);
    TEST_ASSERT_GREATER_THAN_UINT32(4, rig_heard_count);
    TEST_ASSERT_EQUAL_HEX8(frame.bytes[1], rig_heard[1] & 0x7FU);
    return (rig_heard[1] & 0x80U) != 0U ? rig_heard[2] : 0U;
}

static inline void wire_word(struct wire_frame *frame, uint32_t word)
{
    frame->bytes[frame->length++] = (uint8_t)(word >> 8U & 0xFFU);
    frame->bytes[frame->length++] = (uint8_t)(word & 0xFFU);
}

/* 3 or 4. */
static inline unsigned wire_read(uint8_t function, uint32_t first, uint32_t count)
{
    struct wire_frame frame = {.bytes = {1, function}, .length = 2};
    wire_word(&frame, first);
    wire_word(&frame, count);
    return wire_ask(&frame);
}

/* 6, or 16 with one or two registers. */
static inline unsigned wire_write(uint8_t function, uint32_t first, uint32_t value, bool wide)
{
    struct wire_frame frame = {.bytes = {1, function}, .length = 2};
    wire_word(&frame, first);
    if (function == (uint8_t)MODBUS_WRITE) {
        wire_word(&frame, wide ? 2 : 1);
        frame.bytes[frame.length++] = wide ? 4 : 2;
    }
    if (wide) {
        wire_word(&frame, value >> 16U);
    }
    wire_word(&frame, value & 0xFFFFU);
    return wire_ask(&frame);
}

static inline struct wire_state wire_state(void)
{
    struct wire_state state;
    memset(&state, 0, sizeof state);
    state.registers = unit.registers;
    state.flash_operations = machine.flash_operations;
    for (unsigned i = 0; i < (unsigned)POS_AXES; i++) {
        const struct pos_axis *axis = &unit.axes[i];
        memcpy(&state.axes[i].order, &axis->order, sizeof axis->order);
        memcpy(&state.axes[i].frame, &axis->frame, sizeof axis->frame);
        state.axes[i].feed = axis->feed;
        state.axes[i].error = axis->error;
        state.axes[i].state = axis->state;
        state.axes[i].control = axis->control->control2 & (uint8_t)~(unsigned)POS_CNT_RESET;
        state.axes[i].armed = axis->watch.armed;
        state.pulses += rig_pulses[i];
    }
    return state;
}

static inline void wire_keep(void)
{
    wire_kept = wire_state();
    memcpy(wire_counts, unit.server.counts, sizeof wire_counts);
}

/* The values that are only shown may be other ones. */
static inline void wire_assert_same(void)
{
    struct wire_state state = wire_state();
    for (unsigned i = 0; i < (unsigned)POS_AXES; i++) {
        for (unsigned index = 0; index < (unsigned)POS_AXIS_REGISTERS; index++) {
            const struct pos_place place = {.axis = (uint8_t)(i + 1U), .index = (uint8_t)index};
            bool shown = pos_row(&place)->use == (uint8_t)POS_USE_READ && index != (unsigned)POS_AXIS_DONE &&
                         index != (unsigned)POS_AXIS_RESULT;
            shown = shown || pos_row(&place)->use == (uint8_t)POS_USE_MOTION;
            TEST_ASSERT_TRUE(shown || state.registers.axes[i][index] == wire_kept.registers.axes[i][index]);
        }
    }
    for (unsigned index = 0; index < (unsigned)POS_UNIT_REGISTERS; index++) {
        const struct pos_place place = {.axis = 0, .index = (uint8_t)index};
        bool shown = pos_row(&place)->use == (uint8_t)POS_USE_READ;
        TEST_ASSERT_TRUE(shown || state.registers.unit[index] == wire_kept.registers.unit[index]);
    }
    TEST_ASSERT_EQUAL_MEMORY(wire_kept.axes, state.axes, sizeof state.axes);
    TEST_ASSERT_EQUAL_UINT(wire_kept.pulses, state.pulses);
    TEST_ASSERT_EQUAL_UINT32(wire_kept.flash_operations, state.flash_operations);
}

static inline uint32_t wire_counted(enum modbus_count count)
{
    return unit.server.counts[count] - wire_counts[count];
}

static inline uint32_t wire_dropped(void)
{
    return wire_counted(MODBUS_COUNT_CRC) + wire_counted(MODBUS_COUNT_LENGTH) + wire_counted(MODBUS_COUNT_BROKEN);
}

#endif
