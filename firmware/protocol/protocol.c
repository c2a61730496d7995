#include "protocol.h"

#include <assert.h>
#include <stdbool.h>
#include <string.h>

#include "base_text.h"
#include "program_memory.h"
#include "program_parser.h"

enum {
    MOTORS_ALL = 0, /* the motor number that means all of them */
    POSITION_WIDTH = 10,
    POSITION_BYTES_MAX = 20,
    COUNT_WIDTH = 3,
    STEPS_WIDTH = 6,
    PLACE_WIDTH = 2,
    CORNER_BYTES_MAX = 24, /* "(17592186044416;16000)," */
    FLAG_VALUE = 1,
    FLAG_OVERFLOW = 3,
};

static_assert(PROTOCOL_ANSWER_BYTES_MAX >= 16 + MOTION_CORNERS_MAX * CORNER_BYTES_MAX, "break points must fit");
static_assert(PROTOCOL_ANSWER_BYTES_MAX >= 2 + PROGRAM_COMMANDS_MAX * PROGRAM_COMMAND_BYTES_MAX, "a program must fit");
static_assert(PROTOCOL_ANSWER_BYTES_MAX >= 2 + UNIT_MOTORS * (1 + POSITION_BYTES_MAX), "positions must fit");
static_assert(FLAG_VALUE == -PROGRAM_BAD_VALUE, "the flags of Set Command are the parser's errors");

/* A request that names its motor, and the answer on its way. */
struct exchange {
    struct protocol *protocol;
    const uint8_t *request;
    uint32_t length;
    struct text answer;
    uint64_t now_ticks;
    unsigned first; /* the motors that are named, from 0: first to last - 1 */
    unsigned last;
};

static void put_length_and_signed(struct text *answer, int64_t value)
{
    uint8_t bytes[POSITION_BYTES_MAX];
    struct text decimal;

    text_init(&decimal, bytes, sizeof bytes);
    text_put_signed(&decimal, value, POSITION_WIDTH);
    text_put_byte(answer, (uint8_t)decimal.length);
    for (uint32_t i = 0; i < decimal.length; i++) {
        text_put_byte(answer, bytes[i]);
    }
}

static void answer_version(struct exchange *exchange)
{
    text_put_byte(&exchange->answer, PROTOCOL_VERSION);
    text_put_byte(&exchange->answer, (uint8_t)strlen(exchange->protocol->version));
    text_put_string(&exchange->answer, exchange->protocol->version);
}

static void answer_get_status(struct exchange *exchange)
{
    struct protocol_status status;
    protocol_status_read(&status, exchange->protocol->interpreters);
    memcpy(status.line_counts, exchange->protocol->line_counts, sizeof status.line_counts);
    text_put_byte(&exchange->answer, PROTOCOL_GET_STATUS);
    protocol_status_put(&status, &exchange->answer);
}

static void answer_unknown(struct exchange *exchange)
{
    text_put_byte(&exchange->answer, PROTOCOL_UNKNOWN);
    text_put_byte(&exchange->answer, exchange->request[0]);
    text_put_byte(&exchange->answer, 0);
    text_put_byte(&exchange->answer, 0);
}

/* Gives a good text to the motors that are named. True if one of their memories has overflowed. */
static bool take_text(struct exchange *exchange, const uint8_t *text, uint32_t length,
                      const struct program_summary *summary)
{
    bool overflow = false;
    for (unsigned motor = exchange->first; motor < exchange->last; motor++) {
        struct interpreter *interpreter = &exchange->protocol->interpreters[motor];
        overflow = interpreter_take(interpreter, text, length, summary, exchange->now_ticks) || overflow;
    }
    return overflow;
}

static void answer_set_command(struct exchange *exchange)
{
    const uint8_t *text = exchange->request + 2;
    uint32_t length = exchange->length - 2U;
    struct program_summary summary = program_check(text, length);
    uint8_t flag = (uint8_t)-(int)summary.status;

    if (summary.status == PROGRAM_OK && take_text(exchange, text, length, &summary)) {
        flag = FLAG_OVERFLOW;
    }
    text_put_byte(&exchange->answer, flag);
    text_put_byte(&exchange->answer, summary.character);
}

/* The answer's buffer holds each program on its way to the store. */
static void answer_store_flash(struct exchange *exchange)
{
    struct protocol *protocol = exchange->protocol;
    uint8_t *program = exchange->answer.bytes + exchange->answer.length;
    enum store_error error = STORE_OK;

    for (unsigned motor = exchange->first; motor < exchange->last; motor++) {
        uint32_t length = program_memory_list(&protocol->interpreters[motor].memory, program,
                                              PROGRAM_COMMANDS_MAX * PROGRAM_COMMAND_BYTES_MAX);
        enum store_error saved = store_save(protocol->store, motor, program, length);
        error = error == STORE_OK ? saved : error;
    }
    text_put_byte(&exchange->answer, (uint8_t)error);
}

static void answer_get_position(struct exchange *exchange)
{
    for (unsigned motor = exchange->first; motor < exchange->last; motor++) {
        const struct mover *mover = exchange->protocol->interpreters[motor].mover;
        put_length_and_signed(&exchange->answer, mover_position_steps(mover));
    }
}

static void answer_get_command(struct exchange *exchange)
{
    struct text *answer = &exchange->answer;
    answer->length += program_memory_list(&exchange->protocol->interpreters[exchange->first].memory,
                                          answer->bytes + answer->length, answer->capacity - answer->length);
}

static void answer_get_table(struct exchange *exchange)
{
    struct text *answer = &exchange->answer;
    struct motion_corner corners[MOTION_CORNERS_MAX];
    unsigned count = mover_corners(exchange->protocol->interpreters[exchange->first].mover, corners);

    text_put_unsigned(answer, count, COUNT_WIDTH);
    text_put_string(answer, ";[");
    for (unsigned i = 0; i < count; i++) {
        text_put_string(answer, i == 0 ? "(" : ",(");
        text_put_unsigned(answer, corners[i].step, 1);
        text_put_byte(answer, ';');
        text_put_unsigned(answer, corners[i].speed_steps_per_s, 1);
        text_put_byte(answer, ')');
    }
    text_put_byte(answer, ']');
}

static void answer_get_progress(struct exchange *exchange)
{
    const struct interpreter *interpreter = &exchange->protocol->interpreters[exchange->first];
    bool moving = mover_is_moving(interpreter->mover);

    text_put_unsigned(&exchange->answer, moving ? mover_steps_made(interpreter->mover) : 0, STEPS_WIDTH);
    text_put_byte(&exchange->answer, ';');
    text_put_unsigned(&exchange->answer, interpreter->place, PLACE_WIDTH);
}

/* Finds out which motors a request names. False: none, or one that there is not. */
static bool exchange_find_motors(struct exchange *exchange)
{
    if (exchange->length < 2 || exchange->request[1] < '0' || exchange->request[1] > '0' + UNIT_MOTORS) {
        return false;
    }
    unsigned number = (unsigned)(exchange->request[1] - '0');
    exchange->first = number == MOTORS_ALL ? 0U : number - 1U;
    exchange->last = number == MOTORS_ALL ? (unsigned)UNIT_MOTORS : number;
    return true;
}

static void answer_wrong_motor(struct exchange *exchange)
{
    if (exchange->request[0] != PROTOCOL_SET_COMMAND) {
        answer_unknown(exchange);
        return;
    }
    uint8_t motor = exchange->length < 2 ? 0 : exchange->request[1];
    text_put_byte(&exchange->answer, PROTOCOL_SET_COMMAND);
    text_put_byte(&exchange->answer, motor);
    text_put_byte(&exchange->answer, FLAG_VALUE);
    text_put_byte(&exchange->answer, motor);
}

static void answer_for_motors(struct exchange *exchange)
{
    uint8_t number = exchange->request[0];
    bool single = number == PROTOCOL_GET_COMMAND || number == PROTOCOL_GET_TABLE || number == PROTOCOL_GET_PROGRESS;

    text_put_byte(&exchange->answer, number);
    text_put_byte(&exchange->answer, exchange->request[1]);
    if (single && exchange->request[1] == '0' + MOTORS_ALL) {
        text_put_string(&exchange->answer, "ERROR COMMAND! ");
    } else if (number == PROTOCOL_SET_COMMAND) {
        answer_set_command(exchange);
    } else if (number == PROTOCOL_STORE_FLASH) {
        answer_store_flash(exchange);
    } else if (number == PROTOCOL_GET_POSITION) {
        answer_get_position(exchange);
    } else if (number == PROTOCOL_GET_COMMAND) {
        answer_get_command(exchange);
    } else if (number == PROTOCOL_GET_TABLE) {
        answer_get_table(exchange);
    } else {
        answer_get_progress(exchange);
    }
}

uint32_t protocol_answer(struct protocol *protocol, const uint8_t *request, uint32_t length, uint64_t now_ticks,
                         uint8_t answer[PROTOCOL_ANSWER_BYTES_MAX])
{
    struct exchange exchange = {.protocol = protocol, .request = request, .length = length, .now_ticks = now_ticks};

    text_init(&exchange.answer, answer, PROTOCOL_ANSWER_BYTES_MAX);
    if (length == 0 || length > PROTOCOL_REQUEST_BYTES_MAX) {
        return 0;
    }
    if (request[0] == PROTOCOL_VERSION) {
        answer_version(&exchange);
    } else if (request[0] == PROTOCOL_GET_STATUS) {
        answer_get_status(&exchange);
    } else if (request[0] < PROTOCOL_VERSION || request[0] > PROTOCOL_GET_PROGRESS) {
        answer_unknown(&exchange);
    } else if (!exchange_find_motors(&exchange)) {
        answer_wrong_motor(&exchange);
    } else {
        answer_for_motors(&exchange);
    }
    return exchange.answer.length;
}
