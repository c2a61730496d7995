/*
 * The rig of the tests of the whole positioning unit: the host machine, a master that sends frames and hears answers,
 * and what the pins show.
 *
 * To be included by one test program alone.
 */
#ifndef POS_RIG_H
#define POS_RIG_H

#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base_tick.h"
#include "epoch.h"
#include "host_machine.h"
#include "modbus_crc.h"
#include "positioning.h"

enum {
    RIG_FRAME = 300,
    RIG_AHEAD_TICKS = 512 * TICKS_PER_US,
    RIG_PULSES = 20000,
};

static struct host_machine machine;
static struct pos_unit unit;
static struct host_line_byte rig_script[RIG_FRAME];
static uint8_t rig_heard[RIG_FRAME];
static uint32_t rig_heard_count;
static int64_t rig_position[UNIT_MOTORS];
static uint64_t rig_tick[UNIT_MOTORS][RIG_PULSES];
static unsigned rig_pulses[UNIT_MOTORS];
static uint8_t rig_leds;

static inline void rig_step(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    rig_position[motor] += backward ? -1 : 1;
    if (rig_pulses[motor] < RIG_PULSES) {
        rig_tick[motor][rig_pulses[motor]] = tick;
    }
    rig_pulses[motor]++;
}

static inline void rig_line(void *context, uint64_t tick, uint8_t value)
{
    (void)context;
    (void)tick;
    TEST_ASSERT_LESS_THAN(RIG_FRAME, rig_heard_count);
    rig_heard[rig_heard_count++] = value;
}

static inline void rig_led(void *context, uint64_t tick, unsigned led, bool on)
{
    (void)context;
    (void)tick;
    rig_leds = (uint8_t)(on ? rig_leds | 1U << led : rig_leds & ~(1U << led));
}

static inline uint64_t rig_poll(void *context)
{
    (void)context;
    uint64_t wake = positioning_poll(&unit);
    TEST_ASSERT_EQUAL_UINT32(0, machine.late_steps);
    return wake;
}

/* The unit with what the flash of the machine has. */
static inline void rig_begin(void)
{
    memset(&unit, 0xA5, sizeof unit);
    positioning_init(&unit);
    positioning_start(&unit);
}

static inline void rig_set_up(void)
{
    host_machine_init(&machine, epoch_random());
    machine.ahead_ticks = RIG_AHEAD_TICKS;
    machine.listener = (struct host_listener){.step = rig_step, .line = rig_line, .led = rig_led};
    host_machine_select(&machine);
    rig_heard_count = 0;
    rig_leds = 0;
    memset(rig_position, 0, sizeof rig_position);
    memset(rig_pulses, 0, sizeof rig_pulses);
    rig_begin();
}

static inline void rig_run_ticks(uint64_t ticks)
{
    host_machine_run(&machine, machine.now + ticks, rig_poll, NULL, NULL);
}

static inline void rig_run_ms(uint64_t ms)
{
    rig_run_ticks(ms * TICKS_PER_MS);
}

static inline uint64_t rig_be_late(void *context)
{
    (void)context;
    return TICK_NEVER;
}

static inline void rig_run_without_main(uint64_t ticks)
{
    host_machine_run(&machine, machine.now + ticks, rig_be_late, NULL, NULL);
}

/* Runs until an axis stands, or for so long. */
static inline void rig_run_until_rest(unsigned axis, uint64_t ms)
{
    for (uint64_t i = 0; i < ms && pos_axis_is_busy(&unit.axes[axis - 1U]); i++) {
        rig_run_ms(1);
    }
}

static inline uint32_t rig_bytes_of(const char *text, uint8_t *bytes)
{
    uint32_t count = 0;
    char *end = NULL;
    for (unsigned long byte = strtoul(text, &end, 16); end != text; byte = strtoul(text, &end, 16)) {
        bytes[count++] = (uint8_t)byte;
        text = end;
    }
    return count;
}

/* Sends a frame as hexadecimal text, from the present moment on; it has come when T after it is over. */
static inline void rig_send(const char *text)
{
    uint8_t bytes[RIG_FRAME];
    uint32_t count = rig_bytes_of(text, bytes);
    uint64_t byte_ticks = machine.line.byte_ticks;
    for (uint32_t i = 0; i < count; i++) {
        rig_script[i] = (struct host_line_byte){.tick = machine.now + (i + 1U) * byte_ticks, .value = bytes[i]};
    }
    rig_heard_count = 0;
    host_machine_set_line(&machine, rig_script, count);
    rig_run_ticks(count * byte_ticks + (byte_ticks * 7U) / 2U);
}

/* Sends a frame, and looks at the answer that comes within 20 ms and what it takes to send. */
static inline void rig_expect(const char *request, const char *answer)
{
    uint8_t bytes[RIG_FRAME];
    char heard[3 * RIG_FRAME] = "";
    char wanted[3 * RIG_FRAME] = "";
    uint32_t count = rig_bytes_of(answer, bytes);
    rig_send(request);
    rig_run_ticks(20 * TICKS_PER_MS + (uint64_t)count * machine.line.byte_ticks);
    for (uint32_t i = 0; i < count; i++) {
        (void)snprintf(&wanted[3U * i], 4, "%02X ", bytes[i]);
    }
    for (uint32_t i = 0; i < rig_heard_count; i++) {
        (void)snprintf(&heard[3U * i], 4, "%02X ", rig_heard[i]);
    }
    TEST_ASSERT_EQUAL_STRING_MESSAGE(wanted, heard, request);
}

/* Sends a request whose CRC is added, and hears its answer out. The exception; 0: none. */
static inline unsigned rig_ask(const char *request)
{
    uint8_t bytes[RIG_FRAME];
    char text[3 * RIG_FRAME] = "";
    uint32_t count = rig_bytes_of(request, bytes);
    uint16_t crc = MODBUS_CRC_START;
    for (uint32_t i = 0; i < count; i++) {
        crc = modbus_crc_append(crc, bytes[i]);
    }
    bytes[count++] = (uint8_t)(crc & 0xFFU);
    bytes[count++] = (uint8_t)(crc >> 8U);
    for (uint32_t i = 0; i < count; i++) {
        (void)snprintf(&text[3U * i], 4, "%02X ", bytes[i]);
    }
    rig_send(text);
    rig_run_ticks(20 * TICKS_PER_MS + 80U * (uint64_t)machine.line.byte_ticks);
    TEST_ASSERT_GREATER_THAN_UINT32_MESSAGE(0, rig_heard_count, request);
    return (rig_heard[1] & 0x80U) != 0U ? rig_heard[2] : 0U;
}

/* A register of the answer. */
static inline unsigned rig_word(unsigned index)
{
    return (unsigned)rig_heard[3U + 2U * index] << 8U | rig_heard[4U + 2U * index];
}

/* What an axis shows. */
static inline struct pos_values rig_values(unsigned axis)
{
    struct pos_values values;
    pos_read(&unit, axis, &values);
    return values;
}

/* STATUS as the register has it. */
static inline unsigned rig_status(unsigned axis)
{
    struct pos_values values = rig_values(axis);
    return (unsigned)values.status.status1 << 8U | values.status.status2;
}

static inline unsigned rig_control(unsigned axis)
{
    return unit.axes[axis - 1U].control->control2;
}

#endif
