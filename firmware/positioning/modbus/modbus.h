/*
 * The Modbus RTU server of a unit: bytes of the line in, requests to read and write registers out to be executed;
 * values or an exception in, bytes for the line out.
 *
 * It knows frames and requests (line.md), nothing of what registers mean. What is wrong in the form it refuses itself,
 * and it tells by itself what the unit is. Nothing here waits: main gives it what has come and the time. It listens or
 * sends, never both. Main only. 880 bytes.
 *
 * In each pass, unless it is sending:
 *
 *     for each byte that has come:    modbus_take, then what modbus_next has
 *     modbus_poll, then what modbus_next has; was there something, the next pass comes at once
 */
#ifndef MODBUS_H
#define MODBUS_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_line.h"
#include "modbus_frame.h"
#include "modbus_receiver.h"
#include "modbus_request.h"

/* What the server has seen. A frame that is dropped counts once, as the first of BROKEN, LENGTH, CRC. X(NAME, text) */
#define MODBUS_COUNTS(X)                                                                                               \
    X(FRAMES, "good frames for this unit, broadcasts included")                                                        \
    X(FOREIGN, "good frames for others")                                                                               \
    X(BROKEN, "frames with a byte with a parity, framing or overrun error")                                            \
    X(CRC, "frames with a wrong CRC")                                                                                  \
    X(LENGTH, "frames that were too short or too long")                                                                \
    X(PAUSES, "good frames with a pause inside")                                                                       \
    X(EXCEPTIONS, "requests that were refused, broadcasts included")                                                   \
    X(UNSENT, "answers not begun, as a byte came before or it was too late")

enum modbus_count {
#define X(name, text) MODBUS_COUNT_##name,
    MODBUS_COUNTS(X)
#undef X
    MODBUS_COUNTS_TOTAL
};

struct modbus_setup {
    uint64_t start_tick;     /* from then on the bus is watched for a first silence */
    uint32_t rate_bd;        /* 9600 to 115 200 */
    uint32_t character_bits; /* 10, or 11 with a parity bit or a second stop bit */
    struct modbus_identity identity;
    uint8_t node; /* 1 to MODBUS_NODE_MAX */
};

struct modbus {
    struct modbus_request request;
    struct modbus_identity identity;
    uint64_t heard_tick;     /* the end of the last good frame to this unit's own address; 0: there was none */
    uint64_t patience_ticks; /* of the request in hand */
    uint32_t counts[MODBUS_COUNTS_TOTAL]; /* modulo 2^32 */
    uint16_t length;                      /* bytes of the answer */
    uint16_t place;                       /* of the one that is to go out next */
    uint8_t state;
    uint8_t node;
    bool owed; /* an answer to the request in hand may still begin */
    struct modbus_receiver receiver;
    uint8_t answer[MODBUS_FRAME_BYTES_MAX];
};

/* Nothing is taken before a silence; all counts are 0. */
void modbus_init(struct modbus *server, const struct modbus_setup *setup);

/* Takes one byte; not while sending. An answer that has not begun is given up. */
void modbus_take(struct modbus *server, const struct hal_line_byte *byte);

/* Sees silence, and begins an answer that is due. Returns when to call again at the latest; TICK_NEVER: not before the
 * next byte or answer. All bytes that have come must have been taken; quiet: none has begun since. */
uint64_t modbus_poll(struct modbus *server, uint64_t now_ticks, bool quiet);

/* The request that is to be executed; NULL: there is none. To be asked after each modbus_take and each modbus_poll. It
 * holds until the next call of those. Who still has the one before must not answer that any more. */
const struct modbus_request *modbus_next(struct modbus *server);

/* The answer may begin that long after the last byte of the request, instead of MODBUS_PATIENCE_TICKS. */
void modbus_allow(struct modbus *server, uint64_t patience_ticks);

/* The request has been executed. `values` are those of the registers that it reads, read_count of them, NULL where it
 * reads none. A broadcast is answered, too, and nothing goes out. */
void modbus_answer(struct modbus *server, const uint16_t *values);

/* The request has not been executed, and has changed nothing. */
void modbus_refuse(struct modbus *server, enum modbus_exception exception);

/* Whether there is a byte to be sent; that byte; and past it. */
bool modbus_is_sending(const struct modbus *server);
uint8_t modbus_byte(const struct modbus *server);
void modbus_advance(struct modbus *server);

/* The text of a count, for people. */
const char *modbus_count_text(enum modbus_count count);

#endif
