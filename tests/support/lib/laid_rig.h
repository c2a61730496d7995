/*
 * A step output for the tests of one channel, on the mock of hal_step.h: a queue of the pulses that have been laid, and
 * no clock. A test makes the pulses.
 *
 * It asks for pulses until LAID_AHEAD of them wait: 1 is one at a time, as a backend with little time ahead would. It
 * is as strict as the headers of the seam allow: once a client has had no more, it asks again only when none waits or
 * when told to run, and after pulses were taken back only when told to run. What the headers forbid fails the test.
 * To be included by one test program alone, after the mock.
 */
#ifndef LAID_RIG_H
#define LAID_RIG_H

#include <string.h>

#include "hal_step.h"
#include "mock_hal_step.h"
#include "unity.h"

#ifndef LAID_AHEAD
#define LAID_AHEAD 1
#endif

enum {
    LAID_MAX = 64,
    LAID_HIGH_TICKS = 210,
    LAID_FAR_TICKS = 1 << 30
};

static struct {
    unsigned (*lay)(struct hal_step_room *room);
    unsigned motor;
    unsigned ahead;    /* pulses that wait while there are more */
    unsigned at_once;  /* places of a question at most */
    unsigned too_late; /* of the pulses that wait, the first ones that are not taken back any more */
    uint32_t tick[LAID_MAX];
    bool backward[LAID_MAX];
    bool direction;     /* DIR with the pulse made last, or as set since */
    uint32_t made;      /* pulses, ever */
    uint32_t laid;      /* pulses, ever, but for those taken back */
    uint32_t back;      /* pulses taken back, ever */
    uint32_t last_tick; /* of the last pulse made; until then where the time begins */
    unsigned holds;
    unsigned runs; /* times that the client told to run */
    bool dry;      /* the client had no more */
    bool told;     /* to run, since pulses were taken back */
    bool main_has_work;
} laid;

static inline unsigned laid_waiting(void)
{
    return laid.laid - laid.made;
}

/* When the next pulse comes. */
static inline uint32_t laid_next_tick(void)
{
    TEST_ASSERT_GREATER_THAN_UINT_MESSAGE(0, laid_waiting(), "no pulse waits");
    return laid.tick[laid.made % LAID_MAX];
}

static inline unsigned laid_ask(unsigned places)
{
    struct hal_step_pulse pulse[LAID_MAX];
    struct hal_step_room room = {
        .pulse = pulse,
        .count = places < laid.at_once ? places : laid.at_once,
        .waiting = laid_waiting(),
        .until_tick = laid.last_tick + (uint32_t)LAID_FAR_TICKS,
        .high_ticks = LAID_HIGH_TICKS,
        .backward = laid_waiting() == 0 ? laid.direction : laid.backward[(laid.laid - 1U) % LAID_MAX],
    };
    unsigned count = laid.lay(&room);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(room.count, count);
    for (unsigned i = 0; i < count; i++) {
        TEST_ASSERT_EQUAL_UINT32(LAID_HIGH_TICKS, pulse[i].fall_tick - pulse[i].rise_tick);
        laid.backward[laid.laid % LAID_MAX] = room.backward;
        laid.tick[laid.laid++ % LAID_MAX] = pulse[i].rise_tick;
    }
    laid.main_has_work = laid.main_has_work || room.main_has_work;
    return count;
}

/* Whether DIR has to change before the last pulse that waits. */
static inline bool laid_turns(void)
{
    return laid_waiting() != 0 && laid.backward[(laid.laid - 1U) % LAID_MAX] != laid.direction;
}

static inline void laid_fill(void)
{
    laid.dry = laid.dry && laid_waiting() != 0;
    laid.told = laid.told || laid_waiting() == 0;
    while (laid.told && !laid.dry && !laid_turns() && laid_waiting() < laid.ahead) {
        laid.dry = laid_ask(laid.ahead - laid_waiting()) == 0;
    }
}

/* The edge of the next pulse, and the interrupt after it; returns its tick. */
static inline uint32_t laid_make_pulse(void)
{
    laid.last_tick = laid_next_tick();
    laid.direction = laid.backward[laid.made % LAID_MAX];
    laid.made++;
    laid.main_has_work = false;
    laid_fill();
    return laid.last_tick;
}

static inline void laid_run_seen(unsigned motor, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_UINT(laid.motor, motor);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, laid.holds, "told to run without a hold");
    laid.runs++;
    laid.told = true;
    laid.dry = false;
    laid_fill();
}

static inline unsigned laid_waiting_asked(unsigned motor, int calls)
{
    (void)calls;
    TEST_ASSERT_EQUAL_UINT(laid.motor, motor);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, laid.holds, "asked without a hold");
    return laid_waiting();
}

static inline unsigned laid_take_back(unsigned motor, unsigned count, int calls)
{
    unsigned most = laid_waiting() > laid.too_late ? laid_waiting() - laid.too_late : 0;
    unsigned back = count < most ? count : most;
    (void)calls;
    TEST_ASSERT_EQUAL_UINT(laid.motor, motor);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, laid.holds, "taken back without a hold");
    laid.laid -= back;
    laid.back += back;
    laid.told = laid.told && back == 0;
    laid.dry = laid.dry && back == 0;
    return back;
}

static inline void laid_direction_set(unsigned motor, bool backward, int calls)
{
    (void)calls;
    laid.direction = backward;
    TEST_ASSERT_EQUAL_UINT(laid.motor, motor);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, laid_waiting(), "turned while a pulse waits");
}

static inline void laid_hold(void)
{
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, laid.holds, "held twice");
    laid.holds++;
}

static inline void laid_release(void)
{
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, laid.holds, "released without a hold");
    laid.holds--;
}

static inline void laid_hold_seen(int calls)
{
    (void)calls;
    laid_hold();
}

static inline void laid_release_seen(int calls)
{
    (void)calls;
    laid_release();
}

/* Of a motor whose channel lays pulses with `lay`; time begins at a tick. */
static inline void laid_init(unsigned motor, uint32_t tick, unsigned (*lay)(struct hal_step_room *room))
{
    memset(&laid, 0, sizeof laid);
    laid.lay = lay;
    laid.motor = motor;
    laid.ahead = LAID_AHEAD;
    laid.at_once = LAID_MAX;
    laid.last_tick = tick;
    hal_step_run_Stub(laid_run_seen);
    hal_step_waiting_Stub(laid_waiting_asked);
    hal_step_take_back_Stub(laid_take_back);
    hal_step_set_direction_Stub(laid_direction_set);
    hal_step_hold_Stub(laid_hold_seen);
    hal_step_release_Stub(laid_release_seen);
}

#endif
