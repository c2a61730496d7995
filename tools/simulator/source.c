#include "source.h"

#include <stdlib.h>

#include "complain.h"

enum {
    FOREIGN = 0xFF, /* no command, and no character of a comment's end */
    REPLACEMENT = 0xFFFD,
    ASCII_MAX = 0x7F,
    CONTINUATION_BITS = 6,
};

/* What the manual prints for the call character; the unit's own is the apostrophe. */
enum {
    CALL_ACUTE = 0xB4,
    CALL_QUOTE = 0x2019,
    CALL_LOW_QUOTE = 0x201E,
};

static uint8_t byte_of(uint32_t character)
{
    if (character == CALL_ACUTE || character == CALL_QUOTE || character == CALL_LOW_QUOTE) {
        return '\'';
    }
    return character <= ASCII_MAX ? (uint8_t)character : FOREIGN;
}

/* How many bytes follow the first one of a character of UTF-8. */
static unsigned followers(uint8_t byte)
{
    if (byte < 0xE0) {
        return byte < 0xC0 ? 0 : 1;
    }
    return byte < 0xF0 ? 2 : 3;
}

/* Reads one character and moves *at after it; the file ends with a 0, which follows nothing. */
static uint32_t read_character(const uint8_t **at)
{
    uint8_t byte = *(*at)++;
    if (byte <= ASCII_MAX) {
        return byte;
    }
    unsigned left = followers(byte);
    uint32_t character = left == 0 ? REPLACEMENT : byte & (0x3FU >> left);
    for (; left > 0 && (**at & 0xC0U) == 0x80U; left--) {
        character = character << CONTINUATION_BITS | (*(*at)++ & 0x3FU);
    }
    return left == 0 ? character : REPLACEMENT;
}

bool source_read(struct source *text, const struct infile *file)
{
    size_t room = (size_t)file->length + 1U;
    *text = (struct source){.characters = malloc(room * sizeof *text->characters), .message = malloc(room)};
    if (text->characters == NULL || text->message == NULL) {
        complain("%s: there is not memory enough for it; make the file shorter", file->path);
        source_discard(text);
        return false;
    }
    const uint8_t *at = file->bytes;
    const uint8_t *end = file->bytes + file->length;
    while (at < end) {
        uint32_t character = read_character(&at);
        text->characters[text->length] = character;
        text->message[text->length++] = byte_of(character);
    }
    text->characters[text->length] = 0;
    text->message[text->length] = 0;
    return true;
}

struct source_place source_begin(void)
{
    return (struct source_place){.line = 1, .column = 1};
}

void source_move(const struct source *text, struct source_place *place, uint32_t offset)
{
    while (place->offset < offset) {
        uint32_t character = text->characters[place->offset++];
        bool ends = character == '\n' || (character == '\r' && text->characters[place->offset] != '\n');
        place->line += ends ? 1U : 0U;
        place->column = ends ? 1U : place->column + 1U;
    }
}

bool source_is_line_end(const struct source *text, uint32_t offset)
{
    return offset == text->length || text->characters[offset] == '\n' || text->characters[offset] == '\r';
}

static uint32_t skip_number(const struct source *text, uint32_t offset)
{
    for (;; offset++) {
        uint32_t character = text->characters[offset];
        if (character != '+' && character != '-' && (character < '0' || character > '9')) {
            return offset;
        }
    }
}

static bool is_letter(uint32_t character)
{
    uint32_t upper = character & ~0x20U;
    return upper >= 'A' && upper <= 'Z';
}

uint32_t source_value_end(const struct source *text, uint32_t offset)
{
    uint32_t end = skip_number(text, offset + 1U);
    if (text->characters[offset] == 'I' && is_letter(text->characters[end])) {
        end = skip_number(text, end + 1U);
    }
    return end;
}

uint32_t source_command_width(const struct source *text, uint32_t offset)
{
    if (offset == text->length) {
        return 1;
    }
    if (text->characters[offset] != '{') {
        return source_value_end(text, offset) - offset;
    }
    uint32_t end = offset;
    while (!source_is_line_end(text, end)) {
        end++;
    }
    return end - offset;
}

void source_discard(struct source *text)
{
    free(text->characters);
    free(text->message);
    *text = (struct source){.length = 0};
}
