#include "gve_check.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "gve_file.h"
#include "json.h"

enum {
    PACKET_COMMANDS_MAX = 128,
    ERRORS_MAX = 1000, /* that are listed */
    MESSAGE_ROOM = 200,
};

struct checker {
    const struct infile *file;
    bool silent; /* but for a complaint about the first error */
    struct gve_file_line line;
    uint32_t commands;
    uint32_t errors;
    bool after_line;          /* the command before, those with a time aside, is an L */
    bool packet;              /* between *S and *E */
    uint32_t packet_commands; /* that it has had */
    uint32_t packet_line;
    uint32_t packet_column;
};

/* Columns count characters: bytes that carry on a character of UTF-8 are none. */
static uint32_t column_of(const struct checker *checker, uint32_t place)
{
    uint32_t column = 1;
    for (uint32_t i = 0; i < place; i++) {
        column += (checker->file->bytes[checker->line.offset + i] & 0xC0U) != 0x80U ? 1U : 0U;
    }
    return column;
}

__attribute__((format(printf, 5, 6))) static void tell(struct checker *checker, uint32_t line, uint32_t column,
                                                       unsigned code, const char *format, ...)
{
    char message[MESSAGE_ROOM];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    checker->errors++;
    if (checker->silent && checker->errors == 1) {
        complain("%s:%" PRIu32 ":%" PRIu32 ": %s; correct it", checker->file->path, line, column, message);
    }
    if (checker->silent || checker->errors > ERRORS_MAX) {
        return;
    }
    (void)printf("%s{\"line\":%" PRIu32 ",\"column\":%" PRIu32 ",\"code\":%u,\"message\":",
                 checker->errors == 1 ? "\n" : ",\n", line, column, code);
    json_print_utf8(message);
    (void)putchar('}');
}

static void put_range(char *room, size_t size, const struct gve_kind *kind)
{
    bool hex = kind->form == GVE_FORM_HEX || kind->form == GVE_FORM_HEX_WORD;
    if (kind->form == GVE_FORM_SINGLE) {
        (void)snprintf(room, size, "a number up to 3.40282347E+38");
    } else if (hex) {
        (void)snprintf(room, size, "%s hexadecimal digits, 00 to %02" PRIX64,
                       kind->form == GVE_FORM_HEX ? "one or two" : "one to eight", (uint64_t)kind->max);
    } else {
        (void)snprintf(room, size, "a number from %" PRId64 " to %" PRId64 "%s", kind->min, kind->max,
                       kind->form == GVE_FORM_NONZERO ? " that is not 0" : "");
    }
}

/* The parameter at a place, as the user has written it. */
static int found_length(const struct gve_file_line *line, uint32_t place)
{
    uint32_t length = 0;
    while (place + length < line->length && line->text[place + length] != ',' && length < 20) {
        length++;
    }
    while (length > 0 && place + length < line->length && (line->text[place + length] & 0xC0U) == 0x80U) {
        length--; /* no part of a character */
    }
    return (int)length;
}

static void tell_unknown(struct checker *checker, uint32_t column, unsigned code)
{
    const struct gve_file_line *line = &checker->line;
    bool spindle = line->address == GVE_ADDRESS_SPINDLE;
    bool bare = !spindle && line->length > 0 && line->text[0] == '7';
    tell(checker, line->number, column, code, "%s has no command that begins like this%s%.*s",
         spindle ? "the spindle" : "the interpolator", bare ? "; to the spindle write !" : "",
         bare ? found_length(line, 0) : 0, (const char *)line->text);
}

static void tell_fault(struct checker *checker, const struct gve_reading *reading)
{
    const struct gve_file_line *line = &checker->line;
    uint32_t place = reading->place;
    char range[MESSAGE_ROOM / 2];
    uint32_t column = column_of(checker, line->place + place);
    unsigned code = gve_fault_code(reading->fault);
    if (reading->fault == GVE_FAULT_UNKNOWN) {
        tell_unknown(checker, column, code);
        return;
    }
    const struct gve_row *row = gve_row(reading->command.opcode);
    if (reading->fault == GVE_FAULT_SURPLUS) {
        tell(checker, line->number, column, code, "%s takes %s%u parameter%s; example: %s", row->text,
             row->most > row->least ? "at most " : "", (unsigned)row->most, row->most == 1 ? "" : "s",
             gve_words(reading->command.opcode)->example);
        return;
    }
    const struct gve_kind *kind = gve_kind(row->parameters[reading->parameter]);
    if (kind->form == GVE_FORM_AXIS) {
        (void)snprintf(range, sizeof range, "an axis: X, Y, Z or A");
    } else {
        put_range(range, sizeof range, kind);
    }
    tell(checker, line->number, column, code, "%s takes %s as parameter %u, found %.*s%s", row->text, range,
         (unsigned)reading->parameter + 1U, found_length(line, place), (const char *)&line->text[place],
         place == line->length ? "nothing" : "");
}

/* ---- packets --------------------------------------------------------------------------------------------------- */

static void begin_packet(struct checker *checker)
{
    checker->packet = true;
    checker->packet_commands = 0;
    checker->packet_line = checker->line.number;
    checker->packet_column = column_of(checker, checker->line.place);
}

static void end_packet(struct checker *checker, int32_t number)
{
    const struct gve_file_line *line = &checker->line;
    if (!checker->packet) {
        tell(checker, line->number, column_of(checker, line->place), GVE_WRONG_SYNTAX,
             "*E without the *S that begins a packet");
    } else if (checker->packet_commands > PACKET_COMMANDS_MAX) {
        tell(checker, line->number, column_of(checker, line->place), GVE_OUT_OF_BOUNDS,
             "the packet has %" PRIu32 " commands, more than %d", checker->packet_commands, PACKET_COMMANDS_MAX);
    } else if ((uint32_t)number != checker->packet_commands) {
        tell(checker, line->number, column_of(checker, line->place + 2), GVE_DAMAGED,
             "the packet has %" PRIu32 " commands, *E says %" PRId32, checker->packet_commands, number);
    } else {
        /* as it should be */
    }
    checker->packet = false;
}

static void follow_packet(struct checker *checker, const struct gve_command *command)
{
    const struct gve_file_line *line = &checker->line;
    const struct gve_row *row = gve_row(command->opcode);
    if (command->opcode == GVE_PACKET_BEGIN) {
        begin_packet(checker);
    } else if (command->opcode == GVE_PACKET_END) {
        end_packet(checker, command->numbers[0]);
    } else if (row->packet == GVE_PACKET_ENDS) {
        checker->packet = false;
    } else if (checker->packet) {
        checker->packet_commands++;
        if (row->packet != GVE_PACKET_TAKEN) {
            tell(checker, line->number, column_of(checker, line->place), GVE_WRONG_SYNTAX,
                 "%s cannot stand in a packet, only C and B can", row->text);
        }
    } else {
        /* outside of packets */
    }
}

/* A wrong command is one of the packet, and a wrong end is its end. */
static void follow_faulty(struct checker *checker, const struct gve_command *command)
{
    checker->packet_commands++;
    if (command->opcode == GVE_PACKET_END) {
        checker->packet = false;
    }
}

/* ---- lines ----------------------------------------------------------------------------------------------------- */

static void check_command(struct checker *checker)
{
    const struct gve_file_line *line = &checker->line;
    uint32_t column = column_of(checker, line->place);
    checker->after_line = checker->after_line && line->timed;
    if (line->wrong != NULL) {
        tell(checker, line->number, column, GVE_WRONG_SYNTAX, "%s", line->wrong);
        return;
    }
    if (line->length > GVE_TEXT_BYTES_MAX) {
        tell(checker, line->number, column, GVE_WRONG_SYNTAX, "the command has %" PRIu32 " characters, more than %d",
             line->length, GVE_TEXT_BYTES_MAX);
        return;
    }
    struct gve_reading reading = gve_command_read(line->text, line->length, (enum gve_address)line->address);
    if (reading.fault != GVE_FAULT_NONE) {
        tell_fault(checker, &reading);
        follow_faulty(checker, &reading.command);
    } else if (!line->timed) {
        follow_packet(checker, &reading.command);
        checker->after_line = reading.command.opcode == GVE_LINE;
    } else {
        /* goes beside the others, in no packet of theirs */
    }
}

/* What has been before an L is known when it is over, of no other motion. */
static void check_probe(struct checker *checker)
{
    const struct gve_file_line *line = &checker->line;
    if (!checker->after_line || line->asked) {
        tell(checker, line->number, column_of(checker, line->place), GVE_WRONG_SYNTAX,
             ";@probe stands right after the L that goes to the sensor");
    }
    checker->after_line = false;
}

static void check_lines(struct checker *checker)
{
    struct gve_file lines = gve_file_of(checker->file);
    while (gve_file_next(&lines, &checker->line)) {
        if (checker->line.probes) {
            check_probe(checker);
        } else {
            checker->commands++;
            check_command(checker);
        }
    }
    if (checker->packet) {
        tell(checker, checker->packet_line, checker->packet_column, GVE_DAMAGED,
             "the packet that begins here has no *E");
    }
}

bool gve_check_is_good(const struct infile *file)
{
    struct checker checker = {.file = file, .silent = true};
    check_lines(&checker);
    return checker.errors == 0;
}

static enum exit_status print_errors(const struct infile *file)
{
    struct checker checker = {.file = file};
    (void)printf("{\"errors\":[");
    check_lines(&checker);
    uint32_t more = checker.errors > ERRORS_MAX ? checker.errors - ERRORS_MAX : 0;
    (void)printf("],\n\"commands\":%" PRIu32 ",\"more\":%" PRIu32 "}\n", checker.commands, more);
    return finish_output();
}

enum exit_status gve_check_file(const char *path)
{
    struct infile file;
    if (!infile_read_text(&file, path)) {
        return EXIT_REFUSED;
    }
    enum exit_status status = print_errors(&file);
    infile_discard(&file);
    return status;
}

static void print_parameters(const struct gve_row *row)
{
    for (unsigned i = 0; i < row->most; i++) {
        const struct gve_kind *kind = gve_kind(row->parameters[i]);
        (void)printf("%s{\"kind\":\"%s\",\"min\":%" PRId64 ",\"max\":%" PRId64 "}", i == 0 ? "" : ",",
                     gve_kind_name(row->parameters[i]), kind->min, kind->max);
    }
}

enum exit_status gve_check_commands(void)
{
    (void)printf("{\"commands\":[");
    for (unsigned opcode = 0; opcode < GVE_OPCODES; opcode++) {
        const struct gve_row *row = gve_row(opcode);
        const struct gve_words *words = gve_words(opcode);
        (void)printf("%s{\"name\":\"%s\",\"text\":\"%s\",\"address\":%u,\"packet\":%u,\"states\":\"%s\",\"least\":%u,",
                     opcode == 0 ? "\n" : ",\n", words->name, row->text, (unsigned)row->address, (unsigned)row->packet,
                     row->states, (unsigned)row->least);
        (void)printf("\"example\":\"%s\",\"answer\":\"%s\",\"parameters\":[", words->example, words->answer);
        print_parameters(row);
        (void)printf("]}");
    }
    (void)printf("]}\n");
    return finish_output();
}
