/*
 * A line by itself: bytes in at 115 200 Bd, requests and answers looked at one by one. For tests of gve134/line.
 */
#ifndef GVE_LINE_RIG_H
#define GVE_LINE_RIG_H

#include "unity.h"

#include <stdio.h>
#include <string.h>

#include "base_tick.h"
#include "gve_line.h"

enum {
    INTERPOLATOR = 0,
    SPINDLE = 7,
    OUT_ROOM = 200,
};

#define BYTE_TICKS ((uint64_t)7292) /* at 115 200 Bd */
#define SILENCE_TICKS ((uint64_t)100 * TICKS_PER_MS)
#define GAP_TICKS ((uint64_t)1000 * TICKS_PER_MS)

static struct gve_line line;
static struct gve_request request;
static uint64_t tick;

static inline void take_byte(uint8_t value, bool broken)
{
    tick += BYTE_TICKS;
    gve_line_take(&line, &(struct hal_line_byte){.tick = tick, .value = value, .broken = broken});
}

static inline void take(const char *bytes)
{
    for (; *bytes != '\0'; bytes++) {
        take_byte((uint8_t)*bytes, false);
    }
}

/* They come together, as many as fit. */
static inline void take_together(const char *bytes)
{
    while (*bytes != '\0') {
        struct hal_line_run run = {.tick = ++tick};
        while (*bytes != '\0' && run.count < (uint32_t)HAL_LINE_RUN_MAX) {
            run.bytes[run.count++] = (uint8_t)*bytes++;
        }
        gve_line_take_run(&line, &run);
    }
}

static inline void wait(uint64_t ticks)
{
    tick += ticks;
    (void)gve_line_poll(&line, tick);
}

/* What goes out. */
static inline const char *sent(void)
{
    static char out[OUT_ROOM];
    unsigned length = 0;
    while (gve_line_is_sending(&line)) {
        out[length++] = (char)gve_line_byte(&line);
        gve_line_advance(&line);
    }
    out[length] = '\0';
    return out;
}

static inline void assert_nothing(void)
{
    TEST_ASSERT_FALSE(gve_line_next(&line, &request));
}

static inline void assert_next(enum gve_opcode opcode)
{
    TEST_ASSERT_TRUE(gve_line_next(&line, &request));
    TEST_ASSERT_EQUAL_UINT8(GVE_REQUEST_COMMAND, request.kind);
    TEST_ASSERT_EQUAL_STRING(gve_fault_text(GVE_FAULT_NONE), gve_fault_text((enum gve_fault)request.fault));
    TEST_ASSERT_EQUAL_STRING(gve_words(opcode)->name, gve_words(request.command.opcode)->name);
}

static inline void assert_next_fault(enum gve_fault fault)
{
    TEST_ASSERT_TRUE(gve_line_next(&line, &request));
    TEST_ASSERT_EQUAL_UINT8(GVE_REQUEST_COMMAND, request.kind);
    TEST_ASSERT_EQUAL_STRING(gve_fault_text(fault), gve_fault_text((enum gve_fault)request.fault));
}

static inline void assert_next_kind(enum gve_request_kind kind)
{
    TEST_ASSERT_TRUE(gve_line_next(&line, &request));
    TEST_ASSERT_EQUAL_UINT8(kind, request.kind);
}

static inline void answer(unsigned digit, const char *values)
{
    gve_line_answer(&line, (enum gve_code)(digit % GVE_INTA), digit >= GVE_INTA, (const uint8_t *)values,
                    (uint32_t)strlen(values));
}

static inline void assert_answer(const char *expected, unsigned digit, const char *values)
{
    answer(digit, values);
    TEST_ASSERT_EQUAL_STRING(expected, sent());
}

static inline void switch_sums_on(void)
{
    take("!0%+\r");
    assert_next(GVE_SUMS_ON);
    assert_answer("0,5C\r", 0, "");
}

static inline void rig_set_up(void)
{
    tick = UINT64_C(0xFFFFFF00);
    memset(&line, 0xA5, sizeof line);
    gve_line_init(&line, INTERPOLATOR, SPINDLE);
}

#endif
