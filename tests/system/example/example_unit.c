#include "example_unit.h"

#include "hal_io.h"
#include "hal_time.h"

static unsigned lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    struct example_unit *unit = context;
    return axis_lay_isr(&unit->axis[motor], room);
}

static void tick_isr(void *context, uint64_t since_tick)
{
    struct example_unit *unit = context;
    uint8_t inputs = hal_io_read_inputs();
    for (unsigned motor = 0; motor < EXAMPLE_MOTORS; motor++) {
        if (axis_sense_isr(&unit->axis[motor], inputs, since_tick)) {
            hal_run_plan();
        }
    }
}

static void plan_isr(void *context)
{
    struct example_unit *unit = context;
    for (unsigned motor = 0; motor < EXAMPLE_MOTORS; motor++) {
        axis_plan_isr(&unit->axis[motor]);
    }
}

void example_unit_start(struct example_unit *unit)
{
    unit->client = (struct hal_client){unit, .lay_isr = lay_isr, .tick_isr = tick_isr, .plan_isr = plan_isr};
    for (unsigned motor = 0; motor < EXAMPLE_MOTORS; motor++) {
        axis_init(&unit->axis[motor], motor);
        (void)axis_sense_isr(&unit->axis[motor], hal_io_read_inputs(), hal_time_now());
    }
    hal_run_start(&unit->client);
}

static void run(struct axis *axis, bool backward)
{
    const struct motion_order order = {{{1000, 2000, 8000}}, .start_speed_steps_per_s = 100, .sections = 1};
    const struct axis_guards guards = {.stop_high = (uint8_t)(1U << axis->motor)};
    if (!axis_is_busy(axis)) {
        axis_begin(axis, &order, backward, hal_time_now(), &guards);
    }
}

void example_unit_take(struct example_unit *unit, char letter)
{
    bool second = letter >= 'A' && letter <= 'Z';
    struct axis *axis = &unit->axis[second];
    char order = (char)(second ? letter - 'A' + 'a' : letter);
    if (order == 's') {
        (void)axis_stop(axis, AXIS_CAUSE_COMMAND);
    } else if (order == 'f' || order == 'b') {
        run(axis, order == 'b');
    }
}

void example_unit_poll(struct example_unit *unit)
{
    for (unsigned motor = 0; motor < EXAMPLE_MOTORS; motor++) {
        axis_poll(&unit->axis[motor]);
        (void)axis_take_end(&unit->axis[motor]);
        while (axis_feed(&unit->axis[motor])) {
        }
    }
}
