#include "feed.h"

#include <string.h>

#include "complain.h"
#include "program_listing.h"
#include "program_parser.h"
#include "source.h"

enum {
    HEAD_BYTES = 2, /* message number and motor */
    TEXT_BYTES_MAX = MESSAGES_REQUEST_BYTES_MAX - HEAD_BYTES,
    ANSWER_BYTES = 4, /* message number, motor, flag, character */
    FLAG_VALUE = 1,
    FLAG_UNKNOWN = 2,
    FLAG_OVERFLOW = 3,
};

/* A Set Command message on its way. */
struct part {
    struct feed *feed;
    struct rkm04 *unit;
    unsigned motor;
    uint32_t length; /* of the text so far */
    uint8_t request[MESSAGES_REQUEST_BYTES_MAX];
};

/* From UTF-8 to one byte for each character, as the line carries it. False after a complaint. */
static bool decode(struct infile *program)
{
    struct source text;
    if (!source_read(&text, program)) {
        return false;
    }
    memcpy(program->bytes, text.message, text.length + 1U);
    program->length = text.length;
    source_discard(&text);
    return true;
}

static bool read_program(struct infile *program, const char *path)
{
    return infile_read(program, path) && decode(program);
}

bool feed_read(struct feed *feed, const char *const paths[UNIT_MOTORS])
{
    *feed = (struct feed){.overflow = {false}};
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        if (paths[i] != NULL && !read_program(&feed->programs[i], paths[i])) {
            feed_discard(feed);
            return false;
        }
    }
    return true;
}

static void complain_of(const struct infile *program, unsigned motor, uint8_t flag, uint8_t character)
{
    struct program_parser parser;
    struct program_instruction instruction;
    program_parser_init(&parser, program->bytes, program->length);
    while (program_parser_next(&parser, &instruction) == PROGRAM_OK) {
    }
    const char *what = flag == FLAG_UNKNOWN ? "is no command" : "has a wrong value or none";
    complain("%s:%u:%u: motor %u refuses the program: character %u ('%c') %s; correct it", program->path,
             (unsigned)infile_line(program, parser.place), (unsigned)infile_column(program, parser.place), motor + 1U,
             (unsigned)character, character >= 0x20 && character < 0x7F ? character : '?', what);
}

/* Sends the message and begins a new one. False after a complaint. */
static bool part_send(struct part *part)
{
    uint8_t answer[MESSAGES_ANSWER_BYTES_MAX] = {0};
    part->request[0] = MESSAGES_SET_COMMAND;
    part->request[1] = (uint8_t)('1' + part->motor);
    uint32_t length = rkm04_message(part->unit, part->request, HEAD_BYTES + part->length, answer);
    part->length = 0;
    if (length != ANSWER_BYTES || answer[2] == FLAG_VALUE || answer[2] == FLAG_UNKNOWN) {
        complain_of(&part->feed->programs[part->motor], part->motor, answer[2], answer[3]);
        return false;
    }
    part->feed->overflow[part->motor] = part->feed->overflow[part->motor] || answer[2] == FLAG_OVERFLOW;
    return true;
}

/* Appends to the message; sends it first if there is no room left. False after a complaint. */
static bool part_append(struct part *part, const uint8_t *text, uint32_t length)
{
    if (part->length + length > TEXT_BYTES_MAX && !part_send(part)) {
        return false;
    }
    memcpy(&part->request[HEAD_BYTES + part->length], text, length);
    part->length += length;
    return true;
}

static bool part_append_byte(struct part *part, uint8_t byte)
{
    return part_append(part, &byte, 1);
}

/* The canonical text of a command. 0 for K and C75: they are not for a longer message, but would act if they came to
 * stand alone in one part of it. */
static uint32_t list_command(const struct program_instruction *instruction, uint8_t text[PROGRAM_COMMAND_BYTES_MAX])
{
    if (instruction->opcode == PROGRAM_HALT || instruction->opcode == PROGRAM_RESUME) {
        return 0;
    }
    return program_list_instruction(instruction, text);
}

static bool fits_when_listed(const struct infile *program)
{
    struct program_parser parser;
    struct program_instruction instruction;
    uint8_t text[PROGRAM_COMMAND_BYTES_MAX];
    uint32_t length = 0;
    program_parser_init(&parser, program->bytes, program->length);
    while (length <= TEXT_BYTES_MAX && program_parser_next(&parser, &instruction) == PROGRAM_OK) {
        length += list_command(&instruction, text);
    }
    return length <= TEXT_BYTES_MAX;
}

/* A `\` forgets what came before it, the `[` too: another follows. */
static bool part_append_command(struct part *part, const struct program_instruction *instruction)
{
    uint8_t text[PROGRAM_COMMAND_BYTES_MAX];
    uint32_t length = list_command(instruction, text);
    if (length == 0 || !part_append(part, text, length)) {
        return length == 0;
    }
    if (instruction->opcode != PROGRAM_RESET) {
        part->feed->stored[part->motor]++;
        return true;
    }
    part->feed->stored[part->motor] = 0;
    return !part->feed->held[part->motor] || part_append_byte(part, '[');
}

/* Checked as a whole first: what is wrong in a later part must not leave the earlier ones in the unit. */
static bool send_listed(struct part *part, const struct infile *program)
{
    struct program_summary summary = program_check(program->bytes, program->length);
    if (summary.status != PROGRAM_OK) {
        complain_of(program, part->motor, (uint8_t)-(int)summary.status, summary.character);
        return false;
    }
    struct program_parser parser;
    struct program_instruction instruction;
    bool held = !fits_when_listed(program);
    bool good = !held || part_append_byte(part, '[');
    part->feed->held[part->motor] = held;
    program_parser_init(&parser, program->bytes, program->length);
    while (good && program_parser_next(&parser, &instruction) == PROGRAM_OK) {
        good = part_append_command(part, &instruction);
    }
    return good && part_send(part);
}

static bool send_program(struct part *part, const struct infile *program)
{
    if (program->length > TEXT_BYTES_MAX) {
        return send_listed(part, program);
    }
    return part_append(part, program->bytes, program->length) && part_send(part);
}

bool feed_send(struct feed *feed, struct rkm04 *unit)
{
    struct part part = {.feed = feed, .unit = unit};
    for (part.motor = 0; part.motor < UNIT_MOTORS; part.motor++) {
        const struct infile *program = &feed->programs[part.motor];
        if (program->path != NULL && !send_program(&part, program)) {
            return false;
        }
    }
    for (part.motor = 0; part.motor < UNIT_MOTORS; part.motor++) {
        if (feed->held[part.motor] && !(part_append_byte(&part, ']') && part_send(&part))) {
            return false;
        }
    }
    return true;
}

uint32_t feed_place(const struct feed *feed, unsigned motor, uint32_t place)
{
    if (!feed->held[motor] || place == 0) {
        return place;
    }
    return place - 1U < feed->stored[motor] ? place - 1U : feed->stored[motor];
}

void feed_discard(struct feed *feed)
{
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        infile_discard(&feed->programs[i]);
    }
}
