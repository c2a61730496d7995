/*
 * The rig of the tests of homing: the reference switch is input 3 and is active between two steps of the motor of axis
 * 1, which is watched at its pins.
 *
 * To be included by one test program alone.
 */
#ifndef POS_HOME_RIG_H
#define POS_HOME_RIG_H

#include "pos_rig.h"

#define FEED(mm_per_min) ((uint32_t)(mm_per_min) << 16U)

enum {
    SWITCH = 3,
    ACCEL = 500,
};

static int64_t switch_from; /* steps between which the switch is active */
static int64_t switch_to;

static inline uint64_t poll(void *context)
{
    bool active = rig_position[0] >= switch_from && rig_position[0] <= switch_to;
    host_machine_set_input(&machine, SWITCH, active);
    return rig_poll(context);
}

/* The switch follows the motor within 50 us, before the next pulse. */
static inline void run_ms(uint64_t ms)
{
    for (uint64_t i = 0; i < ms * 20U; i++) {
        host_machine_run(&machine, machine.now + TICKS_PER_MS / 20U, poll, NULL, NULL);
    }
}

static inline void set(uint32_t number, uint32_t value, bool wide)
{
    const uint16_t words[] = {(uint16_t)(value >> 16U), (uint16_t)value};
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE,
                          positioning_write(&unit, number, wide ? 2 : 1, wide ? words : &words[1]));
}

static inline void set_up_homing(void)
{
    rig_set_up();
    rig_run_ms(10);
    set(148, SWITCH, false);
    set(154, 20000, true);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, 1, 0));
    switch_from = 300;
    switch_to = 100000;
}

static inline void home(unsigned method, int32_t position_um)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, method, position_um, ACCEL, 1));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, FEED(1000), 1, 1));
}

/* Runs until homing is in a part of it, and moves. */
static inline void run_until(enum pos_phase phase)
{
    for (unsigned i = 0; i < 5000 && unit.axes[0].phase != (uint8_t)phase; i++) {
        run_ms(1);
    }
    TEST_ASSERT_EQUAL_UINT8(phase, unit.axes[0].phase);
}

static inline void assert_home(int32_t position_um)
{
    struct pos_values values = rig_values(1);
    TEST_ASSERT_EQUAL_HEX(0x0803, rig_status(1) & 0xFDFFU);
    TEST_ASSERT_EQUAL_INT32(position_um, values.position_um);
    TEST_ASSERT_EQUAL_HEX(POS_FLAG_REFERENCED, values.flags & (POS_FLAG_REFERENCED | POS_FLAG_HOMING));
    TEST_ASSERT_EQUAL_INT32(0, values.way_left_um);
}

#endif
