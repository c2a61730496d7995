#include "check.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>

#include "infile.h"
#include "json.h"
#include "program_listing.h"
#include "program_parser.h"

enum {
    LISTED_MAX = 1000
};

static void print_command(const struct program_parser *parser, const struct program_instruction *instruction)
{
    uint8_t text[PROGRAM_COMMAND_BYTES_MAX];
    uint32_t length = program_list_instruction(instruction, text);
    (void)printf("{\"offset\":%" PRIu32 ",\"opcode\":\"%s\",\"io\":%u,\"value\":%" PRId32 ",\"text\":", parser->place,
                 program_opcode_name(instruction->opcode), (unsigned)instruction->io, instruction->value);
    json_print_text((const char *)text, length);
    (void)putchar('}');
}

static void print_error(const struct program_parser *parser, enum program_status status)
{
    (void)printf("{\"offset\":%" PRIu32 ",\"flag\":%d,\"character\":%u}", parser->place, -(int)status,
                 (unsigned)parser->text[parser->place]);
}

/* Either all commands or the first errors; the text is read once for each. Returns how many errors were left out. */
static uint32_t print_list(const struct infile *file, bool errors)
{
    struct program_parser parser;
    struct program_instruction instruction;
    const char *before = "\n";
    uint32_t found = 0;
    program_parser_init(&parser, file->bytes, file->length);
    for (;;) {
        enum program_status status = program_parser_next(&parser, &instruction);
        if (status == PROGRAM_END) {
            return errors && found > LISTED_MAX ? found - LISTED_MAX : 0;
        }
        if ((status != PROGRAM_OK) != errors || (errors && ++found > LISTED_MAX)) {
            continue;
        }
        (void)fputs(before, stdout);
        before = ",\n";
        if (errors) {
            print_error(&parser, status);
        } else {
            print_command(&parser, &instruction);
        }
    }
}

enum exit_status check_file(const char *path)
{
    struct infile file;
    if (!infile_read(&file, path)) {
        return EXIT_REFUSED;
    }
    (void)fputs("{\"commands\":[", stdout);
    (void)print_list(&file, false);
    (void)fputs("],\n\"errors\":[", stdout);
    uint32_t more = print_list(&file, true);
    (void)printf("],\n\"more\":%" PRIu32 "}\n", more);
    infile_discard(&file);
    return finish_output();
}
