/*
 * The rig of the tests of a group: four motors that each follow an axis, on the host machine; what their pins show.
 *
 * To be included by one test program alone.
 */
#ifndef GROUP_RIG_H
#define GROUP_RIG_H

#include "group.h"
#include "unity.h"

#include "base_tick.h"
#include "epoch.h"
#include "hal_run.h"
#include "hal_step.h"
#include "hal_time.h"
#include "host_machine.h"
#include "step_generator.h"

enum {
    RING = 16,
    LONG_RING = 64,
    AHEAD_TICKS = 512 * TICKS_PER_US,
    START_TICKS = TICKS_PER_MS,
    PULSES = 20000,
};

static struct host_machine machine;
static struct group group;
static struct step_channel channels[UNIT_MOTORS];
static struct path_section ring[LONG_RING];

static uint64_t made_tick[UNIT_MOTORS][PULSES];
static unsigned made[UNIT_MOTORS];
static int64_t position[UNIT_MOTORS]; /* at the pins */
static uint64_t turned_tick[UNIT_MOTORS];
static bool stop_asked;
static uint64_t busy_until; /* main does not come to its pass before */
static int64_t ordered[UNIT_MOTORS];

static uint64_t laying_ticks; /* what laying pulses takes once */

static inline unsigned lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    (void)context;
    machine.now += laying_ticks;
    laying_ticks = 0;
    return step_channel_lay_isr(&channels[motor], room);
}

static inline void tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
    if (stop_asked && group_stop_isr(&group, AXIS_CAUSE_HIGH)) {
        hal_run_plan();
    }
}

static inline void plan_isr(void *context)
{
    (void)context;
    group_plan_isr(&group);
}

static inline void step_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    if (made[motor] < PULSES) {
        made_tick[motor][made[motor]] = tick;
    }
    made[motor]++;
    position[motor] += backward ? -1 : 1;
    TEST_ASSERT_TRUE(turned_tick[motor] == 0 || tick - turned_tick[motor] >= HOST_SETUP_TICKS);
}

static inline void direction_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    (void)backward;
    unsigned last = made[motor] - 1U;
    TEST_ASSERT_TRUE(made[motor] == 0 || made[motor] > PULSES || tick - made_tick[motor][last] >= HOST_HOLD_TICKS);
    turned_tick[motor] = tick;
}

static inline uint64_t poll(void *context)
{
    (void)context;
    return machine.now < busy_until ? machine.epoch + busy_until : group_poll(&group);
}

static inline void begin_ring(uint32_t ahead_ticks, uint32_t places)
{
    static const struct hal_client client = {.lay_isr = lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    host_machine_init(&machine, epoch_random());
    machine.ahead_ticks = ahead_ticks;
    machine.listener = (struct host_listener){.step = step_seen, .direction = direction_seen};
    host_machine_select(&machine);
    group_init(&group, ring, places);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        step_channel_init(&channels[motor], motor);
        group_connect(&group, motor, &channels[motor], motor);
        made[motor] = 0;
        position[motor] = 0;
        ordered[motor] = 0;
        turned_tick[motor] = 0;
    }
    stop_asked = false;
    busy_until = 0;
    hal_run_start(&client);
}

static inline void begin(uint32_t ahead_ticks)
{
    begin_ring(ahead_ticks, RING);
}

static inline struct path_vector vector_of(int32_t x, int32_t y, int32_t z, int32_t a, uint32_t speed)
{
    struct path_vector vector = {
        .steps = {x, y, z, a},
        .speed = speed * PATH_SPEED_UNITS,
        .accel = 1000000 * STEP_ACCEL_PER_ACCEL,
        .border_speed = UINT32_MAX,
    };
    uint64_t length = 0;
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        uint64_t steps = (uint64_t)(vector.steps[axis] < 0 ? -(int64_t)vector.steps[axis] : vector.steps[axis]);
        length = steps > length ? steps : length;
    }
    vector.extent2 = length * length;
    return vector;
}

static inline void add(int32_t x, int32_t y, int32_t z, int32_t a, uint32_t speed)
{
    struct path_vector vector = vector_of(x, y, z, a, speed);
    TEST_ASSERT_TRUE(group_add(&group, &vector));
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        ordered[motor] += vector.steps[motor];
    }
}

static inline void start(void)
{
    TEST_ASSERT_TRUE(group_start(&group, hal_time_now() + START_TICKS));
    host_machine_run(&machine, machine.now + 1U, poll, NULL, NULL);
}

static inline void run_us(uint64_t microseconds)
{
    host_machine_run(&machine, machine.now + microseconds * TICKS_PER_US, poll, NULL, NULL);
}

static inline void run_to_the_end(void)
{
    for (unsigned i = 0; i < 10000 && !group_take_end(&group); i++) {
        run_us(1000);
    }
    TEST_ASSERT_FALSE(group_is_busy(&group));
}

static inline void assert_arrived(void)
{
    TEST_ASSERT_FALSE(group_has_rest(&group));
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_INT64(ordered[motor], position[motor]);
        TEST_ASSERT_EQUAL_INT64(ordered[motor], step_channel_position(&channels[motor]));
    }
}

static inline void add_zigzag(void)
{
    add(1000, 333, -777, 1, 20000);
    add(500, -500, -20, 0, 10000);
    add(-300, -100, 299, -1, 30000);
    add(0, 7, 0, 800, 40000);
}

static inline uint32_t slow(const void *context, uint32_t section)
{
    (void)section;
    return *(const uint32_t *)context * PATH_SPEED_UNITS;
}

#endif
