#include "refusal.h"

#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "program_parser.h"
#include "words.h"

enum {
    FLAG_VALUE = 1,
    FLAG_UNKNOWN = 2,
    VALUE_SHOWN_MAX = 16, /* characters */
    WANTED_BYTES_MAX = 240,
    WORDS_BYTES_MAX = 80,
    CHARACTER_BYTES_MAX = 5,
    DOS_END = 0x1A,
};

/* What comments begin with elsewhere. */
static const char *const foreign_comments[] = {";", "//", "#", "--", "%"};

static const char *foreign_comment_at(const struct source *text, uint32_t offset)
{
    for (size_t i = 0; i < sizeof foreign_comments / sizeof foreign_comments[0]; i++) {
        const char *mark = foreign_comments[i];
        uint32_t first = (uint8_t)mark[0];
        uint32_t second = (uint8_t)mark[1];
        if (text->characters[offset] == first && (second == 0 || text->characters[offset + 1U] == second)) {
            return mark;
        }
    }
    return NULL;
}

/* Characters that are not shown as they are: controls, kinds of blanks, what has no form of its own. */
static bool is_printable(uint32_t character)
{
    static const struct {
        uint32_t first, last;
    } hidden[] = {
        {0x00, 0x1F},     {0x7F, 0xA0},     {0xAD, 0xAD},     {0x1680, 0x1680}, {0x2000, 0x200F},
        {0x2028, 0x202F}, {0x205F, 0x206F}, {0x3000, 0x3000}, {0xD800, 0xF8FF}, {0xFEFF, 0xFEFF},
        {0xFFF0, 0xFFFB}, {0xFFFE, 0xFFFF}, {0xE0000, ~0U},
    };
    for (size_t i = 0; i < sizeof hidden / sizeof hidden[0]; i++) {
        if (character >= hidden[i].first && character <= hidden[i].last) {
            return false;
        }
    }
    return true;
}

static const char *name_of(uint32_t character)
{
    static const struct {
        uint32_t character;
        const char *name;
    } names[] = {
        {0xA0, "no-break space"},          {0xAD, "soft hyphen"},
        {0x2007, "figure space"},          {0x2009, "thin space"},
        {0x200B, "zero width space"},      {0x200C, "zero width non-joiner"},
        {0x200D, "zero width joiner"},     {0x200E, "left-to-right mark"},
        {0x200F, "right-to-left mark"},    {0x2028, "line separator"},
        {0x202F, "narrow no-break space"}, {0x2060, "word joiner"},
        {0x3000, "ideographic space"},     {0xFEFF, "zero width no-break space"},
    };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (names[i].character == character) {
            return names[i].name;
        }
    }
    return character < 0xA0 ? "control character" : "character";
}

/* Writes a character as UTF-8 with a terminator; returns where it ends. */
static char *put_character(char *at, uint32_t character)
{
    if (character <= 0x7F) {
        *at++ = (char)character;
    } else if (character <= 0x7FF) {
        *at++ = (char)(0xC0U | character >> 6);
        *at++ = (char)(0x80U | (character & 0x3FU));
    } else {
        if (character <= 0xFFFF) {
            *at++ = (char)(0xE0U | character >> 12);
        } else {
            *at++ = (char)(0xF0U | character >> 18);
            *at++ = (char)(0x80U | (character >> 12 & 0x3FU));
        }
        *at++ = (char)(0x80U | (character >> 6 & 0x3FU));
        *at++ = (char)(0x80U | (character & 0x3FU));
    }
    *at = '\0';
    return at;
}

/* Says what may have been meant. */
static const char *advice_of(uint32_t character, char *text, size_t room)
{
    bool is_lower = character >= 'a' && character <= 'z';
    unsigned upper = is_lower ? (unsigned)character - 'a' + 'A' : 0;
    if (is_lower && words_commands_of((uint8_t)upper) > 0) {
        (void)snprintf(text, room, "; commands are upper case: %c", (int)upper);
        return text;
    }
    if (character >= '0' && character <= '9') {
        return "; this number belongs to no command";
    }
    switch (character) {
    case DOS_END:
        return "; the end of a DOS file stands here, with more after it";
    case '}':
        return "; no comment is open here";
    case 0x2018: /* quotation marks */
    case 0x201C:
    case 0x201D:
        return "; a subroutine is called with '";
    default:
        return "";
    }
}

static void add_unknown(struct problems *problems, const struct source *text, uint32_t offset)
{
    uint32_t character = text->characters[offset];
    const char *mark = foreign_comment_at(text, offset);
    char advice[WORDS_BYTES_MAX];
    char shown[CHARACTER_BYTES_MAX];
    (void)put_character(shown, character);
    if (mark != NULL) {
        problems_add(problems, offset, FLAG_UNKNOWN, "command", "%s begins no comment here; write comments in { }",
                     mark);
    } else if (character == '{') {
        problems_add(problems, offset, FLAG_UNKNOWN, "command",
                     "the comment that begins here has no end; close it with }");
    } else if (is_printable(character)) {
        problems_add(problems, offset, FLAG_UNKNOWN, "command", "unknown command \"%s\"%s", shown,
                     advice_of(character, advice, sizeof advice));
    } else {
        problems_add(problems, offset, FLAG_UNKNOWN, "command", "unknown command (%s, code %" PRIu32 ")%s",
                     name_of(character), character, advice_of(character, advice, sizeof advice));
    }
}

static bool is_blank(uint32_t character)
{
    return character == ' ' || character == '\t' || character == '\r' || character == '\n';
}

/* Whether blanks and then a number stand at an offset. */
static bool is_blank_before_number(const struct source *text, uint32_t offset)
{
    uint32_t at = offset;
    while (is_blank(text->characters[at])) {
        at++;
    }
    uint32_t character = text->characters[at];
    return at > offset && (character == '+' || character == '-' || (character >= '0' && character <= '9'));
}

/* Says what stands after the letter. */
static const char *found_at(const struct source *text, uint32_t offset, char *words, size_t room)
{
    uint32_t end = source_value_end(text, offset);
    uint32_t length = end - offset - 1U;
    if (length == 0 && is_blank_before_number(text, end)) {
        return "a blank; nothing may stand between a command and its number";
    }
    if (length == 0) {
        return end == text->length ? "the end of the file" : "no number";
    }
    char shown[VALUE_SHOWN_MAX + 1];
    (void)snprintf(shown, sizeof shown, "%.*s", (int)(length < VALUE_SHOWN_MAX ? length : VALUE_SHOWN_MAX),
                   (const char *)&text->message[offset + 1U]);
    if (length <= VALUE_SHOWN_MAX) {
        (void)snprintf(words, room, "%s", shown);
    } else {
        (void)snprintf(words, room, "%s... (%" PRIu32 " characters)", shown, length);
    }
    return words;
}

static void add_value(struct problems *problems, const struct source *text, uint32_t offset)
{
    uint8_t letter = text->message[offset];
    letter = words_commands_of(letter) > 0 ? letter : '\''; /* for all forms of the call character */
    char wanted[WANTED_BYTES_MAX];
    char found[WORDS_BYTES_MAX];
    char shown[CHARACTER_BYTES_MAX];
    char meaning[WORDS_BYTES_MAX] = "";
    (void)put_character(shown, text->characters[offset]);
    words_put_wanted(letter, wanted, sizeof wanted);
    if (words_commands_of(letter) == 1) {
        (void)snprintf(meaning, sizeof meaning, " (%s)", words_meaning(program_opcode_find(0, letter)));
    }
    problems_add(problems, offset, FLAG_VALUE, "value", "%s%s takes %s, found %s", shown, meaning, wanted,
                 found_at(text, offset, found, sizeof found));
}

/* Where what follows from a comment of another language at an offset ends; the offset if there is none. */
static uint32_t skip_foreign_comment(const struct source *text, uint32_t offset)
{
    uint32_t end = offset;
    while (foreign_comment_at(text, offset) != NULL && !source_is_line_end(text, end)) {
        end++;
    }
    return end;
}

uint32_t refusal_find(const struct source *text, struct problems *problems)
{
    struct program_parser parser;
    struct program_instruction instruction;
    uint32_t found = 0;
    uint32_t after = 0;
    program_parser_init(&parser, text->message, text->length);
    for (;;) {
        enum program_status status = program_parser_next(&parser, &instruction);
        if (status == PROGRAM_END) {
            return found > REFUSAL_LISTED_MAX ? found - REFUSAL_LISTED_MAX : 0;
        }
        if (status == PROGRAM_OK || ++found > REFUSAL_LISTED_MAX || parser.place < after) {
            continue;
        }
        if (status == PROGRAM_BAD_VALUE) {
            add_value(problems, text, parser.place);
        } else {
            add_unknown(problems, text, parser.place);
        }
        after = skip_foreign_comment(text, parser.place);
    }
}
