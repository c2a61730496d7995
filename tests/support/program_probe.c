/*
 * Many runs of a whole unit in one process, each from power-on: what the model of the language is compared with.
 *
 * Comes in on standard input, line by line; numbers are decimal, ticks count from power-on, lines of a kind come in the
 * order of their ticks:
 *   epoch E             the unit's time at power-on
 *   ahead TICKS         pulses are laid so far ahead; at first, one at a time
 *   in T INPUT LEVEL    an input changes
 *   send T HEX          a request, bytes in hexadecimal
 *   run T               runs all of the above up to T, and answers
 * Goes out, for each run:
 *   judge SENTENCE      what the judge complains of
 *   pulses MOTOR T ...  of each motor that made any; a minus: backward
 *   simulated MOTOR T ...   those that did not reach the pins, likewise
 *   event T MOTOR NUMBER VALUE, answer T HEX   as they happen
 *   connection T MOTOR LEVEL   of STEP and DIR, likewise
 *   end LATE POSITION POSITION POSITION POSITION
 * Exit status 2: the input is no such thing, or too long.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host_machine.h"
#include "judge_unit.h"
#include "axis.h"
#include "rkm04.h"

enum {
    PULSES_MAX = 400000,
    INPUTS_MAX = 1000,
    LINE_BYTES_MAX = 2 * MESSAGES_REQUEST_BYTES_MAX + 64
};

struct probe {
    struct judged_unit judged;
    struct host_machine machine;
    struct rkm04 unit;
    struct judge judge;
    struct train {
        int64_t pulse[PULSES_MAX];
        uint32_t count;
    } trains[2][UNIT_MOTORS]; /* at the pins, and simulated */
    struct host_input input[INPUTS_MAX];
    uint32_t input_count;
    bool running;
};

static _Noreturn void complain(const char *what)
{
    (void)fprintf(stderr, "program-probe: %s\n", what);
    exit(2);
}

static void add_pulse(struct probe *probe, struct train *train, uint64_t tick, unsigned motor, bool backward)
{
    if (train->count == PULSES_MAX) {
        complain("too many pulses");
    }
    train->pulse[train->count++] = backward ? -(int64_t)tick : (int64_t)tick;
    judge_unit_step(probe, tick, motor, backward);
}

static void on_step(void *context, uint64_t tick, unsigned motor, bool backward)
{
    struct probe *probe = context;
    add_pulse(probe, &probe->trains[0][motor], tick, motor, backward);
}

static void on_simulated(void *context, uint64_t tick, unsigned motor, bool backward)
{
    struct probe *probe = context;
    add_pulse(probe, &probe->trains[1][motor], tick, motor, backward);
}

static void on_connection(void *context, uint64_t tick, unsigned motor, bool connected)
{
    judge_unit_connection(context, tick, motor, connected);
    (void)printf("connection %" PRIu64 " %u %d\n", tick, motor + 1U, connected);
}

static void on_trace(void *context, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    judge_unit_trace(context, tick, motor, event, value);
    if (event == HAL_TRACE_COMMAND) {
        return; /* an endless loop has millions */
    }
    (void)printf("event %" PRIu64 " %u %u %" PRId64 "\n", tick, motor, (unsigned)event, value);
}

static void begin(struct probe *probe, uint64_t epoch)
{
    probe->judged = (struct judged_unit){.unit = &probe->unit, .judge = &probe->judge, .machine = &probe->machine};
    judge_unit_begin(&probe->judged, epoch);
    probe->machine.listener.step = on_step;
    probe->machine.listener.simulated = on_simulated;
    probe->machine.listener.connection = on_connection;
    probe->machine.listener.trace = on_trace;
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        probe->trains[0][motor].count = 0;
        probe->trains[1][motor].count = 0;
    }
    probe->input_count = 0;
    probe->running = false;
}

/* The unit starts when all inputs are known. */
static void run_until(struct probe *probe, uint64_t tick)
{
    if (!probe->running) {
        host_machine_set_script(&probe->machine, probe->input, probe->input_count);
        rkm04_init(&probe->unit);
        rkm04_start(&probe->unit);
        probe->running = true;
    }
    if (tick > probe->machine.now) {
        host_machine_run(&probe->machine, tick, judge_unit_pass, NULL, probe);
    }
}

static void add_input(struct probe *probe, const char *text)
{
    uint64_t tick;
    unsigned input;
    unsigned level;
    if (probe->running || probe->input_count == INPUTS_MAX ||
        sscanf(text, "%" SCNu64 " %u %u", &tick, &input, &level) != 3) {
        complain("no such input");
    }
    probe->input[probe->input_count++] =
        (struct host_input){.tick = tick, .input = (uint8_t)input, .level = level != 0};
}

static void send_request(struct probe *probe, const char *text)
{
    static uint8_t request[MESSAGES_REQUEST_BYTES_MAX];
    static uint8_t answer[MESSAGES_ANSWER_BYTES_MAX];
    char *end;
    uint64_t tick = strtoull(text, &end, 10);
    uint32_t length = 0;
    unsigned byte;
    for (end++; sscanf(end, "%2x", &byte) == 1; end += 2) {
        request[length++] = (uint8_t)byte;
    }
    run_until(probe, tick);
    length = rkm04_message(&probe->unit, request, length, answer);
    judge_exchange(&probe->judge, 1, length != 0 ? 1 : 0);
    (void)printf("answer %" PRIu64 " ", tick);
    for (uint32_t i = 0; i < length; i++) {
        (void)printf("%02x", answer[i]);
    }
    (void)printf("\n");
}

static void report_train(const char *name, unsigned motor, const struct train *train)
{
    if (train->count > 0) {
        (void)printf("%s %u", name, motor + 1U);
        for (uint32_t i = 0; i < train->count; i++) {
            (void)printf(" %" PRId64, train->pulse[i]);
        }
        (void)printf("\n");
    }
}

static void report(struct probe *probe)
{
    (void)judge_unit_end(&probe->judged, probe->machine.now, stdout, "judge ");
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        report_train("pulses", motor, &probe->trains[0][motor]);
        report_train("simulated", motor, &probe->trains[1][motor]);
    }
    (void)printf("end %" PRIu64, probe->machine.late_steps);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        (void)printf(" %" PRId64, axis_position_steps(&probe->unit.axis[motor]));
    }
    (void)printf("\n");
    (void)fflush(stdout);
}

static void obey(struct probe *probe, const char *line)
{
    if (strncmp(line, "epoch ", 6) == 0) {
        begin(probe, strtoull(line + 6, NULL, 10));
    } else if (strncmp(line, "ahead ", 6) == 0) {
        probe->machine.ahead_ticks = (uint32_t)strtoul(line + 6, NULL, 10);
    } else if (strncmp(line, "in ", 3) == 0) {
        add_input(probe, line + 3);
    } else if (strncmp(line, "send ", 5) == 0) {
        send_request(probe, line + 5);
    } else if (strncmp(line, "run ", 4) == 0) {
        run_until(probe, strtoull(line + 4, NULL, 10));
        report(probe);
    } else {
        complain("no such line");
    }
}

int main(void)
{
    static struct probe probe;
    static char line[LINE_BYTES_MAX];
    while (fgets(line, (int)sizeof line, stdin) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        obey(&probe, line);
    }
    return 0;
}
