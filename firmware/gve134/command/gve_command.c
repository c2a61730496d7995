#include "gve_command.h"

#include <assert.h>
#include <stdbool.h>

#include "gve_float.h"

enum {
    HEX_DIGITS = 2,
    HEX_WORD_DIGITS = 8,
    HEX_BITS = 4,
    NO_DIGIT = 16,
};

#define DECIMAL_TOO_LONG UINT32_MAX /* what no decimal of the table reaches */
#define DECIMAL_GOES_ON                                                                                                \
    (UINT32_C(1) << 28) /* below it another digit is counted; from it on there would be too many                       \
                         */

static_assert((uint32_t)GVE_TEXT_BYTES_MAX <= (uint32_t)GVE_FLOAT_READ_BYTES_MAX,
              "all of a command can be read as a single");

#define P(name, form, min, max)                                                                                        \
    static_assert((min) <= (max) && ((max) < (int64_t)DECIMAL_GOES_ON * 10 || GVE_FORM_##form > GVE_FORM_NONZERO) &&   \
                      -(min) < (int64_t)DECIMAL_GOES_ON * 10,                                                          \
                  #name " has numbers that can be read");
#include "gve_commands.def"
#undef P

/* One parameter in the text: from its first character to the comma after it, or the end. */
struct token {
    const uint8_t *text;
    uint32_t length;
};

struct parser {
    const uint8_t *text;
    uint32_t length;
    uint32_t next;
};

static uint8_t upper(uint8_t character)
{
    return character >= 'a' && character <= 'z' ? (uint8_t)(character - 'a' + 'A') : character;
}

/* The length of a row's text if the command begins with it, else 0. */
static uint32_t match_length(const struct gve_row *row, const struct parser *parser)
{
    uint32_t length = 0;
    while (row->text[length] != '\0') {
        if (length == parser->length || upper(parser->text[length]) != (uint8_t)row->text[length]) {
            return 0;
        }
        length++;
    }
    return length;
}

/* The command of a name: the row that takes what follows it, else any of that name at the address. The name is the
 * longest among all commands, so that one that the address does not know is not taken for a shorter one. The parser
 * goes past it. */
static unsigned find_opcode(struct parser *parser, enum gve_address address)
{
    unsigned found = GVE_OPCODES;
    uint8_t first = parser->length != 0 ? upper(parser->text[0]) : 0;
    struct gve_opcodes some = gve_opcodes_of(first);
    for (unsigned opcode = some.first; opcode < some.past; opcode++) {
        const struct gve_row *row = gve_row(opcode);
        uint32_t length = (uint8_t)row->text[0] == first ? match_length(row, parser) : 0;
        if (length == 0 || length < parser->next) {
            continue;
        }
        if (length > parser->next) {
            parser->next = length;
            found = GVE_OPCODES;
        }
        bool known = ((unsigned)row->address & (unsigned)address) != 0;
        if (known && (found == (unsigned)GVE_OPCODES || (row->most != 0) == (parser->length > length))) {
            found = opcode;
        }
    }
    return found;
}

static enum gve_fault read_decimal(struct token token, int64_t *value)
{
    const uint8_t *next = token.text;
    const uint8_t *end = token.text + token.length;
    bool negative = token.length != 0 && *next == '-';
    uint32_t number = 0;
    next += negative ? 1 : 0;
    bool none = next == end;
    for (; next != end; next++) {
        uint32_t digit = (uint32_t)*next - '0';
        if (digit > 9U) {
            return GVE_FAULT_NO_DECIMAL;
        }
        number = number < DECIMAL_GOES_ON ? number * 10U + digit : DECIMAL_TOO_LONG;
    }
    *value = negative ? -(int64_t)number : (int64_t)number;
    return none ? GVE_FAULT_NO_DECIMAL : GVE_FAULT_NONE;
}

static uint32_t hex_digit(uint8_t character)
{
    uint8_t letter = upper(character);
    if (letter >= '0' && letter <= '9') {
        return (uint32_t)letter - '0';
    }
    return letter >= 'A' && letter <= 'F' ? (uint32_t)letter - 'A' + 10U : (uint32_t)NO_DIGIT;
}

static enum gve_fault read_hex(struct token token, uint32_t digits_max, int64_t *value)
{
    uint32_t number = 0;
    for (uint32_t i = 0; i < token.length; i++) {
        uint32_t digit = hex_digit(token.text[i]);
        if (digit == (uint32_t)NO_DIGIT) {
            return GVE_FAULT_NO_HEX;
        }
        number = (number << HEX_BITS) | digit;
    }
    *value = number;
    if (token.length == 0) {
        return GVE_FAULT_NO_HEX;
    }
    return token.length > digits_max ? GVE_FAULT_BOUNDS : GVE_FAULT_NONE;
}

static enum gve_fault read_axis(struct token token, int64_t *value)
{
    static const uint8_t letters[] = {'X', 'Y', 'Z', 'A'};
    for (uint32_t i = 0; i < sizeof letters && token.length == 1; i++) {
        if (upper(token.text[0]) == letters[i]) {
            *value = i;
            return GVE_FAULT_NONE;
        }
    }
    return GVE_FAULT_NO_AXIS;
}

static enum gve_fault read_single(struct token token, int64_t *value)
{
    uint32_t bits = 0;
    enum gve_float_status status = gve_float_read(token.text, token.length, &bits);
    *value = bits;
    if (status == GVE_FLOAT_NO_NUMBER) {
        return GVE_FAULT_NO_SINGLE;
    }
    return status == GVE_FLOAT_OK ? GVE_FAULT_NONE : GVE_FAULT_BOUNDS;
}

static enum gve_fault read_form(struct token token, enum gve_form form, int64_t *value)
{
    switch (form) {
    case GVE_FORM_AXIS:
        return read_axis(token, value);
    case GVE_FORM_HEX:
        return read_hex(token, HEX_DIGITS, value);
    case GVE_FORM_HEX_WORD:
        return read_hex(token, HEX_WORD_DIGITS, value);
    case GVE_FORM_SINGLE:
        return read_single(token, value);
    case GVE_FORM_DECIMAL:
    case GVE_FORM_NONZERO:
        break;
    }
    return read_decimal(token, value);
}

static enum gve_fault read_value(struct token token, const struct gve_kind *kind, int32_t *number)
{
    int64_t value = 0;
    enum gve_fault fault = read_form(token, (enum gve_form)kind->form, &value);
    if (fault != GVE_FAULT_NONE) {
        return fault;
    }
    if (value < kind->min || value > kind->max || (kind->form == (uint8_t)GVE_FORM_NONZERO && value == 0)) {
        return GVE_FAULT_BOUNDS;
    }
    *number = (int32_t)value;
    return GVE_FAULT_NONE;
}

#define X(name, text, address, packet, states, least, p1, p2, p3, p4, p5, example, answer)                             \
    static_assert(GVE_PARAMETER_##p2 != GVE_PARAMETER_AXIS && GVE_PARAMETER_##p3 != GVE_PARAMETER_AXIS &&              \
                      GVE_PARAMETER_##p4 != GVE_PARAMETER_AXIS && GVE_PARAMETER_##p5 != GVE_PARAMETER_AXIS,            \
                  #name " has its axis first, where there is a character");
#include "gve_commands.def"
#undef X

/* The parameter that begins here. After the letter of an axis the next one may begin at once. */
static struct token parser_take_token(struct parser *parser, enum gve_form form)
{
    const uint8_t *begin = &parser->text[parser->next];
    const uint8_t *end = form == GVE_FORM_AXIS ? begin + 1 : &parser->text[parser->length];
    const uint8_t *next = begin;
    while (next != end && *next != ',') {
        next++;
    }
    uint32_t length = (uint32_t)(next - begin);
    parser->next += length;
    return (struct token){.text = begin, .length = length};
}

/* Goes past the comma after a parameter; after an axis there need not be one. */
static bool parser_goes_on(struct parser *parser, enum gve_form form)
{
    if (parser->next == parser->length) {
        return false;
    }
    if (form != GVE_FORM_AXIS || parser->text[parser->next] == ',') {
        parser->next++;
    }
    return true;
}

/* Wrong syntax is told even where a parameter before it is out of bounds. */
static void reading_note(struct gve_reading *reading, enum gve_fault fault, uint32_t place, uint32_t parameter)
{
    bool worse = reading->fault == GVE_FAULT_NONE ||
                 (reading->fault == GVE_FAULT_BOUNDS && gve_fault_code(fault) == GVE_WRONG_SYNTAX);
    if (fault != GVE_FAULT_NONE && worse) {
        reading->fault = fault;
        reading->place = place;
        reading->parameter = parameter;
    }
}

static void read_parameters(struct parser *parser, const struct gve_row *row, struct gve_reading *reading)
{
    struct gve_command *command = &reading->command;
    bool more = parser->next < parser->length;
    uint32_t count = 0;
    for (; count < row->most && more; count++) {
        const struct gve_kind *kind = gve_kind(row->parameters[count]);
        uint32_t place = parser->next;
        struct token token = parser_take_token(parser, (enum gve_form)kind->form);
        reading_note(reading, read_value(token, kind, &command->numbers[count]), place, count);
        more = parser_goes_on(parser, (enum gve_form)kind->form);
    }
    if (count < row->least) {
        reading_note(reading, GVE_FAULT_MISSING, parser->length, count);
    }
    if (more) {
        reading_note(reading, GVE_FAULT_SURPLUS, parser->next, count);
    }
    command->count = (uint8_t)count;
}

struct gve_reading gve_command_read(const uint8_t *text, uint32_t length, enum gve_address address)
{
    assert(length <= (uint32_t)GVE_TEXT_BYTES_MAX);
    struct gve_reading reading = {.fault = GVE_FAULT_NONE};
    struct parser parser = {.text = text, .length = length};
    unsigned opcode = find_opcode(&parser, address);
    reading.command.opcode = (uint8_t)opcode;
    if (opcode == (unsigned)GVE_OPCODES) {
        reading_note(&reading, GVE_FAULT_UNKNOWN, 0, 0);
    } else {
        read_parameters(&parser, gve_row(opcode), &reading);
    }
    return reading;
}

enum gve_code gve_fault_code(enum gve_fault fault)
{
    static const uint8_t codes[GVE_FAULTS_TOTAL] = {
#define X(name, code, text) [GVE_FAULT_##name] = (uint8_t)GVE_##code,
        GVE_FAULTS(X)
#undef X
    };
    return (enum gve_code)codes[fault];
}

const char *gve_fault_text(enum gve_fault fault)
{
    static const char *const texts[GVE_FAULTS_TOTAL] = {
#define X(name, code, text) [GVE_FAULT_##name] = (text),
        GVE_FAULTS(X)
#undef X
    };
    return texts[fault];
}
