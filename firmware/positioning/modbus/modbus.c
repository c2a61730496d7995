#include "modbus.h"

#include <stddef.h>

#include "modbus_crc.h"

enum server_state {
    STATE_LISTENING,
    STATE_ASKED, /* the request is for modbus_next */
    STATE_GIVEN, /* to be answered by the owner */
    STATE_READY, /* the answer is to begin */
    STATE_SENDING,
};

enum {
    AT_FUNCTION = 1,
    AT_DATA = 2,
    BYTE_BITS = 8,
    REGISTER_BYTES = 2,
};

void modbus_init(struct modbus *server, const struct modbus_setup *setup)
{
    assert(setup->node >= 1U && setup->node <= (uint8_t)MODBUS_NODE_MAX);
    *server = (struct modbus){
        .identity = setup->identity,
        .node = setup->node,
        .state = STATE_LISTENING,
    };
    modbus_receiver_init(&server->receiver, setup->rate_bd, setup->character_bits, setup->start_tick);
}

static void note(struct modbus *server, enum modbus_count count)
{
    server->counts[count]++;
}

/* ---- answers --------------------------------------------------------------------------------------------------- */

static void put_word(struct modbus *server, uint16_t word)
{
    server->answer[server->length] = (uint8_t)(word >> (unsigned)BYTE_BITS);
    server->answer[server->length + 1U] = (uint8_t)(word & UINT8_MAX);
    server->length += (uint16_t)REGISTER_BYTES;
}

static void put_byte(struct modbus *server, uint8_t byte)
{
    server->answer[server->length] = byte;
    server->length++;
}

static void begin_answer(struct modbus *server, uint8_t function)
{
    server->length = 0;
    put_byte(server, server->node);
    put_byte(server, function);
}

/* The answer to which nothing is added; it is kept if somebody is still waiting for it. */
static void end_answer(struct modbus *server)
{
    uint16_t crc = MODBUS_CRC_START;
    for (uint32_t i = 0; i < server->length; i++) {
        crc = modbus_crc_append(crc, server->answer[i]);
    }
    put_byte(server, (uint8_t)(crc & UINT8_MAX));
    put_byte(server, (uint8_t)(crc >> (unsigned)BYTE_BITS));
    server->state = (uint8_t)(server->owed ? STATE_READY : STATE_LISTENING);
}

static void refuse(struct modbus *server, enum modbus_exception exception)
{
    note(server, MODBUS_COUNT_EXCEPTIONS);
    begin_answer(server, server->request.function | (uint8_t)MODBUS_REFUSED);
    put_byte(server, (uint8_t)exception);
    end_answer(server);
}

void modbus_allow(struct modbus *server, uint64_t patience_ticks)
{
    server->patience_ticks = patience_ticks;
}

/* The answer to what only writes is what was asked, but for the values of more than one register. */
static void put_written(struct modbus *server)
{
    const struct modbus_request *request = &server->request;
    put_word(server, request->write_first);
    put_word(server, request->function == (uint8_t)MODBUS_WRITE_ONE ? request->values[0] : request->write_count);
}

static void put_read(struct modbus *server, const uint16_t *values)
{
    uint16_t read_count = server->request.read_count;
    put_byte(server, (uint8_t)(read_count * (uint32_t)REGISTER_BYTES));
    for (uint32_t i = 0; i < read_count; i++) {
        put_word(server, values[i]);
    }
}

void modbus_answer(struct modbus *server, const uint16_t *values)
{
    if (server->state != (uint8_t)STATE_GIVEN) {
        return;
    }
    begin_answer(server, server->request.function);
    if (server->request.read_count == 0U) {
        put_written(server);
    } else {
        put_read(server, values);
    }
    end_answer(server);
}

void modbus_refuse(struct modbus *server, enum modbus_exception exception)
{
    if (server->state == (uint8_t)STATE_GIVEN) {
        refuse(server, exception);
    }
}

/* ---- requests -------------------------------------------------------------------------------------------------- */

static void identify(struct modbus *server, const uint8_t *bytes, uint32_t length)
{
    uint32_t put = 0;
    enum modbus_exception exception =
        modbus_identity_answer(&server->identity, bytes, length, &server->answer[AT_FUNCTION], &put);
    server->request = (struct modbus_request){.function = MODBUS_IDENTIFY};
    if (exception != MODBUS_EXCEPTION_NONE) {
        refuse(server, exception);
        return;
    }
    server->answer[0] = server->node;
    server->length = (uint16_t)(put + (uint32_t)MODBUS_ADDRESS_BYTES);
    end_answer(server);
}

static void read_request(struct modbus *server, const uint8_t *bytes, uint32_t length)
{
    enum modbus_exception exception = modbus_request_read(&server->request, bytes, length);
    server->request.end_tick = server->receiver.tick;
    if (exception == MODBUS_EXCEPTION_NONE) {
        server->state = (uint8_t)STATE_ASKED;
    } else {
        refuse(server, exception);
    }
}

static bool is_for_all(uint8_t function)
{
    return function == (uint8_t)MODBUS_WRITE_ONE || function == (uint8_t)MODBUS_WRITE;
}

/* A request that has not been taken would be lost here. */
static void take_frame(struct modbus *server, bool broadcast)
{
    const uint8_t *bytes = &server->receiver.bytes[MODBUS_ADDRESS_BYTES];
    uint32_t length = server->receiver.length - (uint32_t)MODBUS_ADDRESS_BYTES - (uint32_t)MODBUS_CRC_BYTES;
    assert(server->state != (uint8_t)STATE_ASKED);
    note(server, MODBUS_COUNT_FRAMES);
    if (!broadcast) {
        server->heard_tick = server->receiver.tick;
    }
    if (broadcast && !is_for_all(bytes[0])) {
        return;
    }
    server->owed = !broadcast;
    server->patience_ticks = MODBUS_PATIENCE_TICKS;
    if (bytes[0] == (uint8_t)MODBUS_IDENTIFY) {
        identify(server, bytes, length);
    } else {
        read_request(server, bytes, length);
        server->request.broadcast = broadcast;
    }
}

static void judge_frame(struct modbus *server)
{
    const struct modbus_receiver *receiver = &server->receiver;
    uint8_t address = receiver->bytes[0];
    if (receiver->paused) {
        note(server, MODBUS_COUNT_PAUSES);
    }
    if (address == server->node || address == (uint8_t)MODBUS_ADDRESS_BROADCAST) {
        take_frame(server, address == (uint8_t)MODBUS_ADDRESS_BROADCAST);
    } else {
        note(server, MODBUS_COUNT_FOREIGN);
    }
}

static void see(struct modbus *server, enum modbus_received received)
{
    switch (received) {
    case MODBUS_RECEIVED_FRAME:
        judge_frame(server);
        break;
    case MODBUS_RECEIVED_BROKEN:
        note(server, MODBUS_COUNT_BROKEN);
        break;
    case MODBUS_RECEIVED_LENGTH:
        note(server, MODBUS_COUNT_LENGTH);
        break;
    case MODBUS_RECEIVED_CRC:
        note(server, MODBUS_COUNT_CRC);
        break;
    case MODBUS_RECEIVED_NOTHING:
        break;
    }
}

static void give_up_answer(struct modbus *server)
{
    if (server->owed) {
        note(server, MODBUS_COUNT_UNSENT);
        server->owed = false;
    }
    if (server->state == (uint8_t)STATE_READY) {
        server->state = (uint8_t)STATE_LISTENING;
    }
}

void modbus_take(struct modbus *server, const struct hal_line_byte *byte)
{
    assert(server->state != (uint8_t)STATE_SENDING);
    see(server, modbus_receiver_wait_byte(&server->receiver, byte));
    give_up_answer(server);
    modbus_receiver_take(&server->receiver, byte);
}

static void begin_sending(struct modbus *server, uint64_t now_ticks)
{
    if (now_ticks > server->receiver.tick + server->patience_ticks) {
        give_up_answer(server);
    } else {
        server->owed = false;
        server->place = 0;
        server->state = (uint8_t)STATE_SENDING;
    }
}

uint64_t modbus_poll(struct modbus *server, uint64_t now_ticks, bool quiet)
{
    see(server, modbus_receiver_wait(&server->receiver, now_ticks, quiet));
    if (server->state == (uint8_t)STATE_READY) {
        begin_sending(server, now_ticks);
    }
    return modbus_receiver_wake(&server->receiver, now_ticks);
}

const struct modbus_request *modbus_next(struct modbus *server)
{
    if (server->state != (uint8_t)STATE_ASKED) {
        return NULL;
    }
    server->state = (uint8_t)STATE_GIVEN;
    return &server->request;
}

/* ---- the line -------------------------------------------------------------------------------------------------- */

bool modbus_is_sending(const struct modbus *server)
{
    return server->state == (uint8_t)STATE_SENDING;
}

uint8_t modbus_byte(const struct modbus *server)
{
    return server->answer[server->place];
}

void modbus_advance(struct modbus *server)
{
    server->place++;
    if (server->place == server->length) {
        server->state = (uint8_t)STATE_LISTENING;
    }
}

const char *modbus_count_text(enum modbus_count count)
{
    static const char *const texts[] = {
#define X(name, text) [MODBUS_COUNT_##name] = (text),
        MODBUS_COUNTS(X)
#undef X
    };
    return texts[count];
}
