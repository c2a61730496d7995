#include "gve_file.h"

#include <stddef.h>
#include <string.h>

#include "line.h"

/* Nanoseconds: 31 years. */
#define NS_MAX UINT64_C(1000000000000000000)

enum {
    MS_DECIMALS = 6,
    S_DECIMALS = 9,
    INTERPOLATOR = '0',
    SPINDLE = '7',
};

struct gve_file gve_file_of(const struct infile *file)
{
    return (struct gve_file){.file = file};
}

static bool is_blank(uint8_t byte)
{
    return byte == ' ' || byte == '\t';
}

static bool is_digit(uint8_t byte)
{
    return byte >= '0' && byte <= '9';
}

static bool is_line_end(uint8_t byte)
{
    return byte == '\n' || byte == '\r';
}

/* Up to the line's end: LF, CR or both; moves on to the next line. */
static uint32_t take_line(struct gve_file *file)
{
    const uint8_t *bytes = file->file->bytes;
    uint32_t end = file->next;
    while (end < file->file->length && !is_line_end(bytes[end])) {
        end++;
    }
    file->next = end + (bytes[end] == '\r' && bytes[end + 1] == '\n' ? 2 : 1);
    return end;
}

/* The first byte that does not belong to what is meant, without comment and blanks at the end. */
static uint32_t find_end(const uint8_t *bytes, uint32_t begin, uint32_t end)
{
    uint32_t last = begin;
    for (uint32_t i = begin; i < end && bytes[i] != ';'; i++) {
        last = is_blank(bytes[i]) ? last : i + 1;
    }
    return last;
}

static uint32_t skip_blanks(const uint8_t *bytes, uint32_t begin, uint32_t end)
{
    while (begin < end && is_blank(bytes[begin])) {
        begin++;
    }
    return begin;
}

/* Goes past @ and a time in ms. */
static uint32_t take_time(const uint8_t *bytes, uint32_t begin, uint32_t end, struct gve_file_line *line)
{
    const char *at = (const char *)&bytes[begin + 1];
    if (bytes[begin] != '@' || begin + 1 == end || !is_digit(bytes[begin + 1])) {
        return begin;
    }
    line->timed = true;
    if (!line_read_fixed(&at, (const char *)&bytes[end], MS_DECIMALS, NS_MAX, &line->ns)) {
        line->wrong = "the time has more than 6 decimals, none after its point, or is past 31 years";
        return begin;
    }
    uint32_t next = begin + 1 + (uint32_t)(at - (const char *)&bytes[begin + 1]);
    uint32_t command = skip_blanks(bytes, next, end);
    if (command == next || command == end) {
        line->wrong = "after @ and a time in ms come a blank and a command";
        return begin;
    }
    return command;
}

/* Goes past ! and an address. */
static uint32_t take_address(const uint8_t *bytes, uint32_t begin, uint32_t end, struct gve_file_line *line)
{
    if (begin == end || bytes[begin] != '!' || line->wrong != NULL) {
        return begin;
    }
    uint8_t address = begin + 1 < end ? bytes[begin + 1] : 0;
    if (address == INTERPOLATOR || address == SPINDLE) {
        line->address = address == SPINDLE ? GVE_ADDRESS_SPINDLE : GVE_ADDRESS_INTERPOLATOR;
        return begin + 2;
    }
    line->wrong = "after ! comes the address of the interpolator, 0, or of the spindle, 7";
    return begin;
}

static bool begins_with(const uint8_t *bytes, uint32_t begin, uint32_t end, const char *text)
{
    size_t length = strlen(text);
    return end - begin >= length && memcmp(&bytes[begin], text, length) == 0;
}

/* Reads ;@wait and seconds into the time that the host waits before the next command. */
static bool take_wait(struct gve_file *file, uint32_t begin, uint32_t end)
{
    static const char mark[] = ";@wait ";
    uint64_t ns = 0;
    const uint8_t *bytes = file->file->bytes;
    const char *at = (const char *)&bytes[begin] + sizeof mark - 1U;
    if (!begins_with(bytes, begin, end, mark) ||
        !line_read_fixed(&at, (const char *)&bytes[end], S_DECIMALS, NS_MAX, &ns) || at != (const char *)&bytes[end]) {
        return false;
    }
    file->wait_ns = file->wait_ns + ns > NS_MAX ? NS_MAX : file->wait_ns + ns;
    file->asks = true;
    return true;
}

static bool take_pause(struct gve_file *file, uint32_t begin, uint32_t end)
{
    static const char mark[] = ";@pause";
    const uint8_t *bytes = file->file->bytes;
    uint32_t after = begin + (uint32_t)sizeof mark - 1U;
    if (!begins_with(bytes, begin, end, mark) || (after != end && !is_blank(bytes[after]))) {
        return false;
    }
    file->asks = true;
    return true;
}

static bool is_probe(const uint8_t *bytes, uint32_t begin, uint32_t end)
{
    static const char mark[] = ";@probe";
    return begins_with(bytes, begin, end, mark) && end - begin == sizeof mark - 1U;
}

/* Reads a comment. True: it asks for more of the host than to wait. */
static bool take_comment(struct gve_file *file, uint32_t begin, uint32_t stop, struct gve_file_line *line)
{
    const uint8_t *bytes = file->file->bytes;
    uint32_t first = skip_blanks(bytes, begin, stop);
    uint32_t end = stop;
    while (end > first && is_blank(bytes[end - 1U])) {
        end--;
    }
    if (!begins_with(bytes, first, end, ";@") || take_wait(file, first, end) || take_pause(file, first, end)) {
        return false;
    }
    line->place = first - begin;
    line->probes = is_probe(bytes, first, end);
    if (!line->probes) {
        line->wrong = "for the host there are ;@wait with seconds, ;@pause with a text, and ;@probe";
    }
    return true;
}

static void note_asked(struct gve_file *file, struct gve_file_line *line)
{
    line->asked = file->asks && !line->timed;
    file->asks = file->asks && line->timed;
}

bool gve_file_next(struct gve_file *file, struct gve_file_line *line)
{
    const uint8_t *bytes = file->file->bytes;
    while (file->next < file->file->length) {
        uint32_t begin = file->next;
        uint32_t stop = take_line(file);
        uint32_t end = find_end(bytes, begin, stop);
        uint32_t first = skip_blanks(bytes, begin, end);
        uint32_t number = line->number + 1;
        *line = (struct gve_file_line){.offset = begin, .number = number, .address = GVE_ADDRESS_INTERPOLATOR};
        if (first < end) {
            first = take_time(bytes, first, end, line);
            first = take_address(bytes, first, end, line);
            line->place = first - begin;
            line->length = end - first;
            line->text = &bytes[first];
            line->wait_ns = line->timed ? 0 : file->wait_ns;
            file->wait_ns = line->timed ? file->wait_ns : 0;
            note_asked(file, line);
            return true;
        }
        if (take_comment(file, begin, stop, line)) {
            note_asked(file, line);
            return true;
        }
    }
    return false;
}
