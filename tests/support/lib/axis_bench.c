#include "axis_bench.h"

#include "base_tick.h"
#include "epoch.h"
#include "hal_io.h"
#include "hal_time.h"
#include "unity.h"

const struct motion_order axis_bench_trapezoid = {
    .section = {{5000, 1000, 2000}},
    .start_speed_steps_per_s = 100,
    .sections = 1,
};

const struct motion_order axis_bench_slow = {
    .section = {{100, 100, 2000}},
    .start_speed_steps_per_s = 100,
    .sections = 1,
};

static void traced(void *context, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    struct axis_bench *bench = context;
    const struct axis_bench_event seen = {event, value, tick};
    TEST_ASSERT_EQUAL_UINT(AXIS_BENCH_MOTOR + 1, motor);
    if (event == HAL_TRACE_MOVE || event == HAL_TRACE_DONE) {
        bench->motions[bench->motion_count++ % AXIS_BENCH_EVENTS_MAX] = seen;
        return;
    }
    TEST_ASSERT_LESS_THAN_UINT(AXIS_BENCH_EVENTS_MAX, bench->event_count);
    bench->events[bench->event_count++] = seen;
}

static void stepped(void *context, uint64_t tick, unsigned motor, bool backward)
{
    struct axis_bench *bench = context;
    (void)motor;
    (void)backward;
    bench->last_edge_tick = tick;
    bench->edges++;
}

static unsigned lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    struct axis_bench *bench = context;
    TEST_ASSERT_EQUAL_UINT(AXIS_BENCH_MOTOR, motor);
    return axis_lay_isr(&bench->axis, room);
}

static void tick_isr(void *context, uint64_t since_tick)
{
    struct axis_bench *bench = context;
    if (axis_sense_isr(&bench->axis, hal_io_read_inputs(), since_tick)) {
        bench->stops_sensed++;
        hal_run_plan();
    }
}

static void plan_isr(void *context)
{
    struct axis_bench *bench = context;
    axis_plan_isr(&bench->axis);
}

static uint64_t main_pass(void *context)
{
    struct axis_bench *bench = context;
    axis_poll(&bench->axis);
    (void)axis_take_end(&bench->axis);
    while (axis_feed(&bench->axis)) {
    }
    return TICK_NEVER;
}

void axis_bench_init(struct axis_bench *bench)
{
    const struct hal_client client = {.context = bench, .lay_isr = lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    host_machine_init(&bench->machine, epoch_random());
    bench->machine.listener = (struct host_listener){.context = bench, .trace = traced, .step = stepped};
    host_machine_select(&bench->machine);
    hal_run_start(&client);
    axis_init(&bench->axis, AXIS_BENCH_MOTOR);
    bench->event_count = 0;
    bench->motion_count = 0;
    bench->stops_sensed = 0;
    bench->last_edge_tick = 0;
    bench->edges = 0;
}

void axis_bench_start(struct axis_bench *bench, const struct motion_order *order, struct axis_guards guards,
                      uint8_t inputs)
{
    (void)axis_sense_isr(&bench->axis, inputs, bench->machine.epoch);
    (void)axis_take_end(&bench->axis);
    axis_begin(&bench->axis, order, false, bench->machine.epoch, &guards);
}

void axis_bench_set_inputs(struct axis_bench *bench, uint8_t levels, uint8_t changed, uint64_t ms)
{
    uint8_t number = 1;
    while ((1U << (number - 1U)) != changed) {
        number++;
    }
    bench->machine.inputs = levels;
    bench->input = (struct host_input){
        .tick = ms * TICKS_PER_MS,
        .input = number,
        .level = (levels & changed) == 0,
    };
    host_machine_set_script(&bench->machine, &bench->input, 1);
}

void axis_bench_run_until(struct axis_bench *bench, uint64_t tick)
{
    host_machine_run(&bench->machine, tick, main_pass, NULL, bench);
}

void axis_bench_run(struct axis_bench *bench)
{
    host_machine_run(&bench->machine, TICK_NEVER, main_pass, NULL, bench);
    TEST_ASSERT_FALSE(axis_is_moving(&bench->axis));
}

void axis_bench_assert_steps(const struct axis_bench *bench, int64_t steps)
{
    TEST_ASSERT_EQUAL_UINT64(steps < 0 ? -steps : steps, bench->machine.pulses);
    TEST_ASSERT_EQUAL_INT64(steps, axis_position_steps(&bench->axis));
}

void axis_bench_assert_only_event(const struct axis_bench *bench, enum hal_trace_event event, int64_t value)
{
    TEST_ASSERT_EQUAL_UINT(1, bench->event_count);
    TEST_ASSERT_EQUAL_INT(event, bench->events[0].event);
    TEST_ASSERT_EQUAL_INT64(value, bench->events[0].value);
}

void axis_bench_assert_motion(const struct axis_bench *bench, enum hal_trace_event event, int64_t steps, uint64_t tick)
{
    TEST_ASSERT_GREATER_THAN_UINT(0, bench->motion_count);
    const struct axis_bench_event *seen = &bench->motions[(bench->motion_count - 1U) % AXIS_BENCH_EVENTS_MAX];
    TEST_ASSERT_EQUAL_INT(event, seen->event);
    TEST_ASSERT_EQUAL_INT64(steps, seen->value);
    TEST_ASSERT_EQUAL_UINT64(tick, seen->tick);
}

void axis_bench_assert_cause(const struct axis_bench *bench, enum axis_cause cause)
{
    TEST_ASSERT_EQUAL_INT(cause, axis_cause(&bench->axis));
    if (cause == AXIS_CAUSE_NONE) {
        TEST_ASSERT_EQUAL_UINT(0, bench->event_count);
    } else {
        axis_bench_assert_only_event(bench, HAL_TRACE_STOP, cause);
    }
}

void axis_bench_check(const struct axis_bench *bench)
{
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, bench->machine.late_steps, "late pulses");
    TEST_ASSERT_LESS_OR_EQUAL_UINT64_MESSAGE(bench->machine.pulses, axis_steps_made(&bench->axis), "steps made");
}
