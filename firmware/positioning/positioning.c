#include "positioning_private.h"

#include "base_tick.h"
#include "hal_board.h"
#include "hal_io.h"
#include "hal_line.h"
#include "hal_step.h"
#include "hal_time.h"

enum {
    START_TICKS = 580 * TICKS_PER_US, /* the first pos_axis_start wants 500 us; all within 1 ms */
    BLINK_TICKS = TICK_HZ / 2U,
    IDLE_TICKS = TICKS_PER_MS, /* a pass comes so often at least */
};

/* ---- interrupts ------------------------------------------------------------------------------------------------ */

static unsigned positioning_lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    struct pos_unit *unit = context;
    return pos_drive_lay_isr(&unit->axes[motor].drive, room);
}

static void positioning_tick_isr(void *context, uint64_t since_tick)
{
    struct pos_unit *unit = context;
    bool stops = false;
    (void)since_tick;
    (void)io_sample(&unit->io);
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        stops = pos_axis_sense_isr(&unit->axes[axis], io_inputs(&unit->io)) || stops;
    }
    if (stops) {
        hal_run_plan();
    }
}

static void positioning_plan_isr(void *context)
{
    struct pos_unit *unit = context;
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        pos_drive_plan_isr(&unit->axes[axis].drive);
    }
}

/* ---- start ----------------------------------------------------------------------------------------------------- */

void positioning_init(struct pos_unit *unit)
{
    io_init(&unit->io);
    pos_registers_init(&unit->registers);
    pos_settings_init(&unit->settings, &unit->registers);
    unit->start_tick = hal_time_now();
    unit->silences = 0;
    unit->leds_tick = 0;
    unit->client = (struct hal_client){
        .context = unit,
        .lay_isr = positioning_lay_isr,
        .tick_isr = positioning_tick_isr,
        .plan_isr = positioning_plan_isr,
    };
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        pos_axis_init(&unit->axes[axis], axis, unit->registers.axes[axis]);
    }
    unit->asked = NULL;
    positioning_init_line(unit);
}

void positioning_start(struct pos_unit *unit)
{
    hal_run_start(&unit->client);
    hal_step_hold();
    (void)io_sample(&unit->io);
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        (void)pos_axis_sense_isr(&unit->axes[axis], io_inputs(&unit->io));
    }
    hal_step_release();
}

/* ---- a pass ---------------------------------------------------------------------------------------------------- */

static uint64_t earlier(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static bool is_taken(const struct pos_axis *axis)
{
    return axis->state != (uint8_t)POS_FREE && axis->state != (uint8_t)POS_FAULT;
}

/* The watchdog of the bus. */
static void watch_bus(struct pos_unit *unit, uint64_t now)
{
    uint64_t patience = (uint64_t)unit->registers.unit[POS_UNIT_WATCHDOG] * TICKS_PER_MS;
    bool acts = false;
    if (patience == 0U || now < unit->server.heard_tick + patience) {
        return;
    }
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        acts = acts || is_taken(&unit->axes[axis]);
        pos_axis_fault(&unit->axes[axis], POS_ERROR_SILENT);
    }
    unit->silences += acts ? 1U : 0U;
}

static void feed(struct pos_unit *unit)
{
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        if (pos_drive_is_stirred(&unit->axes[axis].drive)) {
            (void)pos_drive_poll(&unit->axes[axis].drive);
        }
    }
}

/* When those begin that are to: also where one is to stand in a moment, not before. */
static uint64_t start_tick_of(const struct pos_unit *unit)
{
    uint64_t start_tick = hal_time_now() + (uint64_t)START_TICKS;
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        const struct pos_axis *own = &unit->axes[axis];
        uint64_t rest_tick = pos_axis_wants_start(own) ? pos_drive_rest_tick(&own->drive) : 0U;
        if (start_tick <= rest_tick) {
            start_tick = rest_tick + 1U;
        }
    }
    return start_tick;
}

/* What the pass has brought takes effect; axes that are to begin do so together. True: the next pass is to come at
 * once. */
static bool follow(struct pos_unit *unit)
{
    bool again = false;
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        again = pos_axis_follow(&unit->axes[axis]) || again;
    }
    uint64_t start_tick = start_tick_of(unit);
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        if (pos_axis_wants_start(&unit->axes[axis])) {
            pos_axis_start(&unit->axes[axis], start_tick, io_inputs(&unit->io));
            again = true;
        }
    }
    feed(unit);
    return again;
}

static void show_leds(struct pos_unit *unit, uint64_t now)
{
    if (now < unit->leds_tick) {
        return;
    }
    unit->leds_tick = now + (uint64_t)IDLE_TICKS;
    bool phase = (now / (uint64_t)BLINK_TICKS) % 2U == 0U;
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        const struct pos_axis *own = &unit->axes[axis];
        bool error = own->error != (uint16_t)POS_OK;
        hal_io_set_led(axis, error ? phase : pos_axis_moves(own));
    }
}

uint64_t positioning_poll(struct pos_unit *unit)
{
    uint64_t now = hal_time_now();
    uint64_t wake = now + (uint64_t)IDLE_TICKS;
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        wake = earlier(wake, pos_axis_poll(&unit->axes[axis], io_inputs(&unit->io)));
    }
    wake = earlier(wake, positioning_serve(unit));
    plc_pass(unit);
    watch_bus(unit, hal_time_now());
    bool again = follow(unit);
    positioning_answer(unit);
    show_leds(unit, now);
    return again ? hal_time_now() : wake;
}

static bool rests(const struct pos_axis *axis)
{
    return !pos_axis_is_busy(axis) && !axis->waits && !pos_axis_wants_start(axis);
}

bool positioning_is_idle(const struct pos_unit *unit)
{
    for (unsigned axis = 0; axis < (unsigned)POS_AXES; axis++) {
        if (!rests(&unit->axes[axis])) {
            return false;
        }
    }
    return !modbus_is_sending(&unit->server) && hal_line_is_idle();
}
