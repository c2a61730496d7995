#include "pos_script.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base_tick.h"
#include "complain.h"
#include "line.h"
#include "units.h"

enum {
    MS_DECIMALS = 6,
    FIELDS_MAX = 6,
    FEED_BITS = 16,
    WORD_BITS = 16,
};

/* Nanoseconds: 31 years. */
#define NS_MAX UINT64_C(1000000000000000000)

static const char per_minute[] = "mm/min";

/* The range of a value. */
struct range {
    int64_t min;
    int64_t max;
    const char *wrong;
};

static const struct range any_way = {INT32_MIN, INT32_MAX, "the way or position must be micrometres, 32 bits"};
static const struct range any_accel = {0, UINT16_MAX, "the acceleration must be 0 to 65535 mm/s2"};
static const struct range any_feed = {0, UINT32_MAX, "the feed must be 0 to 4294967295, or 0 to 65535 with mm/min"};
static const struct range any_space = {0, UINT16_MAX, "the space must be 0 to 65535"};
static const struct range any_method = {0, UINT16_MAX, "the method must be 0 to 65535"};
static const struct range any_mp = {0, 1, "mp must be 0 or 1"};
static const struct range any_register = {0, UINT16_MAX, "the register must be 0 to 65535"};
static const struct range any_value = {INT32_MIN, UINT32_MAX, "the value must have 32 bits"};

static const struct row {
    const char *word;
    unsigned least; /* values */
    unsigned most;
    const struct range *ranges[POS_SCRIPT_VALUES];
} rows[POS_SCRIPT_KINDS] = {
    [POS_SCRIPT_INIT] = {"POS_INIT", 0, 1, {&any_space}},
    [POS_SCRIPT_MODE] = {"POS_MODE", 2, 2, {&any_way, &any_accel}},
    [POS_SCRIPT_CONTROL] = {"POS_CONTROL", 1, 2, {&any_feed, &any_mp}},
    [POS_SCRIPT_RESET] = {"POS_RESET", 0, 0, {NULL}},
    [POS_SCRIPT_MODE_ABS] = {"POS_MODE_ABS", 2, 2, {&any_way, &any_accel}},
    [POS_SCRIPT_HOME] = {"POS_HOME", 3, 3, {&any_method, &any_way, &any_accel}},
    [POS_SCRIPT_CAPTURE] = {"POS_CAPTURE", 0, 0, {NULL}},
    [POS_SCRIPT_READ] = {"READ", 0, 0, {NULL}},
    [POS_SCRIPT_SETTING] = {"SETTING", 2, 2, {&any_register, &any_value}},
};

/* The script in whose place plc_pass stands. */
static struct pos_script *playing;

const char *pos_script_word(enum pos_script_kind kind)
{
    return rows[kind].word;
}

/* ---- reading --------------------------------------------------------------------------------------------------- */

struct field {
    const char *at;
    const char *end;
};

static bool is_blank(char byte)
{
    return byte == ' ' || byte == '\t' || byte == '\r';
}

static struct field trim(struct field field)
{
    while (field.at != field.end && is_blank(*field.at)) {
        field.at++;
    }
    while (field.at != field.end && is_blank(field.end[-1])) {
        field.end--;
    }
    return field;
}

/* The fields of a line; one more than there is room for: too many. */
static unsigned split(struct field line, struct field fields[FIELDS_MAX + 1])
{
    unsigned count = 0;
    while (count <= FIELDS_MAX) {
        const char *comma = memchr(line.at, ',', (size_t)(line.end - line.at));
        fields[count++] = trim((struct field){line.at, comma == NULL ? line.end : comma});
        if (comma == NULL) {
            break;
        }
        line.at = comma + 1;
    }
    return count;
}

static bool is_word(struct field field, const char *word)
{
    size_t length = strlen(word);
    return (size_t)(field.end - field.at) == length && memcmp(field.at, word, length) == 0;
}

static bool read_number(struct field field, const struct range *range, int64_t *value)
{
    uint64_t number = 0;
    bool negative = field.at != field.end && *field.at == '-';
    field.at += negative ? 1 : 0;
    if (!line_read_fixed(&field.at, field.end, 0, UINT64_C(1) << 33, &number)) {
        return false;
    }
    *value = negative ? -(int64_t)number : (int64_t)number;
    field = trim(field);
    if (range == &any_feed && is_word(field, per_minute)) {
        *value *= INT64_C(1) << FEED_BITS;
    } else if (field.at != field.end) {
        return false;
    }
    return *value >= range->min && *value <= range->max;
}

static const char *read_values(struct pos_script_line *line, const struct field *fields, unsigned count)
{
    const struct row *row = &rows[line->kind];
    if (count < row->least || count > row->most) {
        return count < row->least ? "too few values" : "too many values";
    }
    line->count = count;
    for (unsigned i = 0; i < count; i++) {
        if (!read_number(fields[i], row->ranges[i], &line->values[i])) {
            return row->ranges[i]->wrong;
        }
    }
    return NULL;
}

static const char *read_kind(struct pos_script_line *line, struct field word)
{
    for (unsigned kind = 0; kind < POS_SCRIPT_KINDS; kind++) {
        if (is_word(word, rows[kind].word)) {
            line->kind = (uint8_t)kind;
            return (kind == POS_SCRIPT_SETTING) == (line->axis == 0) ? NULL : "the axis must be 1 to 4, of SETTING 0";
        }
    }
    return "no such instruction";
}

/* A line that is not blank. Null, or what is wrong with it. */
static const char *read_line(struct pos_script_line *line, struct field text)
{
    static const struct range any_axis = {0, POS_AXES, "the axis must be 1 to 4, of SETTING 0"};
    struct field fields[FIELDS_MAX + 1];
    unsigned count = split(text, fields);
    uint64_t ns = 0;
    int64_t axis = 0;
    if (count < 3 || count > FIELDS_MAX) {
        return "a time, an axis and an instruction with its values are wanted";
    }
    if (!line_read_fixed(&fields[0].at, fields[0].end, MS_DECIMALS, NS_MAX, &ns) || fields[0].at != fields[0].end) {
        return "the time must be milliseconds from 0 with up to 6 decimals";
    }
    if (!read_number(fields[1], &any_axis, &axis)) {
        return any_axis.wrong;
    }
    line->tick = units_ticks_of_ns(ns);
    line->axis = (uint8_t)axis;
    const char *wrong = read_kind(line, fields[2]);
    return wrong != NULL ? wrong : read_values(line, &fields[3], count - 3U);
}

static uint32_t count_lines(const struct infile *file)
{
    uint32_t count = 1;
    for (uint32_t i = 0; i < file->length; i++) {
        count += file->bytes[i] == '\n' ? 1U : 0U;
    }
    return count;
}

/* Takes in one line. False after a complaint. */
static bool take_line(struct pos_script *script, const struct infile *file, struct field text, uint32_t number)
{
    const char *comment = memchr(text.at, '#', (size_t)(text.end - text.at));
    text = trim((struct field){text.at, comment == NULL ? text.end : comment});
    if (text.at == text.end) {
        return true;
    }
    struct pos_script_line *line = &script->lines[script->count];
    *line = (struct pos_script_line){.number = number};
    const char *wrong = read_line(line, text);
    if (wrong == NULL && script->count > 0 && line->tick < line[-1].tick) {
        wrong = "the time goes back";
    }
    if (wrong != NULL) {
        complain("%s:%" PRIu32 ": %s; write ms,axis,INSTRUCTION,values, for example 10,1,POS_MODE,10000,500",
                 file->path, number, wrong);
        return false;
    }
    script->count++;
    return true;
}

bool pos_script_read(struct pos_script *script, const struct infile *file)
{
    *script = (struct pos_script){.lines = calloc(count_lines(file), sizeof *script->lines)};
    if (script->lines == NULL) {
        complain("%s: there is not memory enough for so many lines; make the file shorter", file->path);
        return false;
    }
    struct field rest = {(const char *)file->bytes, (const char *)file->bytes + file->length};
    for (uint32_t number = 1; rest.at != rest.end; number++) {
        const char *newline = memchr(rest.at, '\n', (size_t)(rest.end - rest.at));
        const char *end = newline == NULL ? rest.end : newline;
        if (!take_line(script, file, (struct field){rest.at, end}, number)) {
            pos_script_discard(script);
            return false;
        }
        rest.at = newline == NULL ? rest.end : newline + 1;
    }
    return true;
}

/* ---- playing --------------------------------------------------------------------------------------------------- */

static unsigned write_setting(struct pos_unit *unit, const struct pos_script_line *line)
{
    uint32_t number = (uint32_t)line->values[0];
    uint32_t value = (uint32_t)(uint64_t)line->values[1];
    struct pos_place place;
    bool wide = pos_find(number, &place) && pos_row_is_wide(pos_row(&place));
    const uint16_t words[] = {(uint16_t)(value >> WORD_BITS), (uint16_t)value};
    bool fits = wide || (line->values[1] >= INT16_MIN && line->values[1] <= UINT16_MAX);
    if (!fits) {
        return (unsigned)MODBUS_EXCEPTION_VALUE;
    }
    return (unsigned)positioning_write(unit, number, wide ? 2 : 1, wide ? words : &words[1]);
}

static unsigned execute(struct pos_unit *unit, struct pos_script_line *line)
{
    const int64_t *values = line->values;
    unsigned axis = line->axis;
    switch ((enum pos_script_kind)line->kind) {
    case POS_SCRIPT_INIT:
        return (unsigned)pos_init(unit, axis, line->count > 0 ? (unsigned)values[0] : 0U);
    case POS_SCRIPT_MODE:
        return (unsigned)pos_mode(unit, NULL, (int32_t)values[0], (uint16_t)values[1], axis);
    case POS_SCRIPT_CONTROL:
        return (unsigned)pos_control(unit, NULL, (uint32_t)values[0], line->count > 1 ? (int)values[1] : POS_MP_NIL,
                                     axis);
    case POS_SCRIPT_RESET:
        return (unsigned)pos_reset(unit, axis);
    case POS_SCRIPT_MODE_ABS:
        return (unsigned)pos_mode_abs(unit, NULL, (int32_t)values[0], (uint16_t)values[1], axis);
    case POS_SCRIPT_HOME:
        return (unsigned)pos_home(unit, NULL, (unsigned)values[0], (int32_t)values[1], (uint16_t)values[2], axis);
    case POS_SCRIPT_CAPTURE:
        return (unsigned)pos_capture(unit, axis);
    case POS_SCRIPT_READ:
        pos_read(unit, axis, &line->read);
        return 0;
    case POS_SCRIPT_SETTING:
        return write_setting(unit, line);
    case POS_SCRIPT_KINDS:
        break;
    }
    return 0;
}

void pos_script_play(struct pos_script *script, const struct host_machine *machine)
{
    playing = script;
    if (script != NULL) {
        script->machine = machine;
    }
}

/* In the place of the one in the firmware's library. */
void plc_pass(struct pos_unit *unit)
{
    struct pos_script *script = playing;
    while (script != NULL && script->next < script->count && script->lines[script->next].tick <= script->machine->now) {
        struct pos_script_line *line = &script->lines[script->next++];
        line->result = execute(unit, line);
        line->done_tick = script->machine->now;
    }
}

uint64_t pos_script_pass(void *context)
{
    const struct pos_script *script = context;
    return script->next < script->count ? script->lines[script->next].tick : TICK_NEVER;
}

bool pos_script_is_over(const void *context)
{
    const struct pos_script *script = context;
    return script->next == script->count;
}

void pos_script_discard(struct pos_script *script)
{
    free(script->lines);
    *script = (struct pos_script){.lines = NULL};
}
