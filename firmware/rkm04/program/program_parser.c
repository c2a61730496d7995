#include "program_parser.h"

#include <assert.h>
#include <stdbool.h>

#include "base_limits.h"

/* What no number of the table reaches: a longer number becomes this, and so no row takes it. */
#define NUMBER_TOO_LONG UINT32_MAX

#define X(name, letter, form, min, max)                                                                                \
    static_assert((min) <= (max) && (max) < (int64_t)NUMBER_TOO_LONG, #name " has numbers that can be read");
#include "program_opcodes.def"
#undef X

/* What stands after a command letter. */
struct value {
    enum program_form form; /* NONE also where something stands there that is no value */
    int64_t number;
    uint32_t io;
};

void program_parser_init(struct program_parser *parser, const uint8_t *text, uint32_t length)
{
    *parser = (struct program_parser){.text = text, .length = length};
}

/* The byte `ahead` of the next one; 0, which belongs to no command, after the end. */
static uint8_t parser_peek(const struct program_parser *parser, uint32_t ahead)
{
    return ahead < parser->length - parser->next ? parser->text[parser->next + ahead] : 0;
}

static bool parser_take(struct program_parser *parser, char character)
{
    bool found = parser_peek(parser, 0) == (uint8_t)character;
    parser->next += found ? 1U : 0U;
    return found;
}

static bool character_is_blank(uint8_t character)
{
    return character == ' ' || character == '\t' || character == '\r' || character == '\n';
}

static bool character_is_digit(uint8_t character)
{
    return character >= '0' && character <= '9';
}

static bool character_is_of_number(uint8_t character)
{
    return character_is_digit(character) || character == '+' || character == '-';
}

/* The call characters are one command: ' " ` and the acute accent of Windows-1250. */
static uint8_t character_letter(uint8_t character)
{
    return character == 0x22 || character == 0x60 || character == 0xB4 ? 0x27 : character;
}

/* Stands after the '}' of the comment that begins here, or at the end. False: it is not closed. */
static bool parser_skip_comment(struct program_parser *parser)
{
    while (parser->next < parser->length) {
        bool closed = parser->text[parser->next] == '}';
        parser->next++;
        if (closed) {
            return true;
        }
    }
    return false;
}

/* Stands at the next command or the end, with `place` there. False: at the end after a comment that is not closed,
 * with `place` at its beginning. */
static bool parser_skip_between(struct program_parser *parser)
{
    for (;;) {
        uint8_t character = parser_peek(parser, 0);
        parser->place = parser->next;
        if (character == '{') {
            if (!parser_skip_comment(parser)) {
                return false;
            }
        } else if (character_is_blank(character)) {
            parser->next++;
        } else {
            return true;
        }
    }
}

static uint32_t parser_count_blanks(const struct program_parser *parser)
{
    uint32_t blanks = 0;
    while (character_is_blank(parser_peek(parser, blanks))) {
        blanks++;
    }
    return blanks;
}

/* Goes on after digits and signs, and after blanks before them: no command begins with them. */
static void parser_skip_number(struct program_parser *parser)
{
    uint32_t blanks = parser_count_blanks(parser);
    if (character_is_of_number(parser_peek(parser, blanks))) {
        parser->next += blanks;
    }
    while (character_is_of_number(parser_peek(parser, 0))) {
        parser->next++;
    }
}

/* Goes on after H or L and its label; after a blank, H or L without a number may be a command of its own. */
static void parser_skip_level(struct program_parser *parser)
{
    uint32_t blanks = parser_count_blanks(parser);
    uint8_t level = parser_peek(parser, blanks);
    if ((level == 'H' || level == 'L') && (blanks == 0 || character_is_digit(parser_peek(parser, blanks + 1U)))) {
        parser->next += blanks + 1U;
        parser_skip_number(parser);
    }
}

/* Goes on after the character at `place` and what looks like its value. */
static void parser_recover(struct program_parser *parser)
{
    parser->next = parser->place + 1U;
    parser_skip_number(parser);
    if (parser->text[parser->place] == 'I') {
        parser_skip_level(parser);
    }
}

/* Reads digits. False: there is none. */
static bool parser_read_digits(struct program_parser *parser, uint32_t *number)
{
    uint32_t begin = parser->next;
    *number = 0;
    while (character_is_digit(parser_peek(parser, 0))) {
        uint32_t digit = (uint32_t)parser->text[parser->next] - '0';
        bool fits = *number < NUMBER_TOO_LONG / 10U;
        *number = fits ? *number * 10U + digit : NUMBER_TOO_LONG;
        parser->next++;
    }
    return parser->next > begin;
}

static struct value parser_read_number(struct program_parser *parser)
{
    bool plus = parser_take(parser, '+');
    bool minus = !plus && parser_take(parser, '-');
    uint32_t number = 0;
    if (!parser_read_digits(parser, &number)) {
        enum program_form unsigned_form = plus ? PROGRAM_FORM_PLUS : PROGRAM_FORM_NONE;
        return (struct value){.form = minus ? PROGRAM_FORM_MINUS : unsigned_form};
    }
    if (plus) {
        return (struct value){.form = PROGRAM_FORM_NONE};
    }
    return minus ? (struct value){.form = PROGRAM_FORM_SIGNED, .number = -(int64_t)number}
                 : (struct value){.form = PROGRAM_FORM_NUMBER, .number = number};
}

static bool io_has_level(uint32_t io)
{
    return (io >= 1 && io <= UNIT_INPUTS) ||
           (io >= PROGRAM_VARIABLE_FIRST && io < PROGRAM_VARIABLE_FIRST + PROGRAM_VARIABLES);
}

static struct value parser_read_condition(struct program_parser *parser)
{
    uint32_t io = 0;
    uint32_t label = 0;
    bool good = parser_read_digits(parser, &io) && io_has_level(io);
    bool high = good && parser_take(parser, 'H');
    bool low = good && parser_take(parser, 'L');
    if (!(high || low) || !parser_read_digits(parser, &label)) {
        return (struct value){.form = PROGRAM_FORM_NONE};
    }
    return (struct value){.form = high ? PROGRAM_FORM_HIGH : PROGRAM_FORM_LOW, .number = label, .io = io};
}

static struct value parser_read_value(struct program_parser *parser, enum program_form form)
{
    if (form == PROGRAM_FORM_NONE) {
        return (struct value){.form = PROGRAM_FORM_NONE};
    }
    if (form == PROGRAM_FORM_HIGH) {
        return parser_read_condition(parser);
    }
    return parser_read_number(parser);
}

static bool row_takes_value(const struct program_row *row, const struct value *value)
{
    bool number = row->form == PROGRAM_FORM_NUMBER || row->form == PROGRAM_FORM_IO || row->form == PROGRAM_FORM_SIGNED;
    bool form_taken = value->form == PROGRAM_FORM_NUMBER ? number : value->form == (enum program_form)row->form;
    return form_taken && value->number >= row->min && value->number <= row->max;
}

/* Reads the command at `place`, on whose letter the parser stands. */
static enum program_status parser_read_command(struct program_parser *parser, struct program_instruction *instruction)
{
    uint8_t letter = character_letter(parser->text[parser->place]);
    unsigned opcode = program_opcode_find(0, letter);
    if (opcode == PROGRAM_OPCODES) {
        return PROGRAM_UNKNOWN_COMMAND;
    }
    parser->next = parser->place + 1U;
    struct value value = parser_read_value(parser, (enum program_form)program_opcode_row(opcode)->form);
    while (opcode < PROGRAM_OPCODES && !row_takes_value(program_opcode_row(opcode), &value)) {
        opcode = program_opcode_find(opcode + 1U, letter);
    }
    if (opcode == PROGRAM_OPCODES) {
        return PROGRAM_BAD_VALUE;
    }
    *instruction = (struct program_instruction){
        .value = (int32_t)value.number,
        .opcode = (uint8_t)opcode,
        .io = (uint8_t)value.io,
    };
    return PROGRAM_OK;
}

enum program_status program_parser_next(struct program_parser *parser, struct program_instruction *instruction)
{
    if (!parser_skip_between(parser)) {
        return PROGRAM_UNKNOWN_COMMAND;
    }
    if (parser->place == parser->length) {
        return PROGRAM_END;
    }
    enum program_status status = parser_read_command(parser, instruction);
    if (status != PROGRAM_OK) {
        parser_recover(parser);
    }
    return status;
}

struct program_summary program_check(const uint8_t *text, uint32_t length)
{
    struct program_summary summary = {.status = PROGRAM_OK};
    struct program_instruction instruction;
    struct program_parser parser;
    program_parser_init(&parser, text, length);
    enum program_status status = program_parser_next(&parser, &instruction);
    while (status == PROGRAM_OK) {
        if (summary.commands == 0) {
            summary.first = instruction;
        }
        summary.commands++;
        status = program_parser_next(&parser, &instruction);
    }
    if (status < PROGRAM_OK) {
        summary.status = status;
        summary.character = text[parser.place];
    }
    return summary;
}
