#include "rs485.h"

#include <stdlib.h>
#include <string.h>

#include "complain.h"
#include "infile.h"
#include "line.h"

enum {
    LOG_BYTES_MAX = 64,
    PS_DECIMALS = 9, /* of milliseconds */
    LOG_DECIMALS = 6,
    TOLERANCE_PERCENT = 3,
};

#define MS_MAX UINT64_C(1000000000)

static uint64_t half_bits_ps(const struct rs485 *line, uint64_t half_bits)
{
    return vtime_scale(half_bits, VTIME_PS_PER_SECOND / 2U, line->wires.baud);
}

/* The number of the first stop bit, that of the start bit being 0. */
static unsigned stop_bit(const struct rs485 *line)
{
    bool parity = line->wires.format == USART_8E1 || line->wires.format == USART_8O1;
    return parity ? 10 : 9;
}

/* The level of a bit of the byte on the bus. */
static bool bit_level(const struct rs485 *line, unsigned bit)
{
    const struct rs485_byte *byte = &line->byte[line->next];
    if (bit == stop_bit(line)) {
        return (byte->damage & USART_FRAMING) == 0;
    }
    if (bit == 9) {
        return usart_ninth_bit(line->wires.format, byte->value) != ((byte->damage & USART_PARITY) != 0);
    }
    return bit != 0 && (byte->value >> (bit - 1U) & 1) != 0;
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

/* The marks after a byte. */
static uint8_t read_damage(const char **at, const char *end)
{
    uint8_t damage = 0;
    for (; *at != end && (**at == '*' || **at == '~' || **at == '!'); (*at)++) {
        damage |= **at == '*' ? USART_FRAMING : 0;
        damage |= **at == '~' ? USART_NOISE : 0;
        damage |= **at == '!' ? USART_PARITY : 0;
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

static void plan(struct rs485 *line)
{
    if (line->arriving || line->next == line->bytes) {
        return;
    }
    uint64_t start = line->byte[line->next].start_ps;
    line->arrival_ps = start > line->free_ps ? start : line->free_ps;
    clock_set_ps(line->wires.clock, EVENT_LINE, line->arrival_ps);
}

bool rs485_open(struct rs485 *line, const char *script, const char *log)
{
    struct infile file;
    line->driver_on = line->wires.pins->low[SIGNAL_DRIVER];
    if (!outfile_open(&line->log, log)) {
        return false;
    }
    if (script == NULL) {
        return true;
    }
    if (!infile_read(&file, script)) {
        return false;
    }
    bool good = read_script(line, &file);
    infile_discard(&file);
    plan(line);
    return good;
}

bool rs485_close(struct rs485 *line)
{
    return outfile_close(&line->log) && outfile_publish(&line->log);
}

void rs485_discard(struct rs485 *line)
{
    outfile_discard(&line->log);
    free(line->byte);
    line->byte = NULL;
}

void rs485_say(struct rs485 *line, uint8_t value)
{
    (void)append(line, (struct rs485_byte){.start_ps = clock_now_ps(line->wires.clock), .value = value});
    plan(line);
}

/* Without a pin for the driver, it is always on and the bus full-duplex. */
static bool has_driver(const struct rs485 *line)
{
    return pins_is_connected(line->wires.pins, SIGNAL_DRIVER);
}

static bool driver_is_on(const struct rs485 *line)
{
    return has_driver(line) && line->driver_on;
}

static void set_level(const struct rs485 *line, bool level, uint64_t cycle)
{
    if (!line->disturbed) {
        usart_set_level(line->wires.usart, level, cycle);
    }
}

static void begin_byte(struct rs485 *line, uint64_t cycle)
{
    line->arriving = true;
    line->disturbed = driver_is_on(line);
    line->bit = 0;
    set_level(line, true, cycle); /* as the bus has been since the last byte */
}

/* A bit begins; next comes the one that differs, or the middle of the stop bit. */
static void show_bit(struct rs485 *line, uint64_t cycle)
{
    unsigned stop = stop_bit(line);
    bool level = bit_level(line, line->bit);
    set_level(line, level, cycle);
    do {
        line->bit++;
    } while (line->bit <= stop && bit_level(line, line->bit) == level);
    uint64_t half_bits = line->bit <= stop ? UINT64_C(2) * line->bit : UINT64_C(2) * stop + 1U;
    clock_set_ps(line->wires.clock, EVENT_LINE, line->arrival_ps + half_bits_ps(line, half_bits));
}

static void end_byte(struct rs485 *line, uint64_t cycle)
{
    const struct rs485_byte *byte = &line->byte[line->next];
    set_level(line, true, cycle);
    if (line->disturbed) {
        line->collisions++;
    } else {
        line->heard++;
        usart_receive(line->wires.usart, byte->value, byte->damage, line->wires.baud, line->wires.format, cycle);
    }
    line->arriving = false;
    line->free_ps = line->arrival_ps + half_bits_ps(line, UINT64_C(2) * usart_bits(line->wires.format));
    line->next++;
    plan(line);
}

static void on_rs485_event(void *model, uint64_t cycle)
{
    struct rs485 *line = model;
    if (!line->arriving) {
        begin_byte(line, cycle);
    }
    if (line->bit <= stop_bit(line)) {
        show_bit(line, cycle);
    } else {
        end_byte(line, cycle);
    }
}

static void on_begin(void *model)
{
    struct rs485 *line = model;
    line->sending = true;
    line->driven_throughout = !has_driver(line) || driver_is_on(line);
}

static void on_low(void *model)
{
    struct rs485 *line = model;
    line->breaks += !has_driver(line) || driver_is_on(line) ? 1U : 0U;
}

static bool rate_fits(const struct rs485 *line)
{
    uint64_t baud = usart_baud(line->wires.usart);
    uint64_t wanted = line->wires.baud;
    return 100U * baud >= (100U - TOLERANCE_PERCENT) * wanted && 100U * baud <= (100U + TOLERANCE_PERCENT) * wanted;
}

static void log_byte(struct rs485 *line, uint8_t value, bool good, uint64_t begin_cycle)
{
    static const char digits[] = "0123456789ABCDEF";
    if (!outfile_is_open(&line->log)) {
        return;
    }
    uint64_t ns = clock_ps_of_cycle(line->wires.clock, begin_cycle) / VTIME_PS_PER_NS;
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

static void on_end(void *model, struct usart_sent sent)
{
    struct rs485 *line = model;
    bool good = sent.connected && line->driven_throughout && rate_fits(line) &&
                usart_format(line->wires.usart) == line->wires.format;
    line->sending = false;
    line->sent_end_cycle = sent.end;
    line->sent += good ? 1U : 0U;
    line->unheard += good ? 0U : 1U;
    log_byte(line, sent.value, good, sent.begin);
    if (good && line->wires.listener.hear != NULL) {
        line->wires.listener.hear(line->wires.listener.model, sent.value);
    }
}

void rs485_note_driver(struct rs485 *line, bool on, uint64_t cycle)
{
    line->driver_on = on;
    if (on) {
        usart_set_level(line->wires.usart, true, cycle); /* the receiver of the bus is off */
        line->disturbed = true;
        return;
    }
    line->driven_throughout = false;
    if (line->sent_end_cycle != 0 && !line->sending) {
        uint64_t ps =
            clock_ps_of_cycle(line->wires.clock, cycle) - clock_ps_of_cycle(line->wires.clock, line->sent_end_cycle);
        line->release_most_ps = ps > line->release_most_ps ? ps : line->release_most_ps;
    }
}

void rs485_init(struct rs485 *line, struct rs485_wires wires)
{
    line->wires = wires;
    wires.usart->listener = (struct usart_listener){.model = line, .begin = on_begin, .low = on_low, .end = on_end};
    clock_attach(wires.clock, EVENT_LINE, on_rs485_event, line);
}
