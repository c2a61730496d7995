/* What no command of a unit does to the queue, though its header allows it. The rest is in tests/system/gve134. */
#include "gve_queue.h"
#include "unity.h"

#include "base_tick.h"
#include "epoch.h"
#include "hal_run.h"
#include "host_machine.h"

enum {
    NO_INPUT = 0,
    X_CLOSED = 1, /* the reference switch of X, active at level 0 */
};

static struct host_machine machine;
static struct gve_queue queue;
static int64_t x; /* at the pins */

static unsigned lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    (void)context;
    return gve_queue_lay_isr(&queue, motor, room);
}

static void tick_isr(void *context, uint64_t since_tick)
{
    (void)context;
    (void)since_tick;
    if (gve_queue_sense_isr(&queue, machine.inputs)) {
        hal_run_plan();
    }
}

static void plan_isr(void *context)
{
    (void)context;
    gve_queue_plan_isr(&queue);
}

static void step_seen(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    (void)tick;
    x += motor != 0 ? 0 : backward ? -1 : 1;
}

static uint64_t poll(void *context)
{
    (void)context;
    return gve_queue_poll(&queue, machine.inputs);
}

void setUp(void)
{
    static const struct hal_client client = {.lay_isr = lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    host_machine_init(&machine, epoch_random());
    machine.ahead_ticks = 512 * TICKS_PER_US;
    machine.listener = (struct host_listener){.step = step_seen};
    host_machine_select(&machine);
    x = 0;
    gve_queue_init(&queue);
    hal_run_start(&client);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
    TEST_ASSERT_EQUAL_INT64(x, step_channel_position(&queue.channel[0]));
}

static void run_ms(uint64_t ms)
{
    host_machine_run(&machine, machine.now + ms * TICKS_PER_MS, poll, NULL, NULL);
}

static void begin_home(int32_t way)
{
    const struct gve_home_order order = {.axis = 0, .way = way, .speed = 1000, .way_back = 1000, .speed_back = 500};
    gve_queue_home(&queue, &order, machine.inputs);
}

void test_a_stop_at_rest_does_nothing(void)
{
    gve_queue_stop(&queue);
    TEST_ASSERT_FALSE(gve_queue_is_stopping(&queue));
    gve_queue_enter(&queue, (const int32_t[]){50, 0, 0, 0});
    gve_queue_begin(&queue, NO_INPUT);
    run_ms(1000);
    TEST_ASSERT_EQUAL_INT64(50, x);
    TEST_ASSERT_FALSE(gve_queue_inta(&queue));
}

void test_what_is_entered_does_not_move_before_it_is_begun(void)
{
    gve_queue_enter(&queue, (const int32_t[]){50, 0, 0, 0});
    gve_queue_enter(&queue, (const int32_t[]){-20, 0, 0, 0});
    run_ms(1000);
    TEST_ASSERT_EQUAL_INT64(0, x);
    TEST_ASSERT_EQUAL_UINT32(GVE_QUEUE_VECTORS - 2, gve_queue_room(&queue));
    gve_queue_begin(&queue, NO_INPUT);
    run_ms(1000);
    TEST_ASSERT_EQUAL_INT64(30, x);
}

void test_another_factor_does_not_change_a_reference_run(void)
{
    begin_home(-2000);
    run_ms(500);
    int64_t before = x;
    gve_queue_change(&queue, 10U * GVE_FACTOR_ONE, true);
    run_ms(500);
    TEST_ASSERT_INT64_WITHIN(2, before - 500, x);
    run_ms(2000);
    TEST_ASSERT_EQUAL_INT64(-2000, x);
    TEST_ASSERT_EQUAL(GVE_HOME_NOT_FOUND, gve_queue_home_result(&queue));
}

void test_a_stop_ends_a_reference_run_also_while_it_brakes_for_its_switch(void)
{
    queue.modal.accel = 2;
    begin_home(-20000);
    run_ms(1500);
    host_machine_set_input(&machine, 1, true);
    run_ms(50);
    TEST_ASSERT_EQUAL(GVE_HOME_RUNS, gve_queue_home_result(&queue));
    TEST_ASSERT_TRUE(gve_queue_is_stopping(&queue));
    gve_queue_stop(&queue);
    run_ms(1000);
    TEST_ASSERT_EQUAL(GVE_HOME_STOPPED, gve_queue_home_result(&queue));
    TEST_ASSERT_TRUE(gve_queue_inta(&queue));
    TEST_ASSERT_FALSE(queue.intcom);
    TEST_ASSERT_FALSE(gve_queue_runs(&queue));
}

void test_after_k_there_are_two_places_and_no_room(void)
{
    TEST_ASSERT_TRUE(gve_queue_keep(&queue));
    TEST_ASSERT_FALSE(gve_queue_keep(&queue));
    TEST_ASSERT_EQUAL_UINT32(0, gve_queue_room(&queue));
    TEST_ASSERT_TRUE(gve_queue_restore(&queue));
    TEST_ASSERT_FALSE(gve_queue_restore(&queue));
    TEST_ASSERT_EQUAL_UINT32(GVE_QUEUE_VECTORS, gve_queue_room(&queue));
}

void test_an_abort_is_quiet_when_no_pulse_is_to_come(void)
{
    gve_queue_enter(&queue, (const int32_t[]){5000, 0, 0, 0});
    gve_queue_begin(&queue, NO_INPUT);
    run_ms(500);
    TEST_ASSERT_FALSE(gve_queue_is_quiet(&queue));
    gve_queue_abort(&queue);
    int64_t before = x;
    TEST_ASSERT_TRUE(gve_queue_is_quiet(&queue));
    TEST_ASSERT_FALSE(gve_queue_sense_isr(&queue, X_CLOSED));
    TEST_ASSERT_EQUAL_INT64(before, x);
}
