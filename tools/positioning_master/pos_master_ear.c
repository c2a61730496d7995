#include "pos_master_ear.h"

#include <string.h>

#include "modbus_crc.h"

enum {
    BYTE_BITS = 8,
    AT_FUNCTION = MODBUS_ADDRESS_BYTES,
    ENVELOPE_BYTES = MODBUS_ADDRESS_BYTES + MODBUS_CRC_BYTES,

    /* From the function on. */
    REFUSED_BYTES = 2,
    WRITTEN_BYTES = 5,
    READ_AT_VALUES = 2,
    IDENTITY_AT_COUNT = 6,
    IDENTITY_AT_OBJECTS = 7,

    KEPT_BYTES = MODBUS_FRAME_BYTES_MAX,
};

static_assert((uint32_t)KEPT_BYTES < (uint32_t)POS_MASTER_EAR_BYTES,
              "there is room for one byte more than what is kept");

void pos_master_ear_init(struct pos_master_ear *ear)
{
    memset(ear, 0, sizeof *ear);
    ear->crc = MODBUS_CRC_START;
}

bool pos_master_ear_is_whole(const struct pos_master_ear *ear)
{
    return !ear->loose && ear->whole == ear->length;
}

bool pos_master_ear_may_be_echo(const struct pos_master_ear *ear, const struct pos_master_frame *sent)
{
    return !ear->loose && !sent->tcp && ear->length <= sent->length &&
           memcmp(ear->heard, sent->bytes, ear->length) == 0;
}

/* Makes room: an answer that has begun is no longer than what is kept. */
static void keep_last(struct pos_master_ear *ear)
{
    memmove(ear->heard, ear->heard + ear->length - KEPT_BYTES, KEPT_BYTES);
    ear->length = KEPT_BYTES;
    ear->whole = ear->echo = 0;
    ear->loose = true;
}

static void append(struct pos_master_ear *ear, uint8_t byte)
{
    if (ear->length == (uint32_t)POS_MASTER_EAR_BYTES) {
        keep_last(ear);
    }
    ear->heard[ear->length++] = byte;
    ear->crc = modbus_crc_append(ear->crc, byte);
}

/* The bytes of the identification that begins here, so far as it has come; 0: that is not known yet. */
static uint32_t identity_bytes(const uint8_t *answer, uint32_t length)
{
    if (length <= (uint32_t)IDENTITY_AT_COUNT) {
        return 0;
    }
    uint32_t place = IDENTITY_AT_OBJECTS;
    for (uint32_t left = answer[IDENTITY_AT_COUNT]; left > 0U; left--) {
        if (place + 1U >= length) {
            return 0;
        }
        place += 2U + answer[place + 1U];
    }
    return place;
}

static uint32_t answer_bytes(const uint8_t *answer, uint32_t length)
{
    if (length < (uint32_t)READ_AT_VALUES) {
        return 0;
    }
    if ((answer[0] & (uint8_t)MODBUS_REFUSED) != 0U) {
        return REFUSED_BYTES;
    }
    switch (answer[0]) {
    case MODBUS_WRITE_ONE:
    case MODBUS_WRITE:
        return WRITTEN_BYTES;
    case MODBUS_IDENTIFY:
        return identity_bytes(answer, length);
    default:
        return (uint32_t)READ_AT_VALUES + answer[1];
    }
}

static bool is_function_of(uint8_t function, uint8_t asked)
{
    return (function & (uint8_t)~(unsigned)MODBUS_REFUSED) == asked;
}

/* Whether the answer stands from a place to the end. */
static bool ends_here(struct pos_master_ear *ear, const struct pos_master_frame *sent, uint32_t at)
{
    const uint8_t *frame = ear->heard + at;
    uint32_t length = ear->length - at;
    if (length < (uint32_t)MODBUS_FRAME_BYTES_MIN || frame[0] != sent->bytes[0] ||
        !is_function_of(frame[AT_FUNCTION], sent->bytes[AT_FUNCTION])) {
        return false;
    }
    uint32_t bytes = answer_bytes(frame + AT_FUNCTION, length - (uint32_t)ENVELOPE_BYTES);
    if (bytes == 0U || bytes + (uint32_t)ENVELOPE_BYTES != length) {
        return false;
    }
    uint16_t crc = MODBUS_CRC_START;
    for (uint32_t i = 0; i < length; i++) {
        crc = modbus_crc_append(crc, frame[i]);
    }
    ear->answer_at = at + (uint32_t)AT_FUNCTION;
    ear->answer_length = bytes;
    return crc == MODBUS_CRC_GOOD;
}

static void note_whole(struct pos_master_ear *ear)
{
    ear->whole = ear->length;
    ear->crc = MODBUS_CRC_START;
}

static bool take_rtu(struct pos_master_ear *ear, const struct pos_master_frame *sent)
{
    if (pos_master_ear_may_be_echo(ear, sent) && sent->bytes[AT_FUNCTION] != (uint8_t)MODBUS_WRITE_ONE) {
        if (ear->length == sent->length) {
            ear->echo = ear->length;
            note_whole(ear);
        }
        return false;
    }
    for (uint32_t at = ear->echo; at < ear->length; at++) {
        if (ends_here(ear, sent, at)) {
            return true;
        }
    }
    if (ear->length - ear->whole >= (uint32_t)MODBUS_FRAME_BYTES_MIN && ear->crc == MODBUS_CRC_GOOD) {
        note_whole(ear);
    }
    return false;
}

static uint32_t tcp_length(const struct pos_master_ear *ear)
{
    return ((uint32_t)ear->heard[POS_MASTER_TCP_AT_LENGTH] << (unsigned)BYTE_BITS) |
           ear->heard[POS_MASTER_TCP_AT_LENGTH + 1];
}

/* Whether a frame of Modbus TCP may begin so: its length is that of an address, a function and something more. */
static bool is_tcp_head(const struct pos_master_ear *ear)
{
    uint32_t length = tcp_length(ear);
    return ear->heard[2] == 0U && ear->heard[3] == 0U && length > (uint32_t)MODBUS_ADDRESS_BYTES + 1U &&
           length <= (uint32_t)MODBUS_ADDRESS_BYTES + (uint32_t)POS_MASTER_REQUEST_BYTES_MAX;
}

static bool is_tcp_answer(const struct pos_master_ear *ear, const struct pos_master_frame *sent)
{
    return memcmp(ear->heard, sent->bytes, 2) == 0 &&
           ear->heard[POS_MASTER_TCP_AT_NODE] == sent->bytes[POS_MASTER_TCP_AT_NODE] &&
           is_function_of(ear->heard[POS_MASTER_TCP_HEAD_BYTES], sent->bytes[POS_MASTER_TCP_HEAD_BYTES]);
}

static bool take_tcp(struct pos_master_ear *ear, const struct pos_master_frame *sent)
{
    if (ear->length <= (uint32_t)POS_MASTER_TCP_AT_NODE) {
        return false;
    }
    if (!is_tcp_head(ear)) {
        ear->loose = true;
        ear->length = 0;
        return false;
    }
    if (ear->length < (uint32_t)POS_MASTER_TCP_AT_NODE + tcp_length(ear)) {
        return false;
    }
    ear->answer_at = POS_MASTER_TCP_HEAD_BYTES;
    ear->answer_length = ear->length - (uint32_t)POS_MASTER_TCP_HEAD_BYTES;
    ear->length = 0;
    return is_tcp_answer(ear, sent);
}

bool pos_master_ear_take(struct pos_master_ear *ear, const struct pos_master_frame *sent, uint8_t byte)
{
    append(ear, byte);
    return sent->tcp ? take_tcp(ear, sent) : take_rtu(ear, sent);
}
