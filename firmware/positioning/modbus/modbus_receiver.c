#include "modbus_receiver.h"

#include "modbus_crc.h"

enum bus_state {
    STATE_START,  /* the bus has not been silent since the start: what comes may be the rest of a frame */
    STATE_SILENT, /* the next byte begins a frame */
    STATE_INSIDE,
};

enum {
    SLOW_BD_MAX = 19200,
    CHARACTER_HALVES = 2, /* halves of a character */
    PAUSE_HALVES = 3,
    SILENCE_HALVES = 7,
};

#define FAST_SILENCE_TICKS (TICKS_PER_US * UINT32_C(1750))
#define FAST_PAUSE_TICKS (TICKS_PER_US * UINT32_C(750))

/* The ticks of some halves of a character; no product passes 2^32. */
static uint32_t halves_ticks(uint32_t rate_bd, uint32_t character_bits, uint32_t halves)
{
    uint32_t bits_ticks = TICK_HZ * character_bits;
    uint32_t divisor = 2U * rate_bd;
    return ((bits_ticks / divisor) * halves) + (((bits_ticks % divisor) * halves) / divisor);
}

void modbus_receiver_init(struct modbus_receiver *receiver, uint32_t rate_bd, uint32_t character_bits,
                          uint64_t start_tick)
{
    bool slow = rate_bd <= (uint32_t)SLOW_BD_MAX;
    *receiver = (struct modbus_receiver){
        .tick = start_tick,
        .character_ticks = halves_ticks(rate_bd, character_bits, CHARACTER_HALVES),
        .silence_ticks = slow ? halves_ticks(rate_bd, character_bits, SILENCE_HALVES) : FAST_SILENCE_TICKS,
        .pause_ticks = slow ? halves_ticks(rate_bd, character_bits, PAUSE_HALVES) : FAST_PAUSE_TICKS,
        .state = STATE_START,
    };
}

static enum modbus_received judge(const struct modbus_receiver *receiver)
{
    if (receiver->broken) {
        return MODBUS_RECEIVED_BROKEN;
    }
    if (receiver->length < (uint16_t)MODBUS_FRAME_BYTES_MIN || receiver->length > (uint16_t)MODBUS_FRAME_BYTES_MAX) {
        return MODBUS_RECEIVED_LENGTH;
    }
    return receiver->crc == MODBUS_CRC_GOOD ? MODBUS_RECEIVED_FRAME : MODBUS_RECEIVED_CRC;
}

/* The tick at which the bus has been silent for T, as far as can be known `later` after that. */
static uint64_t silent_tick(const struct modbus_receiver *receiver, uint32_t later_ticks)
{
    return receiver->tick + receiver->silence_ticks + later_ticks;
}

static enum modbus_received see_silence(struct modbus_receiver *receiver)
{
    bool inside = receiver->state == (uint8_t)STATE_INSIDE;
    receiver->state = (uint8_t)STATE_SILENT;
    return inside ? judge(receiver) : MODBUS_RECEIVED_NOTHING;
}

enum modbus_received modbus_receiver_wait_byte(struct modbus_receiver *receiver, const struct hal_line_byte *byte)
{
    bool silent = byte->tick >= silent_tick(receiver, receiver->character_ticks);
    return silent ? see_silence(receiver) : MODBUS_RECEIVED_NOTHING;
}

/* A byte that is on its way may have begun within T, which is known when it is complete. */
enum modbus_received modbus_receiver_wait(struct modbus_receiver *receiver, uint64_t now_ticks, bool quiet)
{
    uint64_t end_tick = silent_tick(receiver, quiet ? 0U : receiver->character_ticks);
    return now_ticks >= end_tick ? see_silence(receiver) : MODBUS_RECEIVED_NOTHING;
}

uint64_t modbus_receiver_wake(const struct modbus_receiver *receiver, uint64_t now_ticks)
{
    if (receiver->state != (uint8_t)STATE_INSIDE) {
        return TICK_NEVER;
    }
    uint64_t tick = silent_tick(receiver, 0);
    return now_ticks < tick ? tick : silent_tick(receiver, receiver->character_ticks);
}

static void begin_frame(struct modbus_receiver *receiver)
{
    receiver->state = (uint8_t)STATE_INSIDE;
    receiver->length = 0;
    receiver->crc = MODBUS_CRC_START;
    receiver->broken = false;
    receiver->paused = false;
}

static void append(struct modbus_receiver *receiver, const struct hal_line_byte *byte)
{
    receiver->broken = receiver->broken || byte->broken;
    receiver->crc = modbus_crc_append(receiver->crc, byte->value);
    if (receiver->length < (uint16_t)MODBUS_FRAME_BYTES_MAX) {
        receiver->bytes[receiver->length] = byte->value;
    }
    if (receiver->length <= (uint16_t)MODBUS_FRAME_BYTES_MAX) {
        receiver->length++;
    }
}

void modbus_receiver_take(struct modbus_receiver *receiver, const struct hal_line_byte *byte)
{
    if (receiver->state == (uint8_t)STATE_SILENT) {
        begin_frame(receiver);
    } else if (byte->tick > receiver->tick + receiver->character_ticks + receiver->pause_ticks) {
        receiver->paused = true;
    } else {
        /* in the middle */
    }
    receiver->tick = byte->tick;
    if (receiver->state == (uint8_t)STATE_INSIDE) {
        append(receiver, byte);
    }
}
