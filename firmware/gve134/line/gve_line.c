#include "gve_line.h"

#include <assert.h>
#include <stddef.h>

#include "base_text.h"

enum {
    INDEX_BYTES_MAX = 3,
    ROOM_FOR_COMMANDS = GVE_LINE_KEPT - GVE_LINE_SPARED,
    ROOM_FOR_NEWS = GVE_LINE_KEPT - GVE_LINE_SPARED_STOPS,
    ROOM_FOR_STOPS = GVE_LINE_KEPT,
};

/* A request with room spared for it comes at the least of this many bytes. */
static_assert(ROOM_FOR_COMMANDS * 3 >= 256, "256 bytes are kept");

void gve_line_init(struct gve_line *line, unsigned interpolator, unsigned spindle)
{
    *line = (struct gve_line){.index = 0};
    gve_receiver_init(&line->receiver, interpolator, spindle);
    gve_answer_init(&line->answer);
}

/* ---- what is kept ---------------------------------------------------------------------------------------------- */

static const struct gve_request *kept_at(const struct gve_line *line, uint32_t place)
{
    return &line->kept[(line->first + place) % GVE_LINE_KEPT];
}

/* False: so many are kept that there is no room. */
static bool keep(struct gve_line *line, const struct gve_request *request, uint32_t room)
{
    if (line->count >= room) {
        return false;
    }
    line->kept[(line->first + line->count) % GVE_LINE_KEPT] = *request;
    line->count++;
    return true;
}

static bool is_command(const struct gve_request *request, enum gve_opcode opcode)
{
    return request->kind == (uint8_t)GVE_REQUEST_COMMAND && request->fault == (uint8_t)GVE_FAULT_NONE &&
           request->command.opcode == (uint8_t)opcode;
}

bool gve_line_keeps(const struct gve_line *line, enum gve_opcode opcode)
{
    for (uint32_t place = 0; place < line->count; place++) {
        if (is_command(kept_at(line, place), opcode)) {
            return true;
        }
    }
    return false;
}

bool gve_line_ends_with(const struct gve_line *line, enum gve_opcode opcode)
{
    return line->count != 0 && is_command(kept_at(line, line->count - 1U), opcode);
}

/* ---- what comes ------------------------------------------------------------------------------------------------ */

static bool is_stop(const struct gve_request *request)
{
    return is_command(request, GVE_HALT) || is_command(request, GVE_RESET);
}

/* A wrong parameter makes the end of a packet wrong, but it stays its end; H and J are others with parameters. */
static bool is_packet_end(const struct gve_request *request)
{
    return request->command.opcode == (uint8_t)GVE_PACKET_END || is_stop(request);
}

static uint32_t room_for(const struct gve_request *request)
{
    uint32_t room = is_packet_end(request) ? ROOM_FOR_NEWS : ROOM_FOR_COMMANDS;
    return is_stop(request) ? ROOM_FOR_STOPS : room;
}

/* What counts from the next byte on. */
static void follow_command(struct gve_line *line, const struct gve_request *request)
{
    struct gve_receiver *receiver = &line->receiver;
    if (is_command(request, GVE_PACKET_BEGIN)) {
        receiver->packet = true;
        line->bad_packet = false;
    } else if (is_packet_end(request)) {
        receiver->packet = false;
    } else if (!receiver->packet && is_command(request, GVE_SUMS_ON)) {
        receiver->sums = true;
    } else if (!receiver->packet && is_command(request, GVE_SUMS_OFF)) {
        receiver->sums = false;
    } else {
        /* changes nothing here */
    }
}

/* Of a packet damage is told once: what was wrong first counts. */
static void keep_bad_line(struct gve_line *line)
{
    struct gve_request request = {.kind = GVE_REQUEST_BAD_LINE, .packet = true};
    if (!line->bad_packet) {
        line->bad_packet = keep(line, &request, ROOM_FOR_NEWS);
    }
}

/* Where it finds no room the line stays open all the same: H and J must be heard. */
static void keep_damage(struct gve_line *line)
{
    struct gve_request request = {.kind = GVE_REQUEST_DAMAGE};
    line->owes = !keep(line, &request, ROOM_FOR_NEWS);
}

/* What does not fit is damage. The end of a packet always fits: nothing else of it takes room that is spared, but the
 * news of damage, once. J leaves nothing of what waits before it. */
static void refuse_command(struct gve_line *line, const struct gve_request *request)
{
    if (is_command(request, GVE_RESET)) {
        line->count = 0;
        (void)keep(line, request, ROOM_FOR_STOPS);
    } else if (line->receiver.packet) {
        keep_bad_line(line);
    } else {
        gve_receiver_refuse(&line->receiver);
    }
}

static void keep_command(struct gve_line *line)
{
    const struct gve_receiver *receiver = &line->receiver;
    struct gve_reading reading =
        gve_command_read(gve_receiver_text(receiver), receiver->length, (enum gve_address)receiver->address);
    bool cut = receiver->too_long && reading.fault != GVE_FAULT_UNKNOWN;
    struct gve_request request = {
        .command = reading.command,
        .kind = GVE_REQUEST_COMMAND,
        .fault = (uint8_t)(cut ? GVE_FAULT_TOO_LONG : reading.fault),
        .packet = receiver->packet,
    };
    if (keep(line, &request, room_for(&request))) {
        follow_command(line, &request);
    } else {
        refuse_command(line, &request);
    }
}

static void keep_received(struct gve_line *line, enum gve_received received)
{
    if (received == GVE_RECEIVED_NOTHING) {
        return;
    }
    if (received == GVE_RECEIVED_LINE) {
        keep_command(line);
    } else if (received == GVE_RECEIVED_DAMAGE) {
        keep_damage(line);
    } else {
        keep_bad_line(line);
    }
}

void gve_line_take(struct gve_line *line, const struct hal_line_byte *byte)
{
    keep_received(line, gve_receiver_poll(&line->receiver, byte->tick));
    keep_received(line, gve_receiver_take(&line->receiver, byte));
}

void gve_line_take_run(struct gve_line *line, const struct hal_line_run *run)
{
    const uint8_t *next = run->bytes;
    const uint8_t *end = &run->bytes[run->count];
    if (run->broken) {
        gve_line_take(line, &(struct hal_line_byte){.tick = run->tick, .value = *next, .broken = true});
        return;
    }
    keep_received(line, gve_receiver_poll(&line->receiver, run->tick));
    while (next != end) {
        keep_received(line, gve_receiver_take_run(&line->receiver, &next, end, run->tick));
    }
}

uint64_t gve_line_poll(struct gve_line *line, uint64_t now_ticks)
{
    keep_received(line, gve_receiver_poll(&line->receiver, now_ticks));
    return gve_receiver_wake(&line->receiver);
}

/* ---- what goes out --------------------------------------------------------------------------------------------- */

/* The answer that tells of the switch has a checksum already, or none any more. */
static void follow_sums(struct gve_line *line, const struct gve_request *request)
{
    if (!request->packet && is_command(request, GVE_SUMS_ON)) {
        line->sums = true;
    }
    if (!request->packet && is_command(request, GVE_SUMS_OFF)) {
        line->sums = false;
    }
}

bool gve_line_next(struct gve_line *line, struct gve_request *request)
{
    if (line->count == 0) {
        return false;
    }
    *request = *kept_at(line, 0);
    line->first = (line->first + 1U) % GVE_LINE_KEPT;
    line->count--;
    if (line->owes) {
        keep_damage(line);
    }
    bool command = request->kind == (uint8_t)GVE_REQUEST_COMMAND;
    uint8_t opcode = request->command.opcode;
    line->apart = command && (opcode == (uint8_t)GVE_INDEX || opcode == (uint8_t)GVE_REPEAT);
    if (command && !line->apart) {
        line->index++;
    }
    follow_sums(line, request);
    return true;
}

void gve_line_answer(struct gve_line *line, enum gve_code code, bool inta, const uint8_t *values, uint32_t length)
{
    unsigned digit = (unsigned)code + (inta ? (unsigned)GVE_INTA : 0U);
    gve_answer_make(&line->answer, digit, values, length, line->sums, line->apart);
}

void gve_line_answer_index(struct gve_line *line, bool inta)
{
    uint8_t bytes[INDEX_BYTES_MAX];
    struct text text;
    text_init(&text, bytes, sizeof bytes);
    text_put_unsigned(&text, line->index, 0);
    gve_line_answer(line, GVE_DONE, inta, bytes, text.length);
}

void gve_line_answer_again(struct gve_line *line, bool inta)
{
    if (!gve_answer_again(&line->answer)) {
        gve_line_answer(line, GVE_DONE, inta, NULL, 0);
    }
}

bool gve_line_is_sending(const struct gve_line *line)
{
    return gve_answer_is_sending(&line->answer);
}

uint8_t gve_line_byte(const struct gve_line *line)
{
    return gve_answer_byte(&line->answer);
}

void gve_line_advance(struct gve_line *line)
{
    gve_answer_advance(&line->answer);
}
