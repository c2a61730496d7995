#include "listing.h"

#include <stdlib.h>

#include "complain.h"
#include "program_parser.h"

static uint32_t count_commands(const struct source *text)
{
    struct program_parser parser;
    struct program_instruction instruction;
    uint32_t count = 0;
    program_parser_init(&parser, text->message, text->length);
    for (;;) {
        enum program_status status = program_parser_next(&parser, &instruction);
        if (status == PROGRAM_END) {
            return count;
        }
        count += status == PROGRAM_OK ? 1U : 0U;
    }
}

/* K and C75 act where they come alone, and are never stored. */
static void number(struct listing *listing)
{
    for (uint32_t i = listing->start; i < listing->count; i++) {
        struct listing_command *command = &listing->commands[i];
        uint8_t opcode = command->instruction.opcode;
        command->ordinal = opcode != PROGRAM_HALT && opcode != PROGRAM_RESUME ? ++listing->stored : 0;
    }
}

bool listing_read(struct listing *listing, const struct source *text)
{
    struct program_parser parser;
    *listing = (struct listing){.commands = calloc((size_t)count_commands(text) + 1U, sizeof *listing->commands)};
    if (listing->commands == NULL) {
        complain("there is not memory enough for so many commands; make the program shorter");
        return false;
    }
    program_parser_init(&parser, text->message, text->length);
    for (;;) {
        struct program_instruction instruction;
        enum program_status status = program_parser_next(&parser, &instruction);
        if (status == PROGRAM_END) {
            number(listing);
            return true;
        }
        if (status == PROGRAM_OK) {
            listing->commands[listing->count++] =
                (struct listing_command){.instruction = instruction, .offset = parser.place};
            listing->start = instruction.opcode == PROGRAM_RESET ? listing->count : listing->start;
        }
    }
}

const char *listing_text(const struct listing_command *command, char text[PROGRAM_COMMAND_BYTES_MAX + 1])
{
    uint8_t bytes[PROGRAM_COMMAND_BYTES_MAX];
    uint32_t length = program_list_instruction(&command->instruction, bytes);
    for (uint32_t i = 0; i < length; i++) {
        text[i] = (char)bytes[i];
    }
    text[length] = '\0';
    return text;
}

void listing_discard(struct listing *listing)
{
    free(listing->commands);
    *listing = (struct listing){.count = 0};
}
