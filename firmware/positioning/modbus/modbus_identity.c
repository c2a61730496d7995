#include "modbus_request.h"

#include <string.h>

/* Bytes of the request, and of the answer, from the function on. */
enum {
    AT_TYPE = 1,
    AT_CODE = 2,
    AT_OBJECT = 3, /* of the request */
    REQUEST_BYTES = 4,

    AT_CONFORMITY = 3,
    AT_MORE = 4,
    AT_NEXT = 5,
    AT_COUNT = 6,
    AT_OBJECTS = 7,
};

enum {
    TYPE_IDENTIFICATION = 14,
    CONFORMITY = 0x81, /* the basic objects, all at once or one by one */
    CODE_BASIC = 1,    /* from an object on; 2 and 3 would tell more, were there more */
    CODE_EXTENDED = 3,
    CODE_ONE = 4,
};

/* The objects that are asked for: from `first` up to `end`. */
struct objects {
    uint32_t first;
    uint32_t end;
};

static enum modbus_exception read_objects(const uint8_t *bytes, uint32_t length, struct objects *objects)
{
    if (length > (uint32_t)AT_TYPE && bytes[AT_TYPE] != (uint8_t)TYPE_IDENTIFICATION) {
        return MODBUS_EXCEPTION_FUNCTION;
    }
    if (length != (uint32_t)REQUEST_BYTES) {
        return MODBUS_EXCEPTION_VALUE;
    }
    uint8_t code = bytes[AT_CODE];
    uint8_t object = bytes[AT_OBJECT];
    bool known = object < (uint8_t)MODBUS_OBJECTS;
    if (code >= (uint8_t)CODE_BASIC && code <= (uint8_t)CODE_EXTENDED) {
        *objects = (struct objects){.first = known ? object : 0U, .end = MODBUS_OBJECTS};
        return MODBUS_EXCEPTION_NONE;
    }
    if (code == (uint8_t)CODE_ONE) {
        *objects = (struct objects){.first = object, .end = (uint32_t)object + 1U};
        return known ? MODBUS_EXCEPTION_NONE : MODBUS_EXCEPTION_ADDRESS;
    }
    return MODBUS_EXCEPTION_VALUE;
}

/* Returns the place after it. */
static uint32_t put_object(const struct modbus_identity *identity, uint32_t object, uint8_t *answer, uint32_t place)
{
    const char *text = identity->objects[object];
    uint32_t length = 0;
    for (; text[length] != '\0'; length++) {
        answer[place + 2U + length] = (uint8_t)text[length];
    }
    assert(length <= (uint32_t)MODBUS_OBJECT_CHARACTERS_MAX);
    answer[place] = (uint8_t)object;
    answer[place + 1U] = (uint8_t)length;
    return place + 2U + length;
}

enum modbus_exception modbus_identity_answer(const struct modbus_identity *identity, const uint8_t *bytes,
                                             uint32_t length, uint8_t *answer, uint32_t *put)
{
    struct objects objects;
    enum modbus_exception exception = read_objects(bytes, length, &objects);
    if (exception != MODBUS_EXCEPTION_NONE) {
        return exception;
    }
    uint32_t place = AT_OBJECTS;
    memcpy(answer, bytes, AT_CONFORMITY);
    answer[AT_CONFORMITY] = CONFORMITY;
    answer[AT_MORE] = 0;
    answer[AT_NEXT] = 0;
    answer[AT_COUNT] = (uint8_t)(objects.end - objects.first);
    for (uint32_t object = objects.first; object < objects.end; object++) {
        place = put_object(identity, object, answer, place);
    }
    *put = place;
    return MODBUS_EXCEPTION_NONE;
}
