/* What no command of a unit shows of the queue, or its tests cannot tell apart. The rest is in tests/system/gve134. */
#include "gve_queue_rig.h"

enum {
    X_CLOSED = 1, /* the reference switch of X, active at level 0 */
    X_ENABLED = 1,
};

void setUp(void)
{
    rig_set_up();
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

void test_a_stop_at_rest_does_nothing(void)
{
    gve_queue_stop(&queue);
    TEST_ASSERT_FALSE(gve_queue_is_stopping(&queue));
    rig_move(0, 50);
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_INT64(50, rig_position[0]);
    TEST_ASSERT_FALSE(gve_queue_inta(&queue));
}

void test_a_halt_at_rest_is_over_at_once_and_one_of_what_moves_is_not(void)
{
    TEST_ASSERT_TRUE(gve_queue_halt(&queue));
    gve_queue_go(&queue, machine.inputs);
    rig_move(0, 50);
    TEST_ASSERT_FALSE(gve_queue_halt(&queue));
    rig_run_to_the_end();
    TEST_ASSERT_TRUE(gve_queue_halt(&queue));
}

void test_what_is_entered_does_not_move_before_it_is_begun(void)
{
    rig_enter(0, 50);
    rig_enter(0, -20);
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_INT64(0, rig_position[0]);
    TEST_ASSERT_EQUAL_UINT32(GVE_QUEUE_VECTORS - 2, gve_queue_room(&queue));
    gve_queue_begin(&queue, machine.inputs);
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_INT64(30, rig_position[0]);
}

/* ---- interrupts ------------------------------------------------------------------------------------------------ */

/* X goes at 100 000 pulses/s, 200 000 of them on. */
static void begin_fast(void)
{
    queue.modal.speed = 100000;
    queue.modal.accel = 8000;
    rig_move(0, 200000);
    rig_run_ms(50);
    rig_main_is_busy = true;
}

/* It does so for less than half a millisecond, then comes its ramp of 625 pulses, though main comes later. */
static void expect_braked_from(int64_t position)
{
    host_machine_run(&machine, machine.now + 600U * TICKS_PER_US, rig_poll, NULL, NULL);
    rig_main_is_busy = false;
    rig_run_to_the_end();
    TEST_ASSERT_INT64_WITHIN(25, position + 25 + 625, rig_position[0]);
    TEST_ASSERT_TRUE(gve_queue_inta(&queue));
}

void test_an_interrupt_brakes_the_axes_while_main_is_busy(void)
{
    gve_guards_write(&queue.guards, GVE_STATUS_ENABLED_1, X_ENABLED);
    begin_fast();
    host_machine_set_input(&machine, 1, true);
    expect_braked_from(rig_position[0]);
}

void test_an_interrupt_that_is_enabled_while_it_is_active_brakes_at_once(void)
{
    host_machine_set_input(&machine, 1, true);
    begin_fast();
    gve_guards_write(&queue.guards, GVE_STATUS_ENABLED_1, X_ENABLED);
    gve_queue_sense(&queue, machine.inputs);
    expect_braked_from(rig_position[0]);
}

void test_inputs_ask_for_the_plan_interrupt_where_they_stop_the_axes_only(void)
{
    gve_guards_write(&queue.guards, GVE_STATUS_ENABLED_1, X_ENABLED);
    TEST_ASSERT_FALSE(gve_queue_sense_isr(&queue, X_CLOSED));
    rig_move(0, 5000);
    rig_run_ms(500);
    TEST_ASSERT_FALSE(gve_queue_sense_isr(&queue, 0));
    TEST_ASSERT_TRUE(gve_queue_sense_isr(&queue, X_CLOSED));
    TEST_ASSERT_FALSE(gve_queue_sense_isr(&queue, X_CLOSED));
    rig_run_to_the_end();
}

/* ---- speeds ---------------------------------------------------------------------------------------------------- */

static uint32_t brake_of(unsigned number)
{
    return 1000U + number;
}

static void enter_with_brake_of(unsigned number)
{
    queue.modal.brake = brake_of(number);
    rig_enter(0, 10);
}

void test_the_border_before_a_vector_has_the_b_of_the_one_before_it_all_round_the_ring(void)
{
    unsigned number = 0;
    for (; number < GVE_QUEUE_VECTORS; number++) {
        enter_with_brake_of(number);
    }
    gve_queue_begin(&queue, machine.inputs);
    while (gve_queue_room(&queue) < 2) {
        rig_run_ms(1);
    }
    for (; number < GVE_QUEUE_VECTORS + 2; number++) {
        enter_with_brake_of(number);
    }
    for (unsigned each = 2; each < number; each++) {
        const struct path_section *section = &queue.ring[each % GVE_QUEUE_VECTORS];
        TEST_ASSERT_EQUAL_UINT32(PATH_SPEED_UNITS * brake_of(each - 1U), section->vector.border_speed);
    }
    rig_run_to_the_end();
}

static void enter_all_speeds(void)
{
    for (unsigned number = 0; number < GVE_QUEUE_VECTORS; number++) {
        queue.modal.speed = 1000U + number;
        rig_enter(0, 1000);
    }
}

void test_another_factor_is_of_the_speed_of_each_vector(void)
{
    enter_all_speeds();
    gve_queue_change(&queue, 2U * GVE_FACTOR_ONE, false);
    for (unsigned number = 0; number < GVE_QUEUE_VECTORS; number++) {
        TEST_ASSERT_EQUAL_UINT32(2U * PATH_SPEED_UNITS * (1000U + number), queue.ring[number].vector.speed);
    }
}

void test_all_vectors_take_the_last_speed(void)
{
    enter_all_speeds();
    queue.modal.speed = 700;
    gve_queue_change(&queue, GVE_FACTOR_ONE, true);
    for (unsigned number = 0; number < GVE_QUEUE_VECTORS; number++) {
        TEST_ASSERT_EQUAL_UINT32(700U * PATH_SPEED_UNITS, queue.ring[number].vector.speed);
    }
}

void test_queued_vectors_take_the_limit_of_each_axis(void)
{
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        rig_enter(axis, 1000);
    }
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        queue.modal.limit[axis] = 100U * (axis + 1U);
    }
    gve_queue_change(&queue, GVE_FACTOR_ONE, false);
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        TEST_ASSERT_EQUAL_UINT32(100U * (axis + 1U) * PATH_SPEED_UNITS, queue.ring[axis].vector.speed);
    }
}

/* ---- pauses ---------------------------------------------------------------------------------------------------- */

static const uint64_t pause_ticks = UINT64_C(24) * TICKS_PER_MS;

/* An axis moves and ends; T is 24 ms from then on. Tells the tick of its last pulse. */
static uint64_t move_and_set_pause(unsigned axis)
{
    rig_move(axis, 50);
    rig_run_to_the_end();
    queue.modal.pause_ms = 24;
    rig_forget_pulses();
    return rig_last_tick[axis];
}

void test_a_pause_begins_with_the_last_pulse_of_whichever_axis(void)
{
    for (unsigned axis = 0; axis < (unsigned)UNIT_MOTORS; axis++) {
        rig_set_up();
        uint64_t last = move_and_set_pause(axis);
        rig_move(0, 10);
        rig_run_to_the_end();
        TEST_ASSERT_GREATER_OR_EQUAL_UINT64(last + pause_ticks, rig_first_tick[0]);
    }
}

static void home_without_a_switch(void)
{
    const struct gve_home_order order = {.axis = 1, .way = 10, .speed = 1000, .way_back = 1, .speed_back = 500};
    gve_queue_home(&queue, &order, machine.inputs);
    rig_run_to_the_end();
}

void test_the_pause_of_what_has_been_deleted_does_not_hold_up_a_reference_run(void)
{
    uint64_t last = move_and_set_pause(0);
    TEST_ASSERT_TRUE(gve_queue_halt(&queue));
    rig_enter(0, 10);
    gve_queue_delete(&queue);
    home_without_a_switch();
    TEST_ASSERT_LESS_THAN_UINT64(last + pause_ticks, rig_first_tick[1]);
}

void test_the_pause_of_what_is_kept_does_not_hold_up_a_reference_run_beside_it(void)
{
    uint64_t last = move_and_set_pause(0);
    TEST_ASSERT_TRUE(gve_queue_halt(&queue));
    rig_enter(0, 10);
    TEST_ASSERT_TRUE(gve_queue_keep(&queue));
    home_without_a_switch();
    TEST_ASSERT_LESS_THAN_UINT64(last + pause_ticks, rig_first_tick[1]);
}

void test_what_was_kept_before_its_pause_was_over_has_it_after_that(void)
{
    uint64_t last = move_and_set_pause(0);
    TEST_ASSERT_TRUE(gve_queue_halt(&queue));
    rig_enter(0, 10);
    TEST_ASSERT_TRUE(gve_queue_keep(&queue));
    TEST_ASSERT_TRUE(gve_queue_restore(&queue));
    gve_queue_go(&queue, machine.inputs);
    rig_run_to_the_end();
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(last + pause_ticks, rig_first_tick[0]);
}

/* ---- K, R and J ------------------------------------------------------------------------------------------------ */

void test_after_k_there_are_two_places_and_no_room(void)
{
    TEST_ASSERT_TRUE(gve_queue_keep(&queue));
    TEST_ASSERT_FALSE(gve_queue_keep(&queue));
    TEST_ASSERT_EQUAL_UINT32(0, gve_queue_room(&queue));
    TEST_ASSERT_TRUE(gve_queue_restore(&queue));
    TEST_ASSERT_FALSE(gve_queue_restore(&queue));
    TEST_ASSERT_EQUAL_UINT32(GVE_QUEUE_VECTORS, gve_queue_room(&queue));
}

void test_what_waited_beside_is_not_there_after_another_k(void)
{
    TEST_ASSERT_TRUE(gve_queue_keep(&queue));
    TEST_ASSERT_TRUE(gve_queue_halt(&queue));
    rig_enter(0, 10);
    TEST_ASSERT_TRUE(gve_queue_runs(&queue));
    TEST_ASSERT_TRUE(gve_queue_restore(&queue));
    TEST_ASSERT_TRUE(gve_queue_keep(&queue));
    TEST_ASSERT_FALSE(gve_queue_runs(&queue));
}

void test_an_abort_is_quiet_when_no_pulse_is_to_come(void)
{
    for (unsigned axis = 0; axis < (unsigned)UNIT_MOTORS; axis++) {
        rig_set_up();
        rig_move(axis, 5000);
        rig_run_ms(500);
        TEST_ASSERT_FALSE(gve_queue_is_quiet(&queue));
        gve_queue_abort(&queue);
        int64_t before = rig_position[axis];
        TEST_ASSERT_TRUE(gve_queue_is_quiet(&queue));
        rig_main_is_busy = true;
        rig_run_ms(10);
        TEST_ASSERT_EQUAL_INT64(before, rig_position[axis]);
    }
}

void test_after_an_abort_no_input_stops_anything(void)
{
    gve_guards_write(&queue.guards, GVE_STATUS_ENABLED_1, X_ENABLED);
    rig_move(0, 5000);
    rig_run_ms(500);
    gve_queue_abort(&queue);
    TEST_ASSERT_FALSE(gve_queue_sense_isr(&queue, X_CLOSED));
}

/* ---- a coupled axis -------------------------------------------------------------------------------------------- */

void test_a_coupled_axis_shows_the_position_of_its_axis(void)
{
    int64_t steps[UNIT_MOTORS];
    queue.latched_steps[1] = 20;
    queue.latched_steps[3] = 30;
    gve_queue_set_position(&queue, 1, 100);
    gve_queue_set_position(&queue, 3, 7);
    gve_queue_positions(&queue, steps);
    TEST_ASSERT_EQUAL_INT64(7, steps[3]);
    gve_queue_couple(&queue, 1);
    gve_queue_positions(&queue, steps);
    TEST_ASSERT_EQUAL_INT64(100, steps[3]);
    gve_queue_latched(&queue, steps);
    TEST_ASSERT_EQUAL_INT64(20, steps[3]);
}
