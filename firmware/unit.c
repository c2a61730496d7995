#include "unit.h"

#include <assert.h>

#include "base_tick.h"
#include "hal_board.h"
#include "hal_io.h"
#include "hal_run.h"
#include "hal_step.h"
#include "hal_time.h"
#include "unit_line.h"

/* A blinking LED is on for half a second and off for half a second. */
#define BLINK_TICKS ((uint64_t)TICK_HZ / 2U)

static_assert((uint32_t)PROTOCOL_LINE_COUNTS == (uint32_t)LINK_COUNTS_TOTAL, "Get Status tells all of them");
static_assert((uint32_t)PROTOCOL_ANSWER_BYTES_MAX >= (uint32_t)STORE_TEXT_BYTES_MAX, "a stored program must fit");

static bool unit_step_isr(void *context, unsigned motor)
{
    struct unit *unit = context;
    return mover_pulse_isr(&unit->mover[motor]);
}

/* Stops motors as the inputs say; what takes long is left to the plan interrupt. */
static void unit_sense(struct unit *unit, uint64_t since_tick)
{
    bool stops = false;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        stops = mover_sense_isr(&unit->mover[motor], io_inputs(&unit->io), since_tick) || stops;
    }
    if (stops) {
        hal_run_plan();
    }
}

static void unit_tick_isr(void *context, uint64_t since_tick)
{
    struct unit *unit = context;
    (void)io_sample_isr(&unit->io);
    unit_sense(unit, since_tick);
}

static void unit_plan_isr(void *context)
{
    struct unit *unit = context;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        mover_plan_isr(&unit->mover[motor]);
    }
}

void unit_init(struct unit *unit)
{
    io_init(&unit->io);
    store_init(&unit->store);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        mover_init(&unit->mover[motor], motor);
        interpreter_init(&unit->interpreter[motor], motor, &unit->mover[motor], &unit->io);
        unit->led[motor] = (struct unit_led){.on = false};
        hal_io_set_led(motor, false);
    }
    unit->protocol = (struct protocol){
        .interpreters = unit->interpreter,
        .store = &unit->store,
        .version = UNIT_VERSION,
        .line_counts = unit->link.receiver.counts,
    };
    unit->client = (struct hal_client){
        .context = unit,
        .step_isr = unit_step_isr,
        .tick_isr = unit_tick_isr,
        .plan_isr = unit_plan_isr,
    };
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        unit->client.channel[motor] = &unit->mover[motor].channel;
    }
}

static void unit_start_program(struct unit *unit, unsigned motor, uint64_t now_ticks)
{
    struct interpreter *interpreter = &unit->interpreter[motor];
    uint32_t length = store_load(&unit->store, motor, unit->answer);

    if (store_is_damaged(&unit->store, motor) || !interpreter_load(interpreter, unit->answer, length, now_ticks)) {
        interpreter_fail(interpreter, INTERPRETER_ERROR_STORED_PROGRAM, now_ticks);
    }
}

/* The tick interrupt shows the inputs when they change, or in a millisecond. */
static void unit_look(struct unit *unit, uint64_t now_ticks)
{
    hal_step_hold();
    (void)io_sample_isr(&unit->io);
    hal_step_release();
    unit_sense(unit, now_ticks);
}

void unit_start(struct unit *unit)
{
    hal_run_start(&unit->client);
    uint64_t now = hal_time_now();
    unit_look(unit, now);
    unit->polled_tick = now;
    for (unsigned motor = 0; hal_board_may_start_programs() && motor < UNIT_MOTORS; motor++) {
        unit_start_program(unit, motor, now);
    }
    unit_line_start(unit);
}

static void led_set(struct unit_led *led, unsigned motor, bool on)
{
    if (led->on != on) {
        led->on = on;
        hal_io_set_led(motor, on);
    }
}

/* On while the motor moves, blinking while its program has failed. Returns the tick of the next change by itself. */
static uint64_t unit_poll_led(struct unit *unit, unsigned motor, uint64_t now_ticks)
{
    struct unit_led *led = &unit->led[motor];
    bool moving = mover_is_moving(&unit->mover[motor]);

    if (moving || unit->interpreter[motor].state != INTERPRETER_FAILED) {
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
static void unit_feed(struct unit *unit)
{
    bool fed = true;
    while (fed) {
        fed = false;
        for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
            fed = mover_feed(&unit->mover[motor]) || fed;
        }
    }
}

/* T41 and C41 are for all motors that stand, also for those polled before the one that has run it. */
static void unit_connect(struct unit *unit)
{
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        if (!mover_is_moving(&unit->mover[motor])) {
            mover_connect(&unit->mover[motor], !unit->io.simulating);
        }
    }
}

uint64_t unit_poll(struct unit *unit)
{
    uint16_t variables = unit->io.variables;
    uint64_t wake = unit_line_poll(unit);

    uint64_t now = hal_time_now();
    unit->polled_tick = now;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        uint64_t program = interpreter_poll(&unit->interpreter[motor], now);
        uint64_t led = unit_poll_led(unit, motor, now);
        wake = program < wake ? program : wake;
        wake = led < wake ? led : wake;
    }
    unit_connect(unit);
    unit_feed(unit);
    /* A motor polled before the one that wrote a variable may be waiting for it. */
    return unit->io.variables != variables ? now : wake;
}

uint32_t unit_message(struct unit *unit, const uint8_t *request, uint32_t length,
                      uint8_t answer[PROTOCOL_ANSWER_BYTES_MAX])
{
    return protocol_answer(&unit->protocol, request, length, hal_time_now(), answer);
}

bool unit_is_idle(const struct unit *unit)
{
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        if (!interpreter_is_idle(&unit->interpreter[motor])) {
            return false;
        }
    }
    return true;
}
