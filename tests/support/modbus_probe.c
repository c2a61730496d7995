/*
 * The server and the registers of a positioning unit, spoken to in whole frames: what the document's frames and another
 * implementation of Modbus are held against. Nothing moves.
 *
 * Comes in on standard input, line by line: the bytes of a frame in hexadecimal; or `=`, the number of a register, a
 * blank and a number, which that register has then, both words of it. Goes out, a line a frame: the bytes of the
 * answer, or none. The unit has address 1. Exit status 2: the input is no such thing.
 */
#include <stdio.h>
#include <stdlib.h>

#include "pos_bench.h"

enum {
    LINE_BYTES_MAX = 2 * 300 + 2,
};

/* 19 200 Bd, 8E1. */
#define CHARACTER_TICKS ((uint64_t)48125)
#define SILENCE_TICKS ((uint64_t)4 * TICKS_PER_MS)

static struct pos_bench bench;
static uint64_t tick;

static _Noreturn void complain(const char *what)
{
    (void)fprintf(stderr, "modbus-probe: %s\n", what);
    exit(2);
}

static void set_register(const char *line)
{
    char *end;
    struct pos_place place;
    unsigned long number = strtoul(line, &end, 10);
    unsigned long value = strtoul(end, &end, 10);
    if (*end != '\n' || !pos_find((uint32_t)number, &place)) {
        complain("no number of a register and no value");
    }
    *pos_registers_at(&bench.registers, &place) = (uint32_t)value;
}

static void take_frame(const char *line)
{
    for (; *line != '\n' && *line != '\0'; line += 2) {
        char digits[3] = {line[0], line[1], '\0'};
        char *end;
        uint8_t value = (uint8_t)strtoul(digits, &end, 16);
        if (end != digits + 2) {
            complain("no bytes in hexadecimal");
        }
        tick += CHARACTER_TICKS;
        pos_bench_take(&bench, &(struct hal_line_byte){.tick = tick, .value = value});
    }
    tick += SILENCE_TICKS;
    pos_bench_poll(&bench, tick);
}

static void print_answer(void)
{
    for (; modbus_is_sending(&bench.server); modbus_advance(&bench.server)) {
        (void)printf("%02x", (unsigned)modbus_byte(&bench.server));
    }
    (void)printf("\n");
}

int main(void)
{
    char line[LINE_BYTES_MAX];
    pos_bench_init(&bench, 1, tick);
    tick += SILENCE_TICKS;
    pos_bench_poll(&bench, tick);
    while (fgets(line, sizeof line, stdin) != NULL) {
        if (line[0] == '=') {
            set_register(&line[1]);
        } else {
            take_frame(line);
            print_answer();
        }
    }
    return 0;
}
