/*
 * A unit that has just been switched on, spoken to in whole messages: what the examples of the documents are tested
 * with.
 *
 * Comes in on standard input, line by line: the bytes of a request in hexadecimal, or a number of milliseconds with `+`
 * before it, for which the unit then runs. Goes out, a line a request: the bytes of the answer. The argument is
 * the version that the unit tells. Exit status 2: the input is no such thing.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host_machine.h"
#include "unit.h"

enum { LINE_BYTES_MAX = 2 * PROTOCOL_REQUEST_BYTES_MAX + 2, RUN_MS_MAX = 3600000 };

static _Noreturn void complain(const char *what)
{
    (void)fprintf(stderr, "message-probe: %s\n", what);
    exit(2);
}

static uint64_t main_pass(void *context)
{
    return unit_poll(context);
}

static void run(struct host_machine *machine, struct unit *unit, const char *number)
{
    char *end;
    unsigned long ms = strtoul(number, &end, 10);
    if (*end != '\0' || ms > RUN_MS_MAX) {
        complain("no number of milliseconds");
    }
    host_machine_run(machine, machine->now + (uint64_t)ms * TICKS_PER_MS, main_pass, NULL, unit);
}

static uint32_t read_bytes(const char *line, uint8_t bytes[PROTOCOL_REQUEST_BYTES_MAX])
{
    uint32_t length = 0;
    for (; line[2U * length] != '\0'; length++) {
        char digits[3] = {line[2U * length], line[2U * length + 1U], '\0'};
        char *end;
        bytes[length] = (uint8_t)strtoul(digits, &end, 16);
        if (end != digits + 2) {
            complain("no bytes in hexadecimal");
        }
    }
    return length;
}

static void ask(struct unit *unit, const char *line)
{
    static uint8_t request[PROTOCOL_REQUEST_BYTES_MAX];
    static uint8_t answer[PROTOCOL_ANSWER_BYTES_MAX];
    uint32_t length = unit_message(unit, request, read_bytes(line, request), answer);
    for (uint32_t i = 0; i < length; i++) {
        (void)printf("%02x", answer[i]);
    }
    (void)printf("\n");
}

int main(int argc, char **argv)
{
    static struct host_machine machine;
    static struct unit unit;
    static char line[LINE_BYTES_MAX];

    host_machine_init(&machine, 0);
    host_machine_select(&machine);
    unit_init(&unit);
    unit.protocol.version = argc > 1 ? argv[1] : UNIT_VERSION;
    unit_start(&unit);
    while (fgets(line, (int)sizeof line, stdin) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        if (line[0] == '+') {
            run(&machine, &unit, line + 1);
        } else {
            ask(&unit, line);
        }
    }
    return 0;
}
