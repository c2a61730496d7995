#include "rkm04.h"

#include <assert.h>

#include "base_tick.h"
#include "hal_board.h"
#include "hal_io.h"
#include "hal_run.h"
#include "hal_step.h"
#include "hal_time.h"
#include "interpreter_status.h"

/* A blinking LED is on for half a second and off for half a second. */
#define BLINK_TICKS ((uint64_t)TICK_HZ / 2U)

static_assert((uint32_t)UNIT_MOTORS <= (uint32_t)STORE_SLOTS, "each motor has a slot for its program");
static_assert((uint32_t)MESSAGES_LINE_COUNTS == (uint32_t)LINK_COUNTS_TOTAL, "Get Status tells all of them");

static unsigned rkm04_lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    struct rkm04 *unit = context;
    return axis_lay_isr(&unit->axis[motor], room);
}

/* Stops motors as the inputs say; what takes long is left to the plan interrupt. */
static void rkm04_sense(struct rkm04 *unit, uint64_t since_tick)
{
    bool stops = false;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        stops = axis_sense_isr(&unit->axis[motor], io_inputs(&unit->io), since_tick) || stops;
    }
    if (stops) {
        hal_run_plan();
    }
}

static void rkm04_tick_isr(void *context, uint64_t since_tick)
{
    struct rkm04 *unit = context;
    (void)io_sample(&unit->io);
    rkm04_sense(unit, since_tick);
}

static void rkm04_plan_isr(void *context)
{
    struct rkm04 *unit = context;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        axis_plan_isr(&unit->axis[motor]);
    }
}

void rkm04_init(struct rkm04 *unit)
{
    io_init(&unit->io);
    interpreter_shared_init(&unit->shared, &unit->io);
    store_init(&unit->store);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        axis_init(&unit->axis[motor], motor);
        interpreter_init(&unit->interpreter[motor], motor, &unit->axis[motor], &unit->shared);
        unit->led[motor] = (struct rkm04_led){.on = false};
        hal_io_set_led(motor, false);
    }
    unit->messages = (struct messages){
        .interpreters = unit->interpreter,
        .shared = &unit->shared,
        .store = &unit->store,
        .version = RKM04_VERSION,
        .line_counts = rkm04_line_counts(&unit->line),
    };
    unit->client = (struct hal_client){
        .context = unit,
        .lay_isr = rkm04_lay_isr,
        .tick_isr = rkm04_tick_isr,
        .plan_isr = rkm04_plan_isr,
    };
}

static void rkm04_start_program(struct rkm04 *unit, unsigned motor, uint64_t now_ticks)
{
    struct interpreter *interpreter = &unit->interpreter[motor];
    uint8_t *program = rkm04_line_spare(&unit->line);
    uint32_t length = store_load(&unit->store, motor, program);

    if (store_is_damaged(&unit->store, motor) || !interpreter_load(interpreter, program, length, now_ticks)) {
        interpreter_fail(interpreter, INTERPRETER_ERROR_STORED_PROGRAM, now_ticks);
    }
}

/* The tick interrupt shows the inputs when they change, or in a millisecond. */
static void rkm04_look(struct rkm04 *unit, uint64_t now_ticks)
{
    hal_step_hold();
    (void)io_sample(&unit->io);
    hal_step_release();
    rkm04_sense(unit, now_ticks);
}

void rkm04_start(struct rkm04 *unit)
{
    hal_run_start(&unit->client);
    uint64_t now = hal_time_now();
    rkm04_look(unit, now);
    for (unsigned motor = 0; hal_board_may_start_programs() && motor < UNIT_MOTORS; motor++) {
        rkm04_start_program(unit, motor, now);
    }
    rkm04_line_start(&unit->line, &unit->messages, now);
}

static void led_set(struct rkm04_led *led, unsigned motor, bool on)
{
    if (led->on != on) {
        led->on = on;
        hal_io_set_led(motor, on);
    }
}

/* On while the motor moves, blinking while its program has failed. Returns the tick of the next change by itself. */
static uint64_t rkm04_poll_led(struct rkm04 *unit, unsigned motor, uint64_t now_ticks)
{
    struct rkm04_led *led = &unit->led[motor];
    bool moving = axis_is_moving(&unit->axis[motor]);

    if (moving || !interpreter_has_failed(&unit->interpreter[motor])) {
        led->blinking = false;
        led_set(led, motor, moving);
        return TICK_NEVER;
    }
    if (!led->blinking) {
        led->blinking = true;
        led->edge_tick = now_ticks + BLINK_TICKS;
        led_set(led, motor, true);
    } else if (now_ticks >= led->edge_tick) {
        led->edge_tick += BLINK_TICKS;
        led_set(led, motor, !led->on);
    }
    return led->edge_tick;
}

/* In turns, so that the last motor has its second segment soon. */
static void rkm04_feed(struct rkm04 *unit)
{
    bool fed = true;
    while (fed) {
        fed = false;
        for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
            fed = axis_feed(&unit->axis[motor]) || fed;
        }
    }
}

/* T41 and C41 are for all motors that stand, also for those polled before the one that has run it. */
static void rkm04_simulate(struct rkm04 *unit)
{
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        axis_simulate(&unit->axis[motor], !unit->io.connected);
    }
}

uint64_t rkm04_poll(struct rkm04 *unit)
{
    uint16_t variables = unit->shared.variables;
    uint64_t wake = rkm04_line_poll(&unit->line);

    uint64_t now = hal_time_now();
    rkm04_line_note_pass(&unit->line, now);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        uint64_t program = interpreter_poll(&unit->interpreter[motor], now);
        uint64_t led = rkm04_poll_led(unit, motor, now);
        wake = program < wake ? program : wake;
        wake = led < wake ? led : wake;
    }
    rkm04_simulate(unit);
    rkm04_feed(unit);
    /* A motor polled before the one that wrote a variable may be waiting for it. */
    return unit->shared.variables != variables ? now : wake;
}

uint32_t rkm04_message(struct rkm04 *unit, const uint8_t *request, uint32_t length,
                       uint8_t answer[MESSAGES_ANSWER_BYTES_MAX])
{
    return messages_answer(&unit->messages, request, length, hal_time_now(), answer);
}

bool rkm04_is_idle(const struct rkm04 *unit)
{
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        if (!interpreter_is_idle(&unit->interpreter[motor])) {
            return false;
        }
    }
    return true;
}
