/*
 * The rig of the tests of the whole GVE134 unit: the host machine, a host that sends lines and reads answers, and what
 * the pins show.
 *
 * To be included by one test program alone.
 */
#ifndef GVE_RIG_H
#define GVE_RIG_H

#include "unity.h"

#include <stdio.h>
#include <string.h>

#include "base_tick.h"
#include "epoch.h"
#include "gve134.h"
#include "host_machine.h"

enum {
    RIG_BYTES = 4096,
    RIG_BYTE_TICKS = 7292, /* at 115 200 Bd */
    RIG_AHEAD_TICKS = 512 * TICKS_PER_US,
    RIG_MS = (int)TICKS_PER_MS,
};

static struct host_machine machine;
static struct gve134 unit;
static struct host_line_byte rig_script[RIG_BYTES];
static char rig_heard[RIG_BYTES]; /* bytes that the unit has sent */
static uint32_t rig_heard_count;
static uint64_t rig_heard_tick; /* end of the last one */
static int64_t rig_position[UNIT_MOTORS];
static uint64_t rig_pulse_tick[UNIT_MOTORS]; /* of the last pulse */
static unsigned rig_pulses[UNIT_MOTORS];
static uint8_t rig_outputs;
static uint32_t rig_pwm;
static uint8_t rig_leds;

static inline void rig_step(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    rig_position[motor] += backward ? -1 : 1;
    rig_pulse_tick[motor] = tick;
    rig_pulses[motor]++;
}

static inline void rig_line(void *context, uint64_t tick, uint8_t value)
{
    (void)context;
    TEST_ASSERT_LESS_THAN(RIG_BYTES, rig_heard_count);
    rig_heard[rig_heard_count++] = (char)value;
    rig_heard_tick = tick;
}

static inline void rig_output(void *context, uint64_t tick, uint8_t levels)
{
    (void)context;
    (void)tick;
    rig_outputs = levels;
}

static inline void rig_see_pwm(void *context, uint64_t tick, uint32_t permille)
{
    (void)context;
    (void)tick;
    rig_pwm = permille;
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
    uint64_t wake = gve134_poll(&unit);
    return wake == TICK_NEVER ? TICK_NEVER : wake;
}

/* The unit with what the flash of the machine has. */
static inline void rig_begin(void)
{
    gve134_init(&unit);
    gve134_start(&unit);
}

static inline void rig_set_up(void)
{
    host_machine_init(&machine, epoch_random());
    machine.ahead_ticks = RIG_AHEAD_TICKS;
    machine.listener = (struct host_listener){
        .step = rig_step, .line = rig_line, .output = rig_output, .pwm = rig_see_pwm, .led = rig_led};
    host_machine_set_byte_ticks(&machine, RIG_BYTE_TICKS);
    host_machine_select(&machine);
    rig_heard_count = 0;
    rig_outputs = 0;
    rig_pwm = 0;
    rig_leds = 0;
    memset(rig_position, 0, sizeof rig_position);
    memset(rig_pulse_tick, 0, sizeof rig_pulse_tick);
    memset(rig_pulses, 0, sizeof rig_pulses);
    memset(&unit, 0xA5, sizeof unit);
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

/* Sends bytes, one after the other, from the present moment on, and runs until they have come. */
static inline void rig_send(const char *bytes)
{
    uint32_t count = (uint32_t)strlen(bytes);
    TEST_ASSERT_LESS_THAN(RIG_BYTES, count);
    for (uint32_t i = 0; i < count; i++) {
        rig_script[i] = (struct host_line_byte){.tick = machine.now + (uint64_t)(i + 1U) * (uint64_t)RIG_BYTE_TICKS,
                                                .value = (uint8_t)bytes[i]};
    }
    host_machine_set_line(&machine, rig_script, count);
    rig_run_ticks((uint64_t)(count + 1U) * (uint64_t)RIG_BYTE_TICKS);
}

static inline bool rig_has_answer(void)
{
    return rig_heard_count != 0 && rig_heard[rig_heard_count - 1U] == '\r';
}

/* The answer that comes within some time, without its CR; empty: none. */
static inline const char *rig_answer_within(uint64_t ms)
{
    static char text[RIG_BYTES];
    uint64_t end = machine.now + ms * TICKS_PER_MS;
    while (machine.now < end && !rig_has_answer()) {
        rig_run_ticks(RIG_BYTE_TICKS);
    }
    uint32_t length = rig_has_answer() ? rig_heard_count - 1U : 0U;
    memcpy(text, rig_heard, length);
    text[length] = '\0';
    rig_heard_count = 0;
    return text;
}

/* Sends `!`, a command and CR, and waits for its answer, a minute at most. */
static inline const char *rig_ask(const char *command)
{
    char line[RIG_BYTES];
    (void)snprintf(line, sizeof line, "!%s\r", command);
    rig_heard_count = 0;
    rig_send(line);
    return rig_answer_within(60000);
}

static inline void rig_expect(const char *command, const char *answer)
{
    TEST_ASSERT_EQUAL_STRING_MESSAGE(answer, rig_ask(command), command);
}

/* An input as its port reads it: 1 is open, 0 closed. Inputs count from 1. */
static inline void rig_input(unsigned input, bool port_level)
{
    host_machine_set_input(&machine, input, !port_level);
}

#endif
