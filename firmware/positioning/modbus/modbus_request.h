/*
 * A request: what a frame without its address and CRC asks for, as numbers. Pure; may be called from anywhere.
 *
 * It is known here what a request looks like, not which registers there are.
 */
#ifndef MODBUS_REQUEST_H
#define MODBUS_REQUEST_H

#include <stdbool.h>
#include <stdint.h>

#include "modbus_frame.h"

/* Writes come before reads. No range of a request need be there: of 65 535 and 2 registers one is not. */
struct modbus_request {
    uint64_t end_tick;    /* the end of its last byte; filled in by the server */
    uint16_t write_first; /* number of the first register that is written */
    uint16_t write_count; /* 0: nothing is written */
    uint16_t read_first;
    uint16_t read_count;               /* 0: nothing is read */
    uint16_t values[MODBUS_WRITE_MAX]; /* write_count of them */
    uint8_t function;                  /* enum modbus_function */
    bool broadcast;                    /* filled in by the server */
};

/* Reads a request from `length` bytes, at least the function. An exception: FUNCTION or VALUE; the request then holds
 * nothing but the function. MODBUS_IDENTIFY is not read here. */
enum modbus_exception modbus_request_read(struct modbus_request *request, const uint8_t *bytes, uint32_t length);

/* What a unit tells of itself, each at most 80 characters: objects 0 to 2 of the identification. */
enum {
    MODBUS_OBJECTS = 3,
};

struct modbus_identity {
    const char *objects[MODBUS_OBJECTS]; /* VendorName, ProductCode, MajorMinorRevision */
};

/* Room for the answer to MODBUS_IDENTIFY from the function on. */
enum {
    MODBUS_OBJECT_CHARACTERS_MAX = 80,
    MODBUS_IDENTITY_BYTES_MAX = 7 + (MODBUS_OBJECTS * (2 + MODBUS_OBJECT_CHARACTERS_MAX)),
};

static_assert(MODBUS_ADDRESS_BYTES + MODBUS_IDENTITY_BYTES_MAX + MODBUS_CRC_BYTES <= MODBUS_FRAME_BYTES_MAX,
              "all objects fit into one answer");

/* Answers MODBUS_IDENTIFY: puts the answer from the function on into MODBUS_IDENTITY_BYTES_MAX bytes and sets *put to
 * how many they are. An exception: FUNCTION, VALUE or ADDRESS; then nothing is set. */
enum modbus_exception modbus_identity_answer(const struct modbus_identity *identity, const uint8_t *bytes,
                                             uint32_t length, uint8_t *answer, uint32_t *put);

#endif
