#include "base_crc32.h"
#include "base_tick.h"
#include "bringup.h"
#include "hal_board.h"
#include "hal_line.h"
#include "hal_time.h"

/* CRC of the bytes of an answer. */
static uint32_t sum;

enum {
    SUM_DIGITS = 8,
    DIGITS_MAX = 10
};

static void put(char byte)
{
    const uint8_t sent = (uint8_t)byte;
    sum = crc32_append(sum, &sent, 1);
    while (!hal_line_write(sent)) {
        hal_board_idle(hal_time_now() + TICKS_PER_MS);
    }
}

static void put_text(const char *text)
{
    while (*text != '\0') {
        put(*text++);
    }
}

void say_begin(void)
{
    sum = 0;
}

void say_name(const char *name)
{
    put_text(name);
}

void say_word(const char *word)
{
    put(' ');
    put_text(word);
}

void say_decimal(uint32_t value)
{
    char digits[DIGITS_MAX];
    unsigned count = 0;
    do {
        digits[count++] = (char)('0' + value % 10U);
        value /= 10U;
    } while (value != 0);
    put(' ');
    while (count > 0) {
        put(digits[--count]);
    }
}

void say_hex(uint32_t value, unsigned digits)
{
    put(' ');
    while (digits-- > 0) {
        put("0123456789abcdef"[value >> 4U * digits & 0xFU]);
    }
}

void say_line_end(void)
{
    put('\n');
}

void say_number(const char *name, uint32_t value)
{
    say_name(name);
    say_decimal(value);
    say_line_end();
}

static void put_ending(const char *what, char command)
{
    put_text(what);
    put(' ');
    put(command);
}

void say_end(char command)
{
    uint32_t of_answer = sum;
    put_ending("end", command);
    say_hex(of_answer, SUM_DIGITS);
    say_line_end();
}

void say_error(char command, const char *why)
{
    put_ending("error", command);
    say_word(why);
    say_line_end();
}

void say_wait(void)
{
    while (!hal_line_is_idle()) {
        hal_board_idle(hal_time_now() + TICKS_PER_MS);
    }
}

void bringup_wait(uint32_t milliseconds)
{
    uint64_t end = hal_time_now() + (uint64_t)milliseconds * TICKS_PER_MS;
    while (hal_time_now() < end) {
        hal_board_idle(end);
    }
}
