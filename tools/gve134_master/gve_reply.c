#include "gve_reply.h"

#include <assert.h>
#include <string.h>

#include "gve_float.h"

enum {
    INTERPOLATOR = '0',
    SPINDLE = '7',
    SUM_DIGITS = 2,
    SUM_BYTES = SUM_DIGITS + 1, /* with its comma */
    BYTE_DIGITS = 2,
    WORD_DIGITS = 8,
    NUMBER_DIGITS_MAX = 3,
    VECTOR_NUMBERS = 4,
    INTA_BIT = GVE_INTA,
    NO_DIGIT = 16,
};

/* A command without its address. */
struct addressed {
    uint8_t digit;
    const uint8_t *text;
    uint32_t length;
};

static struct addressed addressed(const uint8_t *text, uint32_t length)
{
    if (length >= 2 && text[0] == '!') {
        return (struct addressed){.digit = text[1], .text = text + 2, .length = length - 2};
    }
    return (struct addressed){.digit = INTERPOLATOR, .text = text, .length = length};
}

static struct gve_reading reading_of(struct addressed command)
{
    enum gve_address to = command.digit == SPINDLE ? GVE_ADDRESS_SPINDLE : GVE_ADDRESS_INTERPOLATOR;
    if (command.length > GVE_TEXT_BYTES_MAX) {
        return (struct gve_reading){.command.opcode = GVE_OPCODES, .fault = GVE_FAULT_TOO_LONG};
    }
    return gve_command_read(command.text, command.length, to);
}

static void put_capitals(struct text *out, struct addressed command)
{
    for (uint32_t i = 0; i < command.length; i++) {
        uint8_t byte = command.text[i];
        text_put_byte(out, byte >= 'a' && byte <= 'z' ? (uint8_t)(byte - 'a' + 'A') : byte);
    }
}

static void put_numbers_left_out(struct text *out, const struct gve_reading *reading)
{
    unsigned opcode = reading->command.opcode;
    if (reading->fault == GVE_FAULT_NONE && (opcode == (unsigned)GVE_LINE || opcode == (unsigned)GVE_CONTINUE)) {
        for (uint32_t numbers = reading->command.count; numbers < VECTOR_NUMBERS; numbers++) {
            text_put_string(out, ",0");
        }
    }
}

static uint32_t sum_of(const uint8_t *bytes, uint32_t length)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < length; i++) {
        sum += bytes[i];
    }
    return sum & UINT8_MAX;
}

void gve_reply_put_command(struct text *out, const uint8_t *text, uint32_t length, bool sums)
{
    struct addressed command = addressed(text, length);
    struct gve_reading reading = reading_of(command);
    uint32_t begin = out->length;
    text_put_byte(out, '!');
    text_put_byte(out, command.digit);
    put_capitals(out, command);
    put_numbers_left_out(out, &reading);
    if (sums) {
        text_put_byte(out, ',');
        text_put_hex(out, sum_of(out->bytes + begin, out->length - begin), SUM_DIGITS);
    }
    text_put_byte(out, '\r');
}

struct gve_reading gve_reply_reading(const uint8_t *text, uint32_t length)
{
    return reading_of(addressed(text, length));
}

unsigned gve_reply_opcode(const uint8_t *text, uint32_t length)
{
    return gve_reply_reading(text, length).command.opcode;
}

enum gve_values gve_reply_values(unsigned opcode)
{
    static const uint8_t values[GVE_OPCODES + 1] = {
        [GVE_VERSION] = GVE_VALUES_SOME,
        [GVE_SERIAL] = GVE_VALUES_WORD,
        [GVE_POSITION_2] = GVE_VALUES_DECIMALS_2,
        [GVE_POSITION_3] = GVE_VALUES_DECIMALS_3,
        [GVE_POSITION_4] = GVE_VALUES_DECIMALS_4,
        [GVE_POSITION_LATCHED] = GVE_VALUES_DECIMALS_4,
        [GVE_READ_STATUS] = GVE_VALUES_BYTE,
        [GVE_FLAGS] = GVE_VALUES_BYTE,
        [GVE_INPUTS_1] = GVE_VALUES_BYTE,
        [GVE_INPUTS_2] = GVE_VALUES_BYTE,
        [GVE_READ_BYTE] = GVE_VALUES_BYTE,
        [GVE_READ_WORD] = GVE_VALUES_WORD,
        [GVE_READ_SINGLE] = GVE_VALUES_SINGLE,
        [GVE_INDEX] = GVE_VALUES_NUMBER,
        [GVE_REPEAT] = GVE_VALUES_ANY,
        [GVE_PACKET_END] = GVE_VALUES_NUMBER,
    };
    assert(opcode <= (unsigned)GVE_OPCODES);
    return (enum gve_values)values[opcode];
}

/* ---- answers ---- */

static unsigned hex_digit(uint8_t byte)
{
    if (byte >= '0' && byte <= '9') {
        return byte - (unsigned)'0';
    }
    return byte >= 'A' && byte <= 'F' ? byte - (unsigned)'A' + 10U : (unsigned)NO_DIGIT;
}

static bool has_sum(const uint8_t *line, uint32_t length)
{
    const uint8_t *sum = line + length - SUM_DIGITS;
    unsigned high = hex_digit(sum[0]);
    unsigned low = hex_digit(sum[1]);
    return sum[-1] == ',' && high != (unsigned)NO_DIGIT && low != (unsigned)NO_DIGIT &&
           sum_of(line, length - SUM_DIGITS) == (high << 4U | low);
}

/* A digit, and a comma before values. */
static bool is_told(const uint8_t *line, uint32_t length)
{
    return length > 0 && hex_digit(line[0]) != (unsigned)NO_DIGIT && (length == 1 || (length > 2 && line[1] == ','));
}

bool gve_reply_read(struct gve_reply *reply, const uint8_t *line, uint32_t length, bool sums)
{
    if (length > (uint32_t)GVE_REPLY_LINE_BYTES_MAX || (sums && (length <= SUM_BYTES || !has_sum(line, length)))) {
        return false;
    }
    uint32_t told = sums ? length - SUM_BYTES : length;
    if (!is_told(line, told)) {
        return false;
    }
    unsigned digit = hex_digit(line[0]);
    reply->code = (uint8_t)(digit % INTA_BIT);
    reply->inta = digit >= INTA_BIT;
    reply->length = (uint8_t)(told > 2 ? told - 2 : 0);
    memcpy(reply->values, line + told - reply->length, reply->length);
    reply->values[reply->length] = '\0';
    return true;
}

unsigned gve_reply_byte(const struct gve_reply *reply)
{
    return hex_digit((uint8_t)reply->values[0]) << 4U | hex_digit((uint8_t)reply->values[1]);
}

static bool are_hex(const struct gve_reply *reply, uint32_t digits)
{
    bool are = reply->length == digits;
    for (uint32_t i = 0; are && i < digits; i++) {
        are = hex_digit((uint8_t)reply->values[i]) != (unsigned)NO_DIGIT;
    }
    return are;
}

static bool is_digit(char character)
{
    return character >= '0' && character <= '9';
}

static bool is_number(const struct gve_reply *reply)
{
    bool is = reply->length > 0 && reply->length <= NUMBER_DIGITS_MAX;
    for (uint32_t i = 0; is && i < reply->length; i++) {
        is = is_digit(reply->values[i]);
    }
    return is;
}

uint32_t gve_reply_number(const struct gve_reply *reply)
{
    uint32_t number = 0;
    for (uint32_t i = 0; i < reply->length; i++) {
        number = number * 10U + (uint32_t)(reply->values[i] - '0');
    }
    return number;
}

/* Past a decimal with its comma or the end; null: there is none. */
static const char *after_decimal(const char *next)
{
    next += *next == '-' ? 1 : 0;
    const char *digits = next;
    while (is_digit(*next)) {
        next++;
    }
    return next == digits || (*next != ',' && *next != '\0') ? NULL : next;
}

static bool are_decimals(const struct gve_reply *reply, uint32_t count)
{
    const char *next = after_decimal(reply->values);
    for (uint32_t i = 1; next != NULL && i < count; i++) {
        next = *next == ',' ? after_decimal(next + 1) : NULL;
    }
    return next == reply->values + reply->length;
}

static bool is_single(const struct gve_reply *reply)
{
    uint32_t bits;
    return strcmp(reply->values, "INF") == 0 || strcmp(reply->values, "-INF") == 0 ||
           strcmp(reply->values, "NAN") == 0 ||
           (reply->length <= (uint32_t)GVE_FLOAT_READ_BYTES_MAX &&
            gve_float_read((const uint8_t *)reply->values, reply->length, &bits) == GVE_FLOAT_OK);
}

static bool have_form(const struct gve_reply *reply, struct gve_reply_form form)
{
    switch ((enum gve_values)form.values) {
    case GVE_VALUES_ANY:
        return true;
    case GVE_VALUES_SOME:
        return reply->length > 0;
    case GVE_VALUES_VERSION:
        return strncmp(reply->values, "IP134", sizeof "IP134" - 1) == 0;
    case GVE_VALUES_NUMBER:
        return is_number(reply);
    case GVE_VALUES_NUMBER_OR_NONE:
        return reply->length == 0 || is_number(reply);
    case GVE_VALUES_COUNT:
        return is_number(reply) && (gve_reply_number(reply) == 0 || gve_reply_number(reply) == form.count);
    case GVE_VALUES_DECIMALS_2:
    case GVE_VALUES_DECIMALS_3:
    case GVE_VALUES_DECIMALS_4:
        return are_decimals(reply, form.values - (uint32_t)GVE_VALUES_DECIMALS_2 + 2U);
    case GVE_VALUES_BYTE:
        return are_hex(reply, BYTE_DIGITS);
    case GVE_VALUES_WORD:
        return are_hex(reply, WORD_DIGITS);
    case GVE_VALUES_SINGLE:
        return is_single(reply);
    case GVE_VALUES_NONE:
        break;
    }
    return reply->length == 0;
}

bool gve_reply_fits(const struct gve_reply *reply, struct gve_reply_form form)
{
    return (reply->code != GVE_DONE && reply->length == 0) || have_form(reply, form);
}
