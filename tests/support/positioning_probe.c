/*
 * A positioning unit in virtual time that another program steps: what models of PLCs talk to.
 *
 * Comes in on standard input, line by line:
 *   send HEX        a frame begins on the line, at the present moment
 *   run US          so many microseconds go by; is answered
 *   in INPUT LEVEL  BI1 to BI8 has a level
 *   restart         power goes and comes; what was stored stays, and the axes stand where they are
 * Goes out for each `run`: where the axes are, in steps, how many pulses all of them have made, and the bytes that the
 * unit has sent in this time, in hexadecimal, or `-`. Exit status 2: the input is no such thing. An argument names a
 * file for the steps, as `--steps` of the simulator writes them.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host_machine.h"
#include "positioning.h"

enum {
    FRAME_MAX = 256,
    INPUT_LINE_MAX = 2 * FRAME_MAX + 16,
    AHEAD_TICKS = 512 * TICKS_PER_US,
};

struct probe {
    struct host_machine machine;
    struct pos_unit unit;
    struct host_line_byte frame[FRAME_MAX];
    uint8_t heard[FRAME_MAX];
    uint32_t heard_count;
    int64_t position[UNIT_MOTORS];
    uint64_t pulses;
    FILE *steps; /* NULL: nobody wants them */
};

static struct probe probe;

static _Noreturn void complain(const char *what)
{
    (void)fprintf(stderr, "positioning-probe: %s\n", what);
    exit(2);
}

static void on_step(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)context;
    probe.position[motor] += backward ? -1 : 1;
    probe.pulses++;
    if (probe.steps != NULL) {
        (void)fprintf(probe.steps, "%" PRIu64 ",%u,%" PRId64 "\n", tick, motor + 1U, probe.position[motor]);
    }
}

static void on_line(void *context, uint64_t tick, uint8_t value)
{
    (void)context;
    (void)tick;
    if (probe.heard_count == (uint32_t)FRAME_MAX) {
        complain("the unit sends too much");
    }
    probe.heard[probe.heard_count++] = value;
}

static uint64_t pass(void *context)
{
    (void)context;
    return positioning_poll(&probe.unit);
}

static void begin(void)
{
    memset(&probe.unit, 0, sizeof probe.unit);
    positioning_init(&probe.unit);
    positioning_start(&probe.unit);
}

static void send_frame(const char *hex)
{
    unsigned byte = 0;
    uint32_t count = 0;
    uint64_t byte_ticks = probe.machine.line.byte_ticks;
    for (; sscanf(hex, "%2x", &byte) == 1; hex += 2) {
        if (count == (uint32_t)FRAME_MAX) {
            complain("a frame is too long");
        }
        uint64_t tick = probe.machine.now + (count + 1U) * byte_ticks;
        probe.frame[count++] = (struct host_line_byte){.tick = tick, .value = (uint8_t)byte};
    }
    host_machine_set_line(&probe.machine, probe.frame, count);
}

static void run(uint64_t us)
{
    probe.heard_count = 0;
    host_machine_run(&probe.machine, probe.machine.now + us * (uint64_t)TICKS_PER_US, pass, NULL, NULL);
    for (unsigned motor = 0; motor < (unsigned)UNIT_MOTORS; motor++) {
        (void)printf("%" PRId64 " ", probe.position[motor]);
    }
    (void)printf("%" PRIu64 " ", probe.pulses);
    for (uint32_t i = 0; i < probe.heard_count; i++) {
        (void)printf("%02x", probe.heard[i]);
    }
    (void)printf("%s\n", probe.heard_count == 0U ? "-" : "");
    (void)fflush(stdout);
}

static void take(const char *line)
{
    unsigned input = 0;
    unsigned level = 0;
    uint64_t us = 0;
    if (strncmp(line, "send ", 5) == 0) {
        send_frame(&line[5]);
    } else if (sscanf(line, "run %" SCNu64, &us) == 1) {
        run(us);
    } else if (sscanf(line, "in %u %u", &input, &level) == 2 && input >= 1U && input <= 8U) {
        host_machine_set_input(&probe.machine, input, level != 0U);
    } else if (strcmp(line, "restart\n") == 0) {
        host_machine_restart(&probe.machine);
        begin();
    } else {
        complain("no such line");
    }
}

static void open_steps(const char *path)
{
    probe.steps = fopen(path, "w");
    if (probe.steps == NULL) {
        complain("the file of steps cannot be written");
    }
    (void)fprintf(probe.steps, "# tick_hz=%" PRIu64 "\ntick,motor,position\n", (uint64_t)TICKS_PER_US * 1000000U);
}

int main(int count, char **arguments)
{
    char line[INPUT_LINE_MAX];
    if (count > 1) {
        open_steps(arguments[1]);
    }
    host_machine_init(&probe.machine, 0);
    probe.machine.ahead_ticks = AHEAD_TICKS;
    probe.machine.listener = (struct host_listener){.step = on_step, .line = on_line};
    host_machine_select(&probe.machine);
    begin();
    while (fgets(line, sizeof line, stdin) != NULL) {
        take(line);
    }
    return 0;
}
