#include "rs485.h"

#include <stdlib.h>
#include <string.h>

#include "board.h"
#include "complain.h"
#include "infile.h"
#include "line.h"

enum {
    FRAME_BITS = 10,
    HALF_BITS_TO_STOP = 19, /* half bits from the start to the middle of the stop bit */
    LOG_BYTES_MAX = 64,
    PS_DECIMALS = 9, /* of milliseconds */
    LOG_DECIMALS = 6,
    TOLERANCE_PERCENT = 3,
};

#define MS_MAX UINT64_C(1000000000)

static uint64_t half_bits_ps(const struct board *board, uint64_t half_bits)
{
    return vtime_scale(half_bits, VTIME_PS_PER_SECOND / 2U, board->options->baud);
}

static bool append(struct rs485 *line, struct rs485_byte byte)
{
    if (line->bytes == line->room) {
        size_t room = 2U * line->room + 256U;
        struct rs485_byte *list = realloc(line->byte, room * sizeof *list);
        if (list == NULL) {
            return false;
        }
        line->byte = list;
        line->room = room;
    }
    line->byte[line->bytes++] = byte;
    return true;
}

static int hex_digit(char character)
{
    static const char digits[] = "0123456789abcdef";
    const char *found = character == '\0' ? NULL : strchr(digits, character | 0x20);
    return found == NULL ? -1 : (int)(found - digits);
}

static bool is_blank(char character)
{
    return character == ' ' || character == '\t' || character == '\r' || character == ',';
}

/* The marks behind a byte. */
static uint8_t read_damage(const char **at, const char *end)
{
    uint8_t damage = 0;
    for (; *at != end && (**at == '*' || **at == '~'); (*at)++) {
        damage |= **at == '*' ? USART_FRAMING : USART_NOISE;
    }
    return damage;
}

/* Takes in the bytes of a line, which ends at a newline or a comment. */
static bool read_bytes(struct rs485 *line, uint64_t start_ps, const char **at, const char *end)
{
    while (*at != end && **at != '\n' && **at != '#') {
        if (is_blank(**at)) {
            (*at)++;
            continue;
        }
        int high = hex_digit(**at);
        int low = *at + 1 == end ? -1 : hex_digit((*at)[1]);
        if (high < 0 || low < 0) {
            return false;
        }
        *at += 2;
        uint8_t damage = read_damage(at, end);
        if (!append(line,
                    (struct rs485_byte){.start_ps = start_ps, .value = (uint8_t)(high << 4 | low), .damage = damage})) {
            return false;
        }
    }
    return true;
}

/* A line of a script up to its newline or its comment. */
static bool read_line(struct rs485 *line, const char **at, const char *end)
{
    uint64_t ps = 0;
    while (*at != end && is_blank(**at)) {
        (*at)++;
    }
    bool empty = *at == end || **at == '#' || **at == '\n';
    return empty ||
           (line_read_fixed(at, end, PS_DECIMALS, MS_MAX * VTIME_PS_PER_MS, &ps) && read_bytes(line, ps, at, end));
}

static bool read_script(struct rs485 *line, const struct infile *file)
{
    const char *at = (const char *)file->bytes;
    const char *end = at + file->length;
    for (unsigned number = 1; at != end; number++) {
        if (!read_line(line, &at, end)) {
            complain("%s:%u: not a time and bytes; write ms and hexadecimal bytes, for example 10.5 02 41 0D",
                     file->path, number);
            return false;
        }
        while (at != end && *at != '\n') {
            at++;
        }
        at += at != end ? 1 : 0;
    }
    return true;
}

static void plan(struct board *board)
{
    struct rs485 *line = &board->line;
    if (line->arriving || line->next == line->bytes) {
        return;
    }
    uint64_t start = line->byte[line->next].start_ps;
    line->arrival_ps = start > line->free_ps ? start : line->free_ps;
    events_set_ps(board, EVENT_LINE, line->arrival_ps);
}

bool rs485_open(struct board *board)
{
    struct rs485 *line = &board->line;
    struct infile file;
    if (!outfile_open(&line->log, board->options->line_log)) {
        return false;
    }
    if (board->options->line_script == NULL) {
        return true;
    }
    if (!infile_read(&file, board->options->line_script)) {
        return false;
    }
    bool good = read_script(line, &file);
    infile_discard(&file);
    plan(board);
    return good;
}

bool rs485_close(struct board *board)
{
    return outfile_close(&board->line.log) && outfile_publish(&board->line.log);
}

void rs485_discard(struct board *board)
{
    outfile_discard(&board->line.log);
    free(board->line.byte);
    board->line.byte = NULL;
}

void rs485_say(struct board *board, uint8_t value)
{
    (void)append(&board->line, (struct rs485_byte){.start_ps = board_now_ps(board), .value = value});
    plan(board);
}

/* Without a pin for the driver, it is always on and the bus full-duplex. */
static bool has_driver(const struct board *board)
{
    return pins_is_connected(&board->pins, SIGNAL_DRIVER);
}

static bool driver_is_on(const struct board *board)
{
    return has_driver(board) && board->recorder.level[SIGNAL_DRIVER];
}

void rs485_event(struct board *board, uint64_t cycle)
{
    struct rs485 *line = &board->line;
    const struct rs485_byte *byte = &line->byte[line->next];
    if (!line->arriving) {
        line->arriving = true;
        line->disturbed = driver_is_on(board);
        events_set_ps(board, EVENT_LINE, line->arrival_ps + half_bits_ps(board, HALF_BITS_TO_STOP));
        return;
    }
    if (line->disturbed) {
        line->collisions++;
    } else {
        line->heard++;
        usart_receive(board, board->pins.usart, byte->value, byte->damage, board->options->baud, cycle);
    }
    line->arriving = false;
    line->free_ps = line->arrival_ps + half_bits_ps(board, UINT64_C(2) * FRAME_BITS);
    line->next++;
    plan(board);
}

void rs485_begin_sent(struct board *board, unsigned usart, uint64_t cycle)
{
    struct rs485 *line = &board->line;
    (void)cycle;
    if (usart == board->pins.usart) {
        line->sending = true;
        line->driven_throughout = !has_driver(board) || driver_is_on(board);
    }
}

static bool rate_fits(const struct board *board)
{
    uint64_t baud = usart_baud(board, board->pins.usart);
    uint64_t wanted = board->options->baud;
    return 100U * baud >= (100U - TOLERANCE_PERCENT) * wanted && 100U * baud <= (100U + TOLERANCE_PERCENT) * wanted;
}

static void log_byte(struct board *board, uint8_t value, bool good, uint64_t begin_cycle)
{
    struct rs485 *line = &board->line;
    static const char digits[] = "0123456789ABCDEF";
    if (!outfile_is_open(&line->log)) {
        return;
    }
    uint64_t ns = vtime_ps_of_cycle(&board->time, begin_cycle) / VTIME_PS_PER_NS;
    char *at = line_put_fixed(outfile_reserve(&line->log, LOG_BYTES_MAX), ns, LOG_DECIMALS);
    *at++ = ' ';
    *at++ = digits[value >> 4];
    *at++ = digits[value & 15];
    if (!good) {
        *at++ = '*';
    }
    *at++ = '\n';
    outfile_commit(&line->log, at);
}

void rs485_end_sent(struct board *board, unsigned usart, uint8_t value, bool connected, uint64_t begin_cycle,
                    uint64_t cycle)
{
    struct rs485 *line = &board->line;
    if (usart != board->pins.usart) {
        return;
    }
    bool good = connected && line->driven_throughout && rate_fits(board);
    line->sending = false;
    line->sent_end_cycle = cycle;
    line->sent += good ? 1U : 0U;
    line->unheard += good ? 0U : 1U;
    log_byte(board, value, good, begin_cycle);
    if (good) {
        tty_send(board, value);
    }
}

void rs485_note_driver(struct board *board, bool on, uint64_t cycle)
{
    struct rs485 *line = &board->line;
    if (on) {
        line->disturbed = true;
        return;
    }
    line->driven_throughout = false;
    if (line->sent_end_cycle != 0 && !line->sending) {
        uint64_t ps = vtime_ps_of_cycle(&board->time, cycle) - vtime_ps_of_cycle(&board->time, line->sent_end_cycle);
        line->release_most_ps = ps > line->release_most_ps ? ps : line->release_most_ps;
    }
}
