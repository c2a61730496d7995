#include "messages.h"

#include <assert.h>
#include <stdbool.h>
#include <stddef.h>
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

static_assert(MESSAGES_ANSWER_BYTES_MAX >= 16 + MOTION_CORNERS_MAX * CORNER_BYTES_MAX, "break points must fit");
static_assert(MESSAGES_ANSWER_BYTES_MAX >= 2 + PROGRAM_COMMANDS_MAX * PROGRAM_COMMAND_BYTES_MAX, "a program must fit");
static_assert(MESSAGES_ANSWER_BYTES_MAX >= 2 + UNIT_MOTORS * (1 + POSITION_BYTES_MAX), "positions must fit");
static_assert((uint32_t)PROGRAM_COMMANDS_MAX * PROGRAM_COMMAND_BYTES_MAX <= (uint32_t)STORE_TEXT_BYTES_MAX,
              "a program can be stored");
static_assert(STORE_WRITE_FAILED == 1 && STORE_TOO_LONG == 2, "errors of Store Flash are numbered in messages.md");
static_assert(FLAG_VALUE == -PROGRAM_BAD_VALUE, "the flags of Set Command are the parser's errors");

/* A request and the answer on its way. */
struct exchange {
    struct messages *messages;
    const uint8_t *request;
    uint32_t length;
    struct text answer;
    uint64_t now_ticks;
    unsigned first; /* the motors that a request names, from 0: first to last - 1 */
    unsigned last;
};

/* Puts a byte for the length of what follows, and says where; end_counted fills it in. */
static uint32_t begin_counted(struct text *answer)
{
    uint32_t at = answer->length;
    text_put_byte(answer, 0);
    return at;
}

static void end_counted(struct text *answer, uint32_t at)
{
    answer->bytes[at] = (uint8_t)(answer->length - at - 1U);
}

static void answer_version(struct exchange *exchange)
{
    uint32_t at = begin_counted(&exchange->answer);
    text_put_string(&exchange->answer, exchange->messages->version);
    end_counted(&exchange->answer, at);
}

static void answer_get_status(struct exchange *exchange)
{
    struct messages_status status;
    messages_status_read(&status, exchange->messages->interpreters, exchange->messages->shared);
    memcpy(status.line_counts, exchange->messages->line_counts, sizeof status.line_counts);
    messages_status_put(&status, &exchange->answer);
}

static void answer_unknown(struct exchange *exchange)
{
    text_put_byte(&exchange->answer, MESSAGES_UNKNOWN);
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
        struct interpreter *interpreter = &exchange->messages->interpreters[motor];
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
    struct messages *messages = exchange->messages;
    uint8_t *program = exchange->answer.bytes + exchange->answer.length;
    enum store_error error = STORE_OK;

    for (unsigned motor = exchange->first; motor < exchange->last; motor++) {
        uint32_t length =
            interpreter_list(&messages->interpreters[motor], program, PROGRAM_COMMANDS_MAX * PROGRAM_COMMAND_BYTES_MAX);
        enum store_error saved = store_save(messages->store, motor, program, length);
        error = error == STORE_OK ? saved : error;
    }
    text_put_byte(&exchange->answer, (uint8_t)error);
}

static void answer_get_position(struct exchange *exchange)
{
    for (unsigned motor = exchange->first; motor < exchange->last; motor++) {
        uint32_t at = begin_counted(&exchange->answer);
        text_put_signed(&exchange->answer, interpreter_position_steps(&exchange->messages->interpreters[motor]),
                        POSITION_WIDTH);
        end_counted(&exchange->answer, at);
    }
}

static void answer_get_command(struct exchange *exchange)
{
    struct text *answer = &exchange->answer;
    answer->length += interpreter_list(&exchange->messages->interpreters[exchange->first],
                                       answer->bytes + answer->length, answer->capacity - answer->length);
}

static void answer_get_table(struct exchange *exchange)
{
    struct text *answer = &exchange->answer;
    struct motion_corner corners[MOTION_CORNERS_MAX];
    unsigned count = interpreter_corners(&exchange->messages->interpreters[exchange->first], corners);

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
    struct interpreter_progress now = interpreter_progress(&exchange->messages->interpreters[exchange->first]);

    text_put_unsigned(&exchange->answer, now.steps, STEPS_WIDTH);
    text_put_byte(&exchange->answer, ';');
    text_put_unsigned(&exchange->answer, now.command, PLACE_WIDTH);
}

/* What a message needs. */
enum {
    NAMES_MOTORS = 1,  /* the byte after the number is a motor, or 0 for all */
    ONE_MOTOR = 2,     /* and not all */
    FLAGS_A_MOTOR = 4, /* and a motor that there is not is told as a wrong value, not as an unknown message */
};

struct message {
    uint8_t number; /* enum messages_message */
    uint8_t needs;
    void (*answer)(struct exchange *exchange); /* puts what follows the number and the motor */
};

/* NULL: there is no such message. */
static const struct message *find_message(uint8_t number)
{
    static const struct message table[] = {
        {MESSAGES_VERSION, 0, answer_version},
        {MESSAGES_SET_COMMAND, NAMES_MOTORS | FLAGS_A_MOTOR, answer_set_command},
        {MESSAGES_STORE_FLASH, NAMES_MOTORS, answer_store_flash},
        {MESSAGES_GET_POSITION, NAMES_MOTORS, answer_get_position},
        {MESSAGES_GET_COMMAND, NAMES_MOTORS | ONE_MOTOR, answer_get_command},
        {MESSAGES_GET_TABLE, NAMES_MOTORS | ONE_MOTOR, answer_get_table},
        {MESSAGES_GET_PROGRESS, NAMES_MOTORS | ONE_MOTOR, answer_get_progress},
        {MESSAGES_GET_STATUS, 0, answer_get_status},
    };
    const struct message *found = NULL;
    for (unsigned i = 0; i < sizeof table / sizeof table[0] && found == NULL; i++) {
        found = table[i].number == number ? &table[i] : NULL;
    }
    return found;
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
    uint8_t motor = exchange->length < 2 ? 0 : exchange->request[1];
    text_put_byte(&exchange->answer, exchange->request[0]);
    text_put_byte(&exchange->answer, motor);
    text_put_byte(&exchange->answer, FLAG_VALUE);
    text_put_byte(&exchange->answer, motor);
}

static void answer_for_motors(struct exchange *exchange, const struct message *message)
{
    text_put_byte(&exchange->answer, message->number);
    text_put_byte(&exchange->answer, exchange->request[1]);
    if ((message->needs & ONE_MOTOR) != 0 && exchange->request[1] == '0' + MOTORS_ALL) {
        text_put_string(&exchange->answer, "ERROR COMMAND! ");
    } else {
        message->answer(exchange);
    }
}

static void answer_request(struct exchange *exchange)
{
    const struct message *message = find_message(exchange->request[0]);
    if (message == NULL) {
        answer_unknown(exchange);
    } else if ((message->needs & NAMES_MOTORS) == 0) {
        text_put_byte(&exchange->answer, message->number);
        message->answer(exchange);
    } else if (exchange_find_motors(exchange)) {
        answer_for_motors(exchange, message);
    } else if ((message->needs & FLAGS_A_MOTOR) != 0) {
        answer_wrong_motor(exchange);
    } else {
        answer_unknown(exchange);
    }
}

uint32_t messages_answer(struct messages *messages, const uint8_t *request, uint32_t length, uint64_t now_ticks,
                         uint8_t answer[MESSAGES_ANSWER_BYTES_MAX])
{
    struct exchange exchange = {.messages = messages, .request = request, .length = length, .now_ticks = now_ticks};

    text_init(&exchange.answer, answer, MESSAGES_ANSWER_BYTES_MAX);
    if (length == 0 || length > MESSAGES_REQUEST_BYTES_MAX) {
        return 0;
    }
    answer_request(&exchange);
    return exchange.answer.length;
}
