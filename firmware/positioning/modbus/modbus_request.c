#include "modbus_request.h"

/* Bytes of a request, from the function on. */
enum {
    AT_FIRST = 1,
    AT_COUNT = 3,
    ONE_BYTES = 5, /* READ, READ_INPUTS, WRITE_ONE */

    WRITE_AT_BYTES = 5,
    WRITE_AT_VALUES = 6,

    BOTH_AT_WRITE_FIRST = 5,
    BOTH_AT_WRITE_COUNT = 7,
    BOTH_AT_BYTES = 9,
    BOTH_AT_VALUES = 10,

    REGISTER_BYTES = 2,
    BYTE_BITS = 8,
};

static uint16_t word_at(const uint8_t *bytes, uint32_t place)
{
    return (uint16_t)(((uint32_t)bytes[place] << (unsigned)BYTE_BITS) | bytes[place + 1U]);
}

static bool is_count(uint16_t count, uint32_t most)
{
    return count != 0U && count <= most;
}

static bool read_one(struct modbus_request *request, const uint8_t *bytes, uint32_t length)
{
    if (length != (uint32_t)ONE_BYTES) {
        return false;
    }
    request->write_first = word_at(bytes, AT_FIRST);
    request->write_count = 1;
    request->values[0] = word_at(bytes, AT_COUNT);
    return true;
}

static bool read_read(struct modbus_request *request, const uint8_t *bytes, uint32_t length)
{
    if (length != (uint32_t)ONE_BYTES || !is_count(word_at(bytes, AT_COUNT), MODBUS_READ_MAX)) {
        return false;
    }
    request->read_first = word_at(bytes, AT_FIRST);
    request->read_count = word_at(bytes, AT_COUNT);
    return true;
}

/* The values of a request, the byte before them how many bytes they are; nothing comes after them. */
static bool read_values(struct modbus_request *request, const uint8_t *bytes, uint32_t length, uint32_t place)
{
    uint32_t values_bytes = (uint32_t)request->write_count * (uint32_t)REGISTER_BYTES;
    if (bytes[place - 1U] != values_bytes || length != place + values_bytes) {
        return false;
    }
    for (uint32_t i = 0; i < request->write_count; i++) {
        request->values[i] = word_at(bytes, place + (i * (uint32_t)REGISTER_BYTES));
    }
    return true;
}

static bool read_write(struct modbus_request *request, const uint8_t *bytes, uint32_t length)
{
    if (length <= (uint32_t)WRITE_AT_BYTES) {
        return false;
    }
    request->write_first = word_at(bytes, AT_FIRST);
    request->write_count = word_at(bytes, AT_COUNT);
    return is_count(request->write_count, MODBUS_WRITE_MAX) && read_values(request, bytes, length, WRITE_AT_VALUES);
}

static bool read_both(struct modbus_request *request, const uint8_t *bytes, uint32_t length)
{
    if (length <= (uint32_t)BOTH_AT_BYTES) {
        return false;
    }
    request->read_first = word_at(bytes, AT_FIRST);
    request->read_count = word_at(bytes, AT_COUNT);
    request->write_first = word_at(bytes, BOTH_AT_WRITE_FIRST);
    request->write_count = word_at(bytes, BOTH_AT_WRITE_COUNT);
    return is_count(request->read_count, MODBUS_READ_MAX) && is_count(request->write_count, MODBUS_WRITE_READ_MAX) &&
           read_values(request, bytes, length, BOTH_AT_VALUES);
}

enum modbus_exception modbus_request_read(struct modbus_request *request, const uint8_t *bytes, uint32_t length)
{
    bool good = false;
    *request = (struct modbus_request){.function = bytes[0]};
    switch (bytes[0]) {
    case MODBUS_READ:
    case MODBUS_READ_INPUTS:
        good = read_read(request, bytes, length);
        break;
    case MODBUS_WRITE_ONE:
        good = read_one(request, bytes, length);
        break;
    case MODBUS_WRITE:
        good = read_write(request, bytes, length);
        break;
    case MODBUS_WRITE_AND_READ:
        good = read_both(request, bytes, length);
        break;
    default:
        return MODBUS_EXCEPTION_FUNCTION;
    }
    return good ? MODBUS_EXCEPTION_NONE : MODBUS_EXCEPTION_VALUE;
}
