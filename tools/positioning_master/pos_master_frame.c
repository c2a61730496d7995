#include "pos_master_frame.h"

#include <string.h>

#include "modbus_crc.h"
#include "pos_table.h"

enum {
    BYTE_BITS = 8,
    AT_FIRST = 1,
    AT_COUNT = 3,
    BOTH_AT_FIRST = 5,
    BOTH_AT_COUNT = 7,
};

static void put_word(uint8_t *bytes, uint32_t word)
{
    bytes[0] = (uint8_t)(word >> (unsigned)BYTE_BITS);
    bytes[1] = (uint8_t)(word & UINT8_MAX);
}

static uint32_t word_at(const uint8_t *bytes, uint32_t place)
{
    return ((uint32_t)bytes[place] << (unsigned)BYTE_BITS) | bytes[place + 1U];
}

uint32_t pos_master_seal(uint8_t *frame, uint32_t length)
{
    uint16_t crc = MODBUS_CRC_START;
    for (uint32_t i = 0; i < length; i++) {
        crc = modbus_crc_append(crc, frame[i]);
    }
    frame[length] = (uint8_t)(crc & UINT8_MAX);
    frame[length + 1U] = (uint8_t)(crc >> (unsigned)BYTE_BITS);
    return length + (uint32_t)MODBUS_CRC_BYTES;
}

static void make_tcp(struct pos_master_frame *frame, uint8_t node, uint16_t number, const uint8_t *request,
                     uint32_t length)
{
    memset(frame->bytes, 0, POS_MASTER_TCP_HEAD_BYTES);
    put_word(frame->bytes, number);
    put_word(frame->bytes + POS_MASTER_TCP_AT_LENGTH, length + (uint32_t)MODBUS_ADDRESS_BYTES);
    frame->bytes[POS_MASTER_TCP_AT_NODE] = node;
    memcpy(frame->bytes + POS_MASTER_TCP_HEAD_BYTES, request, length);
    frame->length = length + (uint32_t)POS_MASTER_TCP_HEAD_BYTES;
}

void pos_master_frame_make(struct pos_master_frame *frame, uint8_t node, uint16_t number, const uint8_t *request,
                           uint32_t length)
{
    if (frame->tcp) {
        make_tcp(frame, node, number, request, length);
        return;
    }
    frame->bytes[0] = node;
    memcpy(frame->bytes + MODBUS_ADDRESS_BYTES, request, length);
    frame->length = pos_master_seal(frame->bytes, length + (uint32_t)MODBUS_ADDRESS_BYTES);
}

static bool is_store_in(uint32_t first, uint32_t count)
{
    uint32_t store = pos_unit_rows[POS_UNIT_STORE].number;
    return first <= store && store < first + count;
}

static bool writes_store(const uint8_t *request, uint32_t length)
{
    switch (request[0]) {
    case MODBUS_WRITE_ONE:
        return length > (uint32_t)AT_COUNT && is_store_in(word_at(request, AT_FIRST), 1);
    case MODBUS_WRITE:
        return length > (uint32_t)AT_COUNT + 1U && is_store_in(word_at(request, AT_FIRST), word_at(request, AT_COUNT));
    case MODBUS_WRITE_AND_READ:
        return length > (uint32_t)BOTH_AT_COUNT + 1U &&
               is_store_in(word_at(request, BOTH_AT_FIRST), word_at(request, BOTH_AT_COUNT));
    default:
        return false;
    }
}

uint32_t pos_master_more_ms(const uint8_t *request, uint32_t length)
{
    return writes_store(request, length) ? (uint32_t)POS_MASTER_STORE_MS : 0U;
}
