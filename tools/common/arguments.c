#include "arguments.h"

#include <string.h>

#include "line.h"

bool arguments_read_number(const char *text, struct argument_number range, uint64_t *number)
{
    const char *end = text + strlen(text);
    return line_read_fixed(&text, end, range.decimals, range.most, number) && text == end && *number >= range.least;
}

static bool read_number(const struct argument *row, uint64_t *member, const char *value)
{
    uint64_t number = 0;
    if (!arguments_read_number(value, row->number, &number)) {
        complain("%s %s: not such a number, or out of range; see --help", row->name, value);
        return false;
    }
    *member = number * row->number.factor;
    return true;
}

static bool read_value(const struct argument *row, void *options, const char *value)
{
    void *member = (char *)options + row->offset;
    switch (row->kind) {
    case ARGUMENT_TEXT:
        *(const char **)member = value;
        return true;
    case ARGUMENT_FLAG:
        *(bool *)member = true;
        return true;
    case ARGUMENT_NUMBER:
        return read_number(row, member, value);
    case ARGUMENT_OTHER:
        return row->read(options, value);
    }
    return false;
}

static const struct argument *find_row(const struct argument_table *table, const char *name)
{
    for (size_t i = 0; i < table->count; i++) {
        if (strcmp(table->rows[i].name, name) == 0) {
            return &table->rows[i];
        }
    }
    return NULL;
}

/* Reads an option and the value after it, null for none. False after a complaint. */
static bool read_one(const struct argument_table *table, const struct argument *row, void *options, const char *value)
{
    if (row->kind != ARGUMENT_FLAG && (value == NULL || (value[0] == '\0' && !table->takes_empty))) {
        complain("%s: %s", row->name, table->missing);
        return false;
    }
    return read_value(row, options, value);
}

enum exit_status arguments_read(const struct argument_table *table, void *options, int count, char *const arguments[])
{
    for (int i = 0; i < count; i++) {
        const struct argument *row = find_row(table, arguments[i]);
        if (row == NULL) {
            complain("%s: %s", arguments[i], table->unknown);
            return EXIT_USAGE;
        }
        if (!read_one(table, row, options, i + 1 < count ? arguments[i + 1] : NULL)) {
            return EXIT_USAGE;
        }
        i += row->kind != ARGUMENT_FLAG ? 1 : 0;
    }
    return EXIT_DONE;
}
