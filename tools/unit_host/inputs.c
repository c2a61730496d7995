#include "inputs.h"

#include <stdlib.h>
#include <string.h>

#include "base_limits.h"
#include "complain.h"
#include "infile.h"
#include "line.h"
#include "units.h"

enum {
    MS_DECIMALS = 6
};

/* Nanoseconds: 31 years. */
#define NS_MAX UINT64_C(1000000000000000000)

/* An entry and where it stands: qsort alone keeps no order among equals. */
struct entry {
    struct host_input input;
    uint32_t line;
};

struct entries {
    const struct unit_kind *kind;
    struct entry *list;
    uint32_t length;
    uint32_t room;
};

static const char *skip_blanks(const char *at, const char *end)
{
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\r')) {
        at++;
    }
    return at;
}

/* Reads one field and what must follow: a comma, or with `last` the end of the line. */
static bool read_field(const char **at, const char *end, unsigned decimals, uint64_t max, bool last, uint64_t *value)
{
    *at = skip_blanks(*at, end);
    if (!line_read_fixed(at, end, decimals, max, value)) {
        return false;
    }
    *at = skip_blanks(*at, end);
    if (last) {
        return *at == end;
    }
    if (*at == end || **at != ',') {
        return false;
    }
    (*at)++;
    return true;
}

/* Reads a line that is not blank. Null, or what is wrong with it. */
static const char *read_line(const char *at, const char *end, const struct unit_kind *kind, struct host_input *input)
{
    uint64_t ns = 0;
    uint64_t number = 0;
    uint64_t level = 0;
    if (!read_field(&at, end, MS_DECIMALS, NS_MAX, false, &ns)) {
        return "the time must be milliseconds from 0 with up to 6 decimals, then a comma";
    }
    if (!read_field(&at, end, 0, UNIT_INPUTS, false, &number) || !unit_kind_has_input(kind, number)) {
        return kind->inputs_wrong;
    }
    if (!read_field(&at, end, 0, 1, true, &level)) {
        return "the level must be 0 or 1, then the end of the line";
    }
    bool turned = ((unsigned)kind->inputs_turned >> (number - 1U) & 1U) != 0;
    *input =
        (struct host_input){.tick = units_ticks_of_ns(ns), .input = (uint8_t)number, .level = (level != 0) != turned};
    return NULL;
}

static bool entries_append(struct entries *entries, const struct entry *entry)
{
    if (entries->length == entries->room) {
        uint32_t room = 2U * entries->room + 64U;
        struct entry *list = realloc(entries->list, room * sizeof *list);
        if (list == NULL) {
            return false;
        }
        entries->list = list;
        entries->room = room;
    }
    entries->list[entries->length++] = *entry;
    return true;
}

static int compare_entries(const void *a, const void *b)
{
    const struct entry *one = a;
    const struct entry *other = b;
    if (one->input.tick != other->input.tick) {
        return one->input.tick < other->input.tick ? -1 : 1;
    }
    return one->line < other->line ? -1 : 1;
}

/* Takes in one line, which ends at a comment or at its end. Null, or what is wrong. */
static const char *entries_read_line(struct entries *entries, const char *at, const char *end, uint32_t line)
{
    const char *comment = memchr(at, '#', (size_t)(end - at));
    end = comment == NULL ? end : comment;
    if (skip_blanks(at, end) == end) {
        return NULL;
    }
    struct entry entry = {.line = line};
    const char *wrong = read_line(at, end, entries->kind, &entry.input);
    if (wrong == NULL && !entries_append(entries, &entry)) {
        wrong = "there is not memory enough for so many lines";
    }
    return wrong;
}

static bool entries_read(struct entries *entries, const struct infile *file)
{
    const char *at = (const char *)file->bytes;
    const char *file_end = at + file->length;
    for (uint32_t line = 1; at != file_end; line++) {
        const char *newline = memchr(at, '\n', (size_t)(file_end - at));
        const char *end = newline == NULL ? file_end : newline;
        const char *wrong = entries_read_line(entries, at, end, line);
        if (wrong != NULL) {
            complain("%s:%u: %s; write ms,input,level, for example 350.5,3,1", file->path, (unsigned)line, wrong);
            return false;
        }
        at = newline == NULL ? file_end : newline + 1;
    }
    return true;
}

/* The sorted entries without their lines. */
static bool inputs_fill(struct inputs *inputs, const struct entries *entries, const char *path)
{
    inputs->script = calloc((size_t)entries->length + 1U, sizeof *inputs->script);
    if (inputs->script == NULL) {
        complain("%s: there is not memory enough for so many lines; make the file shorter", path);
        return false;
    }
    if (entries->length > 0) {
        qsort(entries->list, entries->length, sizeof *entries->list, compare_entries);
    }
    for (uint32_t i = 0; i < entries->length; i++) {
        inputs->script[i] = entries->list[i].input;
    }
    inputs->length = entries->length;
    return true;
}

bool inputs_read(struct inputs *inputs, const char *path, const struct unit_kind *kind)
{
    *inputs = (struct inputs){.script = NULL};
    struct infile file;
    if (path == NULL) {
        return true;
    }
    if (!infile_read_text(&file, path)) {
        return false;
    }
    struct entries entries = {.kind = kind};
    bool good = entries_read(&entries, &file) && inputs_fill(inputs, &entries, path);
    free(entries.list);
    infile_discard(&file);
    return good;
}

void inputs_discard(struct inputs *inputs)
{
    free(inputs->script);
    *inputs = (struct inputs){.script = NULL};
}
