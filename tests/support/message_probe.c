/*
 * A unit that has just been switched on, spoken to in whole messages: what the examples of the documents are tested
 * with.
 *
 * Comes in on standard input, line by line: the bytes of a request in hexadecimal, or a number of milliseconds with `+`
 * before it, for which the unit then runs. Goes out, a line a request: the bytes of the answer. The arguments are the
 * version that the unit tells, and its time at the start. Exit status 1: the judge complains, 2: the input is no such
 * thing.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host_machine.h"
#include "judge_unit.h"
#include "rkm04.h"

enum {
    LINE_BYTES_MAX = 2 * MESSAGES_REQUEST_BYTES_MAX + 2,
    RUN_MS_MAX = 3600000
};

static _Noreturn void complain(const char *what)
{
    (void)fprintf(stderr, "message-probe: %s\n", what);
    exit(2);
}

struct probe {
    struct judged_unit judged;
    struct host_machine machine;
    struct rkm04 unit;
    struct judge judge;
};

static void run(struct probe *probe, const char *number)
{
    struct host_machine *machine = &probe->machine;
    char *end;
    unsigned long ms = strtoul(number, &end, 10);
    if (*end != '\0' || ms > RUN_MS_MAX) {
        complain("no number of milliseconds");
    }
    host_machine_run(machine, machine->now + (uint64_t)ms * TICKS_PER_MS, judge_unit_pass, NULL, probe);
}

static uint32_t read_bytes(const char *line, uint8_t bytes[MESSAGES_REQUEST_BYTES_MAX])
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

static void ask(struct probe *probe, const char *line)
{
    static uint8_t request[MESSAGES_REQUEST_BYTES_MAX];
    static uint8_t answer[MESSAGES_ANSWER_BYTES_MAX];
    uint32_t length = rkm04_message(&probe->unit, request, read_bytes(line, request), answer);
    for (uint32_t i = 0; i < length; i++) {
        (void)printf("%02x", answer[i]);
    }
    (void)printf("\n");
}

static void begin(struct probe *probe, const char *version, uint64_t epoch)
{
    probe->judged = (struct judged_unit){.unit = &probe->unit, .judge = &probe->judge, .machine = &probe->machine};
    judge_unit_begin(&probe->judged, epoch);
    rkm04_init(&probe->unit);
    probe->unit.messages.version = version;
    rkm04_start(&probe->unit);
}

int main(int argc, char **argv)
{
    static struct probe probe;
    static char line[LINE_BYTES_MAX];

    begin(&probe, argc > 1 ? argv[1] : RKM04_VERSION, argc > 2 ? strtoull(argv[2], NULL, 10) : 0);
    while (fgets(line, (int)sizeof line, stdin) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        if (line[0] == '+') {
            run(&probe, line + 1);
        } else {
            ask(&probe, line);
        }
    }
    return judge_unit_end(&probe.judged, probe.machine.now, stderr, "judge: ") == 0 ? 0 : 1;
}
