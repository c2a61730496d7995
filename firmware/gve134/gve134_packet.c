#include "gve134_private.h"

#include <assert.h>
#include <string.h>

static_assert((uint32_t)GVE134_PACKET_COMMANDS_MAX == (uint32_t)GVE_QUEUE_VECTORS, "a packet can fill the queue");

static void begin(struct gve134_packet *packet, uint32_t brake)
{
    packet->open = true;
    packet->count = 0;
    packet->commands = 0;
    packet->brake = brake;
    packet->code = GVE_DONE;
}

/* What is wrong first counts. */
static void note(struct gve134_packet *packet, enum gve_code code)
{
    if (packet->code == (uint8_t)GVE_DONE) {
        packet->code = (uint8_t)code;
    }
}

static void stage(struct gve134_packet *packet, const struct gve_command *command)
{
    if (packet->commands > (uint32_t)GVE134_PACKET_COMMANDS_MAX) {
        note(packet, GVE_OUT_OF_BOUNDS);
    } else if (command->opcode == (uint8_t)GVE_BRAKE) {
        packet->brake = (uint32_t)command->numbers[0];
    } else {
        struct gve134_staged *staged = &packet->vectors[packet->count++];
        memcpy(staged->steps, command->numbers, sizeof staged->steps);
        staged->brake = packet->brake;
    }
}

static void take_command(struct gve134 *unit, const struct gve_request *request)
{
    struct gve134_packet *packet = &unit->packet;
    const struct gve_command *command = &request->command;
    if (command->opcode == (uint8_t)GVE_OPCODES) {
        note(packet, GVE_UNKNOWN);
    } else if (gve_row(command->opcode)->packet != (uint8_t)GVE_PACKET_TAKEN) {
        note(packet, GVE_WRONG_SYNTAX);
    } else {
        packet->commands++;
        if (request->fault != (uint8_t)GVE_FAULT_NONE) {
            note(packet, gve_fault_code((enum gve_fault)request->fault));
        } else if (gve134_is_coupled_out(unit, command)) {
            note(packet, GVE_OUT_OF_BOUNDS);
        } else {
            stage(packet, command);
        }
    }
}

static bool fits(const struct gve134 *unit)
{
    const struct gve134_packet *packet = &unit->packet;
    uint32_t places = 0;
    for (uint32_t i = 0; i < packet->count; i++) {
        places += gve134_has_pulses(packet->vectors[i].steps) ? 1U : 0U;
    }
    return packet->count == 0 || (!unit->queue.kept.valid && places <= gve_queue_room(&unit->queue));
}

static void end(struct gve134 *unit, const struct gve_request *request, struct gve134_reply *reply)
{
    struct gve134_packet *packet = &unit->packet;
    if (request->fault != (uint8_t)GVE_FAULT_NONE) {
        note(packet, gve_fault_code((enum gve_fault)request->fault));
    } else if ((uint32_t)request->command.numbers[0] != packet->commands) {
        note(packet, GVE_DAMAGED);
    } else if (packet->count != 0 && gve134_is_locked(unit)) {
        note(packet, GVE_NOT_NOW);
    } else if (!fits(unit)) {
        note(packet, GVE_NO_ROOM);
    } else {
        /* all is well, if nothing was wrong before */
    }
    packet->open = false;
    reply->code = (enum gve_code)packet->code;
    text_put_unsigned(&reply->values, reply->code == GVE_DONE ? packet->commands : 0U, 0);
}

void gve134_take_packet(struct gve134 *unit, const struct gve_request *request, struct gve134_reply *reply)
{
    struct gve134_packet *packet = &unit->packet;
    uint8_t opcode = request->command.opcode;
    if (request->kind == (uint8_t)GVE_REQUEST_DAMAGE) {
        packet->open = false;
        reply->code = GVE_DAMAGED;
        text_put_unsigned(&reply->values, 0, 0);
        return;
    }
    reply->later = true;
    if (request->kind == (uint8_t)GVE_REQUEST_BAD_LINE) {
        note(packet, GVE_DAMAGED);
    } else if (opcode == (uint8_t)GVE_PACKET_BEGIN && request->fault == (uint8_t)GVE_FAULT_NONE) {
        begin(packet, unit->queue.modal.brake);
    } else if (opcode == (uint8_t)GVE_PACKET_END) {
        reply->later = false;
        end(unit, request, reply);
    } else {
        take_command(unit, request);
    }
}

void gve134_enter_packet(struct gve134 *unit)
{
    const struct gve134_packet *packet = &unit->packet;
    for (uint32_t i = 0; i < packet->count; i++) {
        unit->queue.modal.brake = packet->vectors[i].brake;
        if (gve134_has_pulses(packet->vectors[i].steps)) {
            gve_queue_enter(&unit->queue, packet->vectors[i].steps);
        }
    }
    unit->queue.modal.brake = packet->brake;
    gve_queue_begin(&unit->queue, io_inputs(&unit->io));
}
