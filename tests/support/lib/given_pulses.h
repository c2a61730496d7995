/*
 * Pulses that a test gives, and a client's lay_isr that lays them: for tests of the host machine without an engine.
 *
 * To be included by one test program alone. A motor's pulses are laid in the order in which they were given, as many as
 * the backend asks for.
 */
#ifndef GIVEN_PULSES_H
#define GIVEN_PULSES_H

#include "base_limits.h"
#include "base_tick.h"
#include "hal_step.h"
#include "unity.h"

enum {
    GIVEN_MAX = 256
};

static struct {
    uint32_t tick[GIVEN_MAX];
    enum {
        GIVEN_AS_IT_IS,
        GIVEN_FORWARD,
        GIVEN_BACKWARD
    } way[GIVEN_MAX];
    unsigned count;
    unsigned laid; /* the first ones, less those that were taken back */
} given[UNIT_MOTORS];

static inline void given_clear(void)
{
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        given[motor].count = 0;
        given[motor].laid = 0;
    }
}

/* A pulse the way that DIR is. */
static inline void give(unsigned motor, uint32_t tick)
{
    TEST_ASSERT_LESS_THAN_UINT(GIVEN_MAX, given[motor].count);
    given[motor].way[given[motor].count] = GIVEN_AS_IT_IS;
    given[motor].tick[given[motor].count++] = tick;
}

static inline void give_way(unsigned motor, uint32_t tick, bool backward)
{
    give(motor, tick);
    given[motor].way[given[motor].count - 1U] = backward ? GIVEN_BACKWARD : GIVEN_FORWARD;
}

/* Whether DIR has to change before the next pulse. */
static inline bool given_turns(unsigned motor, bool backward)
{
    unsigned way = given[motor].way[given[motor].laid];
    return way != GIVEN_AS_IT_IS && (way == GIVEN_BACKWARD) != backward;
}

static inline unsigned given_lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    unsigned count = 0;
    uint32_t last = room->until_tick - 1U;
    (void)context;
    while (count < room->count && given[motor].laid < given[motor].count && tick_is_before(last, room->until_tick)) {
        bool turns = given_turns(motor, room->backward);
        if (count != 0 && turns) {
            break;
        }
        room->backward = room->backward != turns;
        last = given[motor].tick[given[motor].laid++];
        room->pulse[count++] = (struct hal_step_pulse){.rise_tick = last, .fall_tick = last + room->high_ticks};
    }
    return count;
}

static inline void run_given(unsigned motor)
{
    hal_step_hold();
    hal_step_run(motor);
    hal_step_release();
}

/* Gives one pulse, and has it laid if none of the motor waits. */
static inline void lay_pulse(unsigned motor, uint32_t tick)
{
    give(motor, tick);
    run_given(motor);
}

static inline unsigned waiting_given(unsigned motor)
{
    hal_step_hold();
    unsigned waiting = hal_step_waiting(motor);
    hal_step_release();
    return waiting;
}

/* The pulses that come back are to be laid again. */
static inline unsigned take_back_given(unsigned motor, unsigned count)
{
    hal_step_hold();
    unsigned back = hal_step_take_back(motor, count);
    hal_step_release();
    given[motor].laid -= back;
    return back;
}

#endif
