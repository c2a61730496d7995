/*
 * Message to answer, on a whole unit: every request has the one answer that its number and its motor call for, a
 * refused text changes nothing, and the judge has nothing to say of what moves meanwhile.
 *
 * Input: the epoch (2 bits) | messages: a byte of time in units of 2 ms (its low 3 bits; the others are inputs) | the
 * bytes of the message up to a 0. The mutator writes commands of the table into them. As the answer does not pass the
 * line, no frame is needed.
 */
#include <string.h>

#include "base_tick.h"
#include "fuzz_commands.h"
#include "fuzz_stream.h"
#include "fuzz_unit_bench.h"
#include "program_parser.h"
#include "messages_status.h"

enum {
    MESSAGES_MAX = 24,
    FLAG_NONE = 0,
    FLAG_VALUE = 1,
    FLAG_UNKNOWN = 2,
    FLAG_OVERFLOW = 3
};
enum {
    VERSION_BYTES = 16,
    STATUS_BYTES = 102
};

struct reply {
    const uint8_t *request;
    uint32_t length;
    const uint8_t *bytes;
    uint32_t bytes_length;
};

static bool starts_with(const struct reply *reply, uint8_t first, uint8_t second)
{
    return reply->bytes_length >= 2 && reply->bytes[0] == first && reply->bytes[1] == second;
}

/* A text is taken or refused by what an own reading of it says. */
static void check_set_command(const struct reply *reply)
{
    struct program_summary summary = program_check(reply->request + 2, reply->length - 2U);
    uint8_t flag = reply->bytes[2];
    FUZZ_REQUIRE(reply->bytes_length == 4);
    if (summary.status == PROGRAM_OK) {
        FUZZ_REQUIRE((flag == FLAG_NONE || flag == FLAG_OVERFLOW) && reply->bytes[3] == 0);
    } else {
        FUZZ_REQUIRE(flag == (summary.status == PROGRAM_BAD_VALUE ? FLAG_VALUE : FLAG_UNKNOWN));
        FUZZ_REQUIRE(reply->bytes[3] == summary.character);
        FUZZ_REQUIRE(memchr(reply->request + 2, summary.character, reply->length - 2U) != NULL);
    }
}

/* Numbers of ten characters or more, as the axes have them. */
static void check_positions(const struct fuzz_unit *fuzz, const struct reply *reply, unsigned first, unsigned last)
{
    uint32_t at = 2;
    for (unsigned motor = first; motor < last; motor++) {
        int64_t value = 0;
        FUZZ_REQUIRE(at < reply->bytes_length);
        uint32_t end = at + 1U + reply->bytes[at];
        FUZZ_REQUIRE(end <= reply->bytes_length && reply->bytes[at] >= 10);
        bool negative = memchr(reply->bytes + at + 1, '-', reply->bytes[at]) != NULL;
        for (at++; at < end; at++) {
            uint8_t digit = reply->bytes[at];
            FUZZ_REQUIRE(digit == ' ' || digit == '-' || (digit >= '0' && digit <= '9'));
            value = digit >= '0' ? value * 10 + (digit - '0') : value;
        }
        FUZZ_REQUIRE((negative ? -value : value) == axis_position_steps(&fuzz->unit.axis[motor]));
    }
    FUZZ_REQUIRE(at == reply->bytes_length);
}

static void check_of_motors(const struct fuzz_unit *fuzz, const struct reply *reply)
{
    uint8_t number = reply->request[0];
    unsigned motor = (unsigned)(reply->request[1] - '0');
    bool single = number >= MESSAGES_GET_COMMAND;
    FUZZ_REQUIRE(starts_with(reply, number, reply->request[1]));
    if (single && motor == 0) {
        FUZZ_REQUIRE(reply->bytes_length == 17 && memcmp(reply->bytes + 2, "ERROR COMMAND! ", 15) == 0);
    } else if (number == MESSAGES_SET_COMMAND) {
        check_set_command(reply);
    } else if (number == MESSAGES_STORE_FLASH) {
        FUZZ_REQUIRE(reply->bytes_length == 3 && reply->bytes[2] == STORE_OK);
    } else if (number == MESSAGES_GET_POSITION) {
        check_positions(fuzz, reply, motor == 0 ? 0 : motor - 1U, motor == 0 ? 4U : motor);
    } else if (number == MESSAGES_GET_COMMAND) {
        struct program_summary summary = program_check(reply->bytes + 2, reply->bytes_length - 2U);
        FUZZ_REQUIRE(summary.status == PROGRAM_OK && summary.commands <= PROGRAM_COMMANDS_MAX);
    } else {
        FUZZ_REQUIRE(memchr(reply->bytes, ';', reply->bytes_length) != NULL);
    }
}

static void check_answer(const struct fuzz_unit *fuzz, const struct reply *reply)
{
    uint8_t number = reply->request[0];
    bool named = reply->length >= 2 && reply->request[1] >= '0' && reply->request[1] <= '4';
    if (number == MESSAGES_VERSION) {
        FUZZ_REQUIRE(reply->bytes_length == 2 + VERSION_BYTES && starts_with(reply, number, VERSION_BYTES));
    } else if (number == MESSAGES_GET_STATUS) {
        FUZZ_REQUIRE(reply->bytes_length == STATUS_BYTES && starts_with(reply, number, MESSAGES_STATUS_LAYOUT));
    } else if (number > MESSAGES_GET_PROGRESS || (!named && number != MESSAGES_SET_COMMAND)) {
        FUZZ_REQUIRE(reply->bytes_length == 4 && starts_with(reply, MESSAGES_UNKNOWN, number));
    } else if (!named) {
        FUZZ_REQUIRE(reply->bytes_length == 4 && reply->bytes[2] == FLAG_VALUE);
    } else {
        check_of_motors(fuzz, reply);
    }
}

static uint64_t written_of_all(const struct fuzz_unit *fuzz)
{
    uint64_t sum = 0;
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        const struct interpreter *interpreter = &fuzz->unit.interpreter[i];
        sum = sum * 1000003U + interpreter->memory.written * 16U + interpreter->state;
    }
    return sum;
}

static void do_message(struct fuzz_unit *fuzz, const uint8_t *message, uint32_t length)
{
    uint64_t before = written_of_all(fuzz);
    uint32_t answered = rkm04_message(&fuzz->unit, message, length, fuzz->answer);
    struct reply reply = {.request = message, .length = length, .bytes = fuzz->answer, .bytes_length = answered};
    FUZZ_REQUIRE(answered <= MESSAGES_ANSWER_BYTES_MAX);
    judge_exchange(&fuzz->judge, length == 0 ? 0 : 1, answered == 0 ? 0 : 1);
    if (length != 0) {
        check_answer(fuzz, &reply);
    }
    bool taken = length != 0 && message[0] == MESSAGES_SET_COMMAND &&
                 (fuzz->answer[2] == FLAG_NONE || fuzz->answer[2] == FLAG_OVERFLOW);
    FUZZ_REQUIRE(taken || written_of_all(fuzz) == before);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_stream stream = fuzz_stream_of(data, size);
    struct fuzz_unit *fuzz = fuzz_unit_begin(fuzz_take_byte(&stream));
    for (unsigned i = 0; i < MESSAGES_MAX && !fuzz_stream_is_over(&stream); i++) {
        uint8_t head = fuzz_take_byte(&stream);
        host_machine_set_input(&fuzz->machine, 1U + head / 8U % 8U, head / 64U % 2U != 0);
        size_t length = 0;
        const uint8_t *message = fuzz_take_text(&stream, &length);
        do_message(fuzz, message, (uint32_t)length);
        fuzz_unit_run(fuzz, (uint64_t)(head % 8U) * 2U * TICKS_PER_MS);
    }
    fuzz_unit_end(fuzz);
    return 0;
}

/* Commands, and the beginnings of messages that can have some. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    size = LLVMFuzzerMutate(data, size, max_size);
    if (seed % 4U == 0) {
        const uint8_t begin[] = {0, (uint8_t)(seed >> 20U), (uint8_t)(1U + (seed >> 16U) % 8U),
                                 (uint8_t)('0' + (seed >> 12U) % 5U)};
        return fuzz_insert(data, size, max_size, 1, seed / 4U, begin, sizeof begin);
    }
    return seed % 4U == 1 ? size : fuzz_insert_command(data, size, max_size, 1, seed / 4U);
}
