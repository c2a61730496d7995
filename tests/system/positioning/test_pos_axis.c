/* An axis: what it tells onlookers, what it shows, when it wants to be called again. */
#include "pos_rig.h"

#include "hal_time.h"

#define FEED(mm_per_min) ((uint32_t)(mm_per_min) << 16U)

enum {
    ACCEL = 500,
    STORE = 40,
    EVENTS = 20,
    AXIS_2 = 2,
};

struct event {
    uint64_t tick;
    unsigned motor;
    enum hal_trace_event event;
    int64_t value;
};

static struct event events[EVENTS];
static unsigned event_count;
static unsigned event_seen;
static uint64_t wake;

static void note(void *context, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    (void)context;
    TEST_ASSERT_LESS_THAN_UINT(EVENTS, event_count);
    events[event_count++] = (struct event){.tick = tick, .motor = motor, .event = event, .value = value};
}

void setUp(void)
{
    rig_set_up();
    machine.listener.trace = note;
    event_count = 0;
    event_seen = 0;
    rig_run_ms(10);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, AXIS_2, 0));
}

void tearDown(void)
{
}

static struct pos_axis *axis(void)
{
    return &unit.axes[AXIS_2 - 1];
}

static void set(uint32_t offset, int32_t value)
{
    const uint16_t word = (uint16_t)value;
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, AXIS_2));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, positioning_write(&unit, 100U * AXIS_2 + offset, 1, &word));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, AXIS_2, 0));
}

static void control(uint32_t feed, int mp)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_control(&unit, NULL, feed, mp, AXIS_2));
}

static void mode(int32_t len_um)
{
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, len_um, ACCEL, AXIS_2));
}

static void move(int32_t len_um)
{
    mode(len_um);
    control(FEED(1000), 1);
}

static int64_t place(void)
{
    return rig_position[AXIS_2 - 1];
}

/* ---- onlookers ------------------------------------------------------------------------------------------------- */

static uint64_t assert_event(enum hal_trace_event event, int64_t value)
{
    TEST_ASSERT_LESS_THAN_UINT(event_count, event_seen);
    const struct event *next = &events[event_seen++];
    TEST_ASSERT_EQUAL_INT(event, next->event);
    TEST_ASSERT_EQUAL_UINT(AXIS_2, next->motor);
    TEST_ASSERT_EQUAL_INT64(value, next->value);
    return next->tick;
}

static void assert_no_event(void)
{
    TEST_ASSERT_EQUAL_UINT(event_seen, event_count);
}

void test_a_move_is_told_with_its_steps_when_it_begins_and_ends(void)
{
    static const int32_t ways_um[] = {1000, -3000};
    for (unsigned i = 0; i < 2; i++) {
        move(ways_um[i]);
        rig_run_ms(2000);
        TEST_ASSERT_EQUAL_UINT64(axis()->start_tick - machine.epoch, assert_event(HAL_TRACE_MOVE, ways_um[i] / 10));
        uint64_t last = rig_tick[AXIS_2 - 1][rig_pulses[AXIS_2 - 1] - 1U];
        TEST_ASSERT_EQUAL_UINT64(last, assert_event(HAL_TRACE_DONE, ways_um[i] / 10));
        assert_no_event();
    }
}

void test_a_change_of_the_feed_is_told_and_a_hold_once(void)
{
    move(100000);
    rig_run_ms(100);
    (void)assert_event(HAL_TRACE_MOVE, 10000);
    control(FEED(600), 1);
    uint64_t asked = machine.now;
    rig_run_ms(100);
    TEST_ASSERT_UINT64_WITHIN(TICKS_PER_MS, asked, assert_event(HAL_TRACE_SPEED, 1000));
    control(FEED(600), 0);
    asked = machine.now;
    rig_run_ms(5);
    TEST_ASSERT_UINT64_WITHIN(TICKS_PER_MS, asked, assert_event(HAL_TRACE_STOP, AXIS_CAUSE_PAUSE));
    assert_no_event();
    control(FEED(600), 1);
    rig_run_ms(1);
    (void)assert_event(HAL_TRACE_SPEED, 1000);
    control(FEED(600), 0);
    rig_run_ms(100);
    (void)assert_event(HAL_TRACE_STOP, AXIS_CAUSE_PAUSE);
    (void)assert_event(HAL_TRACE_DONE, place());
    assert_no_event();
}

void test_a_fault_is_told_with_its_number(void)
{
    move(100000);
    rig_run_ms(100);
    (void)assert_event(HAL_TRACE_MOVE, 10000);
    pos_axis_fault(axis(), POS_ERROR_SILENT);
    (void)assert_event(HAL_TRACE_ERROR, POS_ERROR_SILENT);
    (void)assert_event(HAL_TRACE_STOP, AXIS_CAUSE_FAULT);
    rig_run_ms(100);
    (void)assert_event(HAL_TRACE_DONE, place());
    assert_no_event();
}

/* ---- brakes ---------------------------------------------------------------------------------------------------- */

/* 27.8 steps with the acceleration of the measure, 2.8 with ten times as much. */
void test_a_fault_that_main_finds_brakes_with_error_accel_and_pos_init_does_not(void)
{
    set(40, 10 * ACCEL);
    move(100000);
    rig_run_ms(200);
    int64_t before = place();
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, AXIS_2, 0));
    rig_run_ms(100);
    TEST_ASSERT_INT64_WITHIN(2, before + 28, place());
    move(100000);
    rig_run_ms(200);
    before = place();
    pos_axis_fault(axis(), POS_ERROR_SILENT);
    rig_run_ms(100);
    TEST_ASSERT_INT64_WITHIN(2, before + 3, place());
}

/* From 1666.7 steps/s it takes 33 ms to brake. */
void test_a_hold_that_is_taken_back_does_not_come_to_a_stand(void)
{
    move(100000);
    rig_run_ms(200);
    control(FEED(1000), 0);
    rig_run_ms(10);
    control(FEED(1000), 1);
    rig_run_ms(8);
    TEST_ASSERT_TRUE(rig_values(AXIS_2).speed > FEED(700));
    rig_run_ms(20);
    TEST_ASSERT_UINT32_WITHIN(FEED(1), FEED(1000), rig_values(AXIS_2).speed);
}

void test_what_is_left_of_a_measure_that_is_given_up_is_no_base_of_the_next(void)
{
    for (unsigned stands = 0; stands < 2; stands++) {
        move(4);
        rig_run_ms(5);
        TEST_ASSERT_EQUAL_INT64(4, axis()->frame.base_um);
        move(100000);
        rig_run_ms(100);
        control(FEED(1000), 0);
        rig_run_ms(stands != 0 ? 100 : 1);
        TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, AXIS_2, 0));
        rig_run_ms(stands != 0 ? 0 : 100);
        TEST_ASSERT_EQUAL_INT64(0, axis()->frame.base_um);
        TEST_ASSERT_EQUAL_INT64(place(), axis()->frame.base_step);
    }
}

/* ---- what it shows --------------------------------------------------------------------------------------------- */

void test_flags_show_which_inputs_are_active(void)
{
    for (unsigned input = 0; input < 4; input++) {
        set(46U + input, (int32_t)input + 5);
    }
    for (unsigned input = 0; input < 4; input++) {
        host_machine_set_input(&machine, (uint8_t)(input + 5U), true);
        rig_run_ms(2);
        TEST_ASSERT_EQUAL_HEX(POS_FLAG_LIMIT_MINUS << input, rig_values(AXIS_2).flags);
        host_machine_set_input(&machine, (uint8_t)(input + 5U), false);
    }
}

void test_jede_is_1_from_the_tick_of_the_start_on(void)
{
    move(1000);
    rig_run_ticks(1);
    uint64_t start = axis()->start_tick - machine.epoch;
    TEST_ASSERT_TRUE(start > machine.now + 1U);
    rig_run_ticks(start - 1U - machine.now);
    TEST_ASSERT_EQUAL_HEX(0x0003, rig_status(AXIS_2));
    rig_run_ticks(1);
    TEST_ASSERT_EQUAL_HEX(0x0103, rig_status(AXIS_2));
}

void test_a_start_is_at_least_half_a_millisecond_ahead_and_within_one(void)
{
    mode(1000);
    rig_run_ms(2);
    control(FEED(1000), 1);
    (void)positioning_poll(&unit);
    TEST_ASSERT_UINT64_WITHIN(TICKS_PER_MS / 4U, hal_time_now() + 3 * TICKS_PER_MS / 4U, axis()->start_tick);
}

void test_a_measure_that_is_reached_leaves_mp_as_it_is(void)
{
    control(0, 0);
    mode(0);
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_HEX(0x0803, rig_status(AXIS_2));
    TEST_ASSERT_EQUAL_HEX(0, rig_control(AXIS_2));
}

void test_an_edge_after_a_limit_has_been_told_is_no_limit(void)
{
    set(47, 1);
    set(49, 5);
    move(10000);
    rig_run_ms(100);
    host_machine_set_input(&machine, 1, true);
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_LIMIT, rig_values(AXIS_2).error);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, AXIS_2, 0));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_capture(&unit, AXIS_2));
    host_machine_set_input(&machine, 5, true);
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_UINT16(1, rig_values(AXIS_2).captures);
    TEST_ASSERT_EQUAL_HEX(0x0001, rig_status(AXIS_2));
}

/* ---- settings -------------------------------------------------------------------------------------------------- */

static void restart_with_stored_settings(void)
{
    static const uint16_t one = 1;
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, AXIS_2));
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, positioning_write(&unit, STORE, 1, &one));
    host_machine_restart(&machine);
    rig_begin();
    rig_run_ms(10);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, AXIS_2, 0));
}

void test_stored_settings_of_an_axis_count_from_the_start_on(void)
{
    set(34, 1);
    set(41, 50);
    set(48, 3);
    set(49, 5);
    TEST_ASSERT_FALSE(machine.falling[AXIS_2 - 1]);
    restart_with_stored_settings();
    TEST_ASSERT_TRUE(machine.turned[AXIS_2 - 1]);
    TEST_ASSERT_FALSE(machine.falling[AXIS_2 - 1]);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_capture(&unit, AXIS_2));
    host_machine_set_input(&machine, 5, true);
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_UINT16(1, rig_values(AXIS_2).captures);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_home(&unit, NULL, 37, 1000, 0, AXIS_2));
    rig_run_ms(2);
    set(41, 50);
    TEST_ASSERT_EQUAL_INT32(1000, rig_values(AXIS_2).position_um);
    set(41, 51);
    TEST_ASSERT_EQUAL_INT32(0, rig_values(AXIS_2).position_um);
}

/* Also where the feed is the same as before the change, and the least there is. */
void test_the_speed_of_a_feed_is_that_of_the_settings_in_force(void)
{
    move(100000);
    rig_run_ms(200);
    TEST_ASSERT_UINT32_WITHIN(FEED(1), FEED(1000), rig_values(AXIS_2).speed);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, AXIS_2));
    rig_run_ms(100);
    const uint16_t highest[] = {500, 0};
    TEST_ASSERT_EQUAL_INT(MODBUS_EXCEPTION_NONE, positioning_write(&unit, 236, 2, highest));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, AXIS_2, 0));
    move(100000);
    rig_run_ms(200);
    TEST_ASSERT_UINT32_WITHIN(FEED(1), FEED(500), rig_values(AXIS_2).speed);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_reset(&unit, AXIS_2));
    rig_run_ms(100);
    set(35, 100);
    mode(100000);
    control(1, 1);
    rig_run_ms(2);
    TEST_ASSERT_EQUAL_HEX(0x0103, rig_status(AXIS_2));
    TEST_ASSERT_EQUAL_UINT32(1, axis()->speed);
}

/* ---- passes ---------------------------------------------------------------------------------------------------- */

/* Main without its second half, until the axis stands; the drive has seen the end before, as it does in the half that
 * is missing. */
static uint64_t poll_only(void *context)
{
    (void)context;
    bool busy = pos_axis_is_busy(axis());
    (void)pos_drive_poll(&axis()->drive);
    uint64_t next = pos_axis_poll(axis(), 0);
    wake = busy && !pos_axis_is_busy(axis()) ? next - hal_time_now() : wake;
    return next;
}

void test_an_axis_that_has_come_to_a_stand_shows_it_and_wants_the_next_pass_at_once(void)
{
    move(100000);
    rig_run_ms(200);
    control(FEED(1000), 0);
    rig_run_ms(2);
    wake = TICK_NEVER;
    host_machine_run(&machine, machine.now + 100U * TICKS_PER_MS, poll_only, NULL, NULL);
    TEST_ASSERT_EQUAL_UINT64(0, wake);
    TEST_ASSERT_EQUAL_HEX(0x0003, rig_status(AXIS_2));
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_mode(&unit, NULL, 1, ACCEL, AXIS_2));
}

void test_the_next_pass_comes_at_once_where_the_plan_is_another_or_the_initiator_waits(void)
{
    TEST_ASSERT_FALSE(pos_axis_follow(axis()));
    mode(100000);
    TEST_ASSERT_TRUE(pos_axis_follow(axis()));
    rig_run_ms(2);
    TEST_ASSERT_FALSE(pos_axis_follow(axis()));
    control(FEED(1000), 1);
    rig_run_ms(200);
    TEST_ASSERT_FALSE(pos_axis_follow(axis()));
    control(FEED(900), 1);
    TEST_ASSERT_TRUE(pos_axis_follow(axis()));
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_INT(POS_OK, pos_init(&unit, AXIS_2, 0));
    rig_run_ms(2);
    mode(1000);
    TEST_ASSERT_FALSE(pos_axis_follow(axis()));
}

/* ---- the watch on the inputs ----------------------------------------------------------------------------------- */

void test_the_plan_interrupt_is_wanted_for_a_stop_alone(void)
{
    set(47, 1);
    TEST_ASSERT_FALSE(pos_axis_sense_isr(axis(), 0));
    move(100000);
    rig_run_ms(100);
    TEST_ASSERT_FALSE(pos_axis_sense_isr(axis(), 0xFE));
    TEST_ASSERT_TRUE(pos_axis_sense_isr(axis(), 1));
    TEST_ASSERT_FALSE(pos_axis_sense_isr(axis(), 1));
    hal_run_plan();
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_UINT16(POS_ERROR_LIMIT, rig_values(AXIS_2).error);
}
