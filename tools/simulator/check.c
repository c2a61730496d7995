#include "check.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "infile.h"
#include "json.h"
#include "lint.h"
#include "listing.h"
#include "problem.h"
#include "refusal.h"
#include "source.h"

static void print_place(const struct source *text, struct source_place *place, uint32_t offset)
{
    source_move(text, place, offset);
    (void)printf("{\"offset\":%" PRIu32 ",\"line\":%" PRIu32 ",\"column\":%" PRIu32, place->offset, place->line,
                 place->column);
}

static void print_commands(const struct source *text, const struct listing *listing)
{
    struct source_place place = source_begin();
    for (uint32_t i = 0; i < listing->count; i++) {
        const struct listing_command *command = &listing->commands[i];
        char canonical[PROGRAM_COMMAND_BYTES_MAX + 1];
        (void)fputs(i == 0 ? "\n" : ",\n", stdout);
        print_place(text, &place, command->offset);
        (void)printf(",\"ordinal\":%" PRIu32 ",\"opcode\":\"%s\",\"io\":%u,\"value\":%" PRId32 ",\"text\":",
                     command->ordinal, program_opcode_name(command->instruction.opcode),
                     (unsigned)command->instruction.io, command->instruction.value);
        json_print_string(listing_text(command, canonical));
        (void)putchar('}');
    }
}

static void print_problems(const struct source *text, const struct problems *problems)
{
    struct source_place place = source_begin();
    for (uint32_t i = 0; i < problems->count; i++) {
        const struct problem *problem = &problems->list[i];
        (void)fputs(i == 0 ? "\n" : ",\n", stdout);
        print_place(text, &place, problem->offset);
        (void)printf(",\"end_column\":%" PRIu32 ",\"severity\":\"%s\",\"rule\":\"%s\",\"flag\":%u,\"message\":",
                     place.column + source_command_width(text, problem->offset),
                     problem->flag != 0 ? "error" : "warning", problem->rule, problem->flag);
        json_print_utf8(problem->message);
        (void)putchar('}');
    }
}

static enum exit_status print_answer(const struct source *text, const struct listing *listing)
{
    struct problems problems = {.count = 0};
    uint32_t more = refusal_find(text, &problems);
    if (problems.count == 0) {
        lint_find(listing, &problems);
        problems_sort(&problems);
    }
    enum exit_status status = EXIT_REFUSED;
    if (problems.is_short) {
        complain("there is not memory enough to check this program; make it shorter");
    } else {
        (void)fputs("{\"commands\":[", stdout);
        print_commands(text, listing);
        (void)printf("],\n\"stored\":%" PRIu32 ",\n\"problems\":[", listing->stored);
        print_problems(text, &problems);
        (void)printf("],\n\"more\":%" PRIu32 "}\n", more);
        status = finish_output();
    }
    problems_discard(&problems);
    return status;
}

static enum exit_status check_text(const struct source *text)
{
    struct listing listing;
    enum exit_status status = listing_read(&listing, text) ? print_answer(text, &listing) : EXIT_REFUSED;
    listing_discard(&listing);
    return status;
}

enum exit_status check_file(const char *path)
{
    struct infile file;
    struct source text;
    if (!infile_read(&file, path)) {
        return EXIT_REFUSED;
    }
    enum exit_status status = source_read(&text, &file) ? check_text(&text) : EXIT_REFUSED;
    source_discard(&text);
    infile_discard(&file);
    return status;
}
