#include "gve134_private.h"

#include <assert.h>
#include <stddef.h>

#include "base_tick.h"
#include "hal_board.h"
#include "hal_line.h"
#include "hal_step.h"
#include "hal_time.h"

enum {
    HEARD_MAX = 64,                   /* bytes in one pass */
    SERVE_TICKS = 100 * TICKS_PER_US, /* of a packet no request is begun later after the first one */
    OUT_TICKS = 100 * TICKS_PER_US,   /* so often main looks whether an answer is out that others wait for */
    OWN_AXIS = 3,
    DIRECTION_BITS = 4, /* bits of the directions in the byte of polarities begin there */
};

/* ---- interrupts ------------------------------------------------------------------------------------------------ */

static unsigned gve134_lay_isr(void *context, unsigned motor, struct hal_step_room *room)
{
    struct gve134 *unit = context;
    return gve_queue_lay_isr(&unit->queue, motor, room);
}

static void gve134_tick_isr(void *context, uint64_t since_tick)
{
    struct gve134 *unit = context;
    (void)since_tick;
    (void)io_sample(&unit->io);
    if (gve_queue_sense_isr(&unit->queue, io_inputs(&unit->io))) {
        hal_run_plan();
    }
}

static void gve134_plan_isr(void *context)
{
    struct gve134 *unit = context;
    gve_queue_plan_isr(&unit->queue);
}

/* ---- start and reset ------------------------------------------------------------------------------------------- */

bool gve134_is_locked(const struct gve134 *unit)
{
    return unit->faulted || !hal_board_may_move();
}

bool gve134_inta(const struct gve134 *unit)
{
    return gve_queue_inta(&unit->queue) || gve134_is_locked(unit);
}

void gve134_apply_memory(struct gve134 *unit)
{
    unsigned polarity = unit->memory.bytes[GVE_MEMORY_POLARITY];
    unsigned coupling = unit->memory.bytes[GVE_MEMORY_COUPLING];
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        bool falling = (polarity >> motor & 1U) == 0;
        bool turned = (polarity >> (motor + (unsigned)DIRECTION_BITS) & 1U) == 0;
        hal_step_set_polarity(motor, falling, turned);
    }
    gve_queue_couple(&unit->queue, coupling >= 1U && coupling <= (unsigned)OWN_AXIS ? coupling - 1U : OWN_AXIS);
}

/* As after a reset, but for the EEPROM. */
static void begin(struct gve134 *unit)
{
    unit->packet.open = false;
    unit->waiting = (uint8_t)GVE134_WAITS_NOT;
    unit->late_before = hal_board_late_steps();
    gve_queue_init(&unit->queue);
    gve_line_init(&unit->line, GVE134_INTERPOLATOR, GVE134_SPINDLE);
    gve134_apply_memory(unit);
    gve_outputs_init(&unit->outputs, &unit->io, gve134_is_locked(unit), hal_time_now());
}

void gve134_init(struct gve134 *unit)
{
    io_init(&unit->io);
    gve_memory_init(&unit->memory);
    unit->faulted = !hal_board_may_start_programs() || unit->memory.damaged;
    unit->client = (struct hal_client){
        .context = unit,
        .lay_isr = gve134_lay_isr,
        .tick_isr = gve134_tick_isr,
        .plan_isr = gve134_plan_isr,
    };
    begin(unit);
}

void gve134_start(struct gve134 *unit)
{
    hal_run_start(&unit->client);
    hal_step_hold();
    (void)io_sample(&unit->io);
    hal_step_release();
}

void gve134_abort(struct gve134 *unit)
{
    unit->faulted = false;
    unit->waiting = (uint8_t)GVE134_WAITS_FOR_RESET;
    gve_queue_abort(&unit->queue);
    gve_outputs_init(&unit->outputs, &unit->io, gve134_is_locked(unit), hal_time_now());
}

/* ---- line ------------------------------------------------------------------------------------------------------ */

static bool waits_for(const struct gve134 *unit, enum gve134_waiting waiting)
{
    return unit->waiting == (uint8_t)waiting;
}

/* What comes after J is for the unit after the reset, so J is the last that is kept. */
static bool may_hear(const struct gve134 *unit)
{
    return !waits_for(unit, GVE134_WAITS_FOR_RESET) && !gve_line_ends_with(&unit->line, GVE_RESET);
}

/* Returns when to call again at the latest. */
static uint64_t hear(struct gve134 *unit, uint64_t now)
{
    struct hal_line_run run;
    for (uint32_t count = 0; may_hear(unit); count += run.count) {
        if (count >= (uint32_t)HEARD_MAX) {
            return now;
        }
        if (!hal_line_read_run(&run, GVE_LINE_END)) {
            return gve_line_poll(&unit->line, now);
        }
        gve_outputs_note_data(&unit->outputs, now);
        gve_line_take_run(&unit->line, &run);
    }
    return TICK_NEVER;
}

static void send(struct gve134 *unit, uint64_t now)
{
    while (gve_line_is_sending(&unit->line) && hal_line_write(gve_line_byte(&unit->line))) {
        gve_line_advance(&unit->line);
        gve_outputs_note_data(&unit->outputs, now);
    }
}

static void answer(struct gve134 *unit, enum gve_code code, const struct text *values)
{
    gve_line_answer(&unit->line, code, gve134_inta(unit), values != NULL ? values->bytes : NULL,
                    values != NULL ? values->length : 0);
    send(unit, hal_time_now());
}

/* ---- requests -------------------------------------------------------------------------------------------------- */

static bool is_command(const struct gve_request *request, enum gve_opcode opcode)
{
    return request->kind == (uint8_t)GVE_REQUEST_COMMAND && request->fault == (uint8_t)GVE_FAULT_NONE &&
           request->command.opcode == (uint8_t)opcode;
}

/* H and J end a packet and are executed as usual. */
static bool is_of_packet(struct gve134 *unit, const struct gve_request *request)
{
    if (is_command(request, GVE_HALT) || is_command(request, GVE_RESET)) {
        unit->packet.open = false;
    }
    return unit->packet.open || is_command(request, GVE_PACKET_BEGIN);
}

static void serve_packet(struct gve134 *unit, const struct gve_request *request, struct gve134_reply *reply)
{
    gve134_take_packet(unit, request, reply);
    if (!reply->later) {
        answer(unit, reply->code, &reply->values);
        if (reply->code == GVE_DONE) {
            gve134_enter_packet(unit);
        }
    }
}

static void serve_command(struct gve134 *unit, const struct gve_request *request, struct gve134_reply *reply)
{
    if (is_command(request, GVE_INDEX)) {
        gve_line_answer_index(&unit->line, gve134_inta(unit));
    } else if (is_command(request, GVE_REPEAT)) {
        gve_line_answer_again(&unit->line, gve134_inta(unit));
    } else {
        gve134_execute(unit, request, reply);
        if (!reply->later) {
            answer(unit, reply->code, &reply->values);
        }
        if (reply->changes) {
            gve134_change(unit, &request->command);
        }
    }
}

static void serve(struct gve134 *unit, const struct gve_request *request)
{
    struct gve134_reply reply;
    reply.code = GVE_DONE;
    reply.later = false;
    reply.changes = false;
    text_init(&reply.values, reply.bytes, sizeof reply.bytes);
    if (is_of_packet(unit, request)) {
        serve_packet(unit, request, &reply);
    } else if (request->kind != (uint8_t)GVE_REQUEST_COMMAND) {
        answer(unit, GVE_DAMAGED, NULL);
    } else {
        serve_command(unit, request, &reply);
    }
}

/* What H or W has waited for. */
static void answer_late(struct gve134 *unit)
{
    enum gve_home_result result = gve_queue_home_result(&unit->queue);
    if (waits_for(unit, GVE134_WAITS_FOR_HALT) && !gve_queue_moves(&unit->queue)) {
        unit->waiting = (uint8_t)GVE134_WAITS_NOT;
        answer(unit, GVE_DONE, NULL);
    } else if (waits_for(unit, GVE134_WAITS_FOR_HOME) && result != GVE_HOME_RUNS) {
        unit->waiting = (uint8_t)GVE134_WAITS_NOT;
        answer(unit, result == GVE_HOME_NOT_FOUND ? GVE_OUT_OF_BOUNDS : GVE_DONE, NULL);
    } else {
        /* it goes on waiting */
    }
}

/* J leaves nothing of what waits before it; H ends a reference run, and is answered after it. True: the axes have got
 * another end. */
static bool act_at_once(struct gve134 *unit)
{
    struct gve_request request;
    bool acts = false;
    if (waits_for(unit, GVE134_WAITS_NOT)) {
        return false;
    }
    if (gve_line_ends_with(&unit->line, GVE_RESET)) {
        do {
            (void)gve_line_next(&unit->line, &request);
        } while (!is_command(&request, GVE_RESET));
        serve(unit, &request);
        acts = true;
    } else if (waits_for(unit, GVE134_WAITS_FOR_HOME) && !unit->queue.halting &&
               gve_line_keeps(&unit->line, GVE_HALT)) {
        (void)gve_queue_halt(&unit->queue);
        acts = true;
    } else {
        /* it waits for its turn */
    }
    return acts;
}

/* A request is there whose turn it is as soon as the answer before it is out. */
static bool has_turn(const struct gve134 *unit)
{
    return waits_for(unit, GVE134_WAITS_NOT) && unit->line.count != 0 && !gve_line_is_sending(&unit->line);
}

/* True: a request has been served, and there may be more. */
static bool serve_next(struct gve134 *unit)
{
    struct gve_request request;
    if (!has_turn(unit) || !hal_line_is_idle()) {
        return false;
    }
    (void)gve_line_next(&unit->line, &request);
    serve(unit, &request);
    return true;
}

/* One request, or as many of a packet as there is time for: these only wait for its end. True: there may be more. */
static bool serve_some(struct gve134 *unit)
{
    bool more = serve_next(unit);
    if (!more || !unit->packet.open) {
        return more;
    }
    uint64_t until = hal_time_now() + SERVE_TICKS;
    while (more && unit->packet.open) {
        if (hal_time_now() >= until) {
            break;
        }
        more = serve_next(unit);
    }
    return true;
}

/* ---- main ------------------------------------------------------------------------------------------------------ */

static uint64_t earlier(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static uint64_t poll_queue(struct gve134 *unit)
{
    uint64_t wake = gve_queue_poll(&unit->queue, io_inputs(&unit->io));
    answer_late(unit);
    if (act_at_once(unit) || serve_some(unit)) {
        return hal_time_now();
    }
    return has_turn(unit) ? earlier(wake, hal_time_now() + (uint64_t)OUT_TICKS) : wake;
}

/* J: the answer goes out and the last pulses come to an end; then all is as after a reset. */
static uint64_t poll_reset(struct gve134 *unit)
{
    if (gve_line_is_sending(&unit->line) || !gve_queue_is_quiet(&unit->queue)) {
        return TICK_NEVER;
    }
    begin(unit);
    return hal_time_now();
}

uint64_t gve134_poll(struct gve134 *unit)
{
    uint64_t now = hal_time_now();
    send(unit, now);
    uint64_t wake = hear(unit, now);
    if (waits_for(unit, GVE134_WAITS_FOR_RESET)) {
        wake = earlier(wake, poll_reset(unit));
    } else {
        wake = earlier(wake, poll_queue(unit));
    }
    const struct gve_doing doing = {
        .locked = gve134_is_locked(unit),
        .inta = gve134_inta(unit),
        .moves = gve_queue_moves(&unit->queue),
        .inputs = io_inputs(&unit->io),
    };
    return earlier(wake, gve_outputs_poll(&unit->outputs, &unit->memory, &doing, now));
}

bool gve134_is_idle(const struct gve134 *unit)
{
    return waits_for(unit, GVE134_WAITS_NOT) && unit->line.count == 0 && !gve_line_is_sending(&unit->line) &&
           !gve_queue_moves(&unit->queue);
}
