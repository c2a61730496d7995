/*
 * Many sessions with a GVE134 unit in one process, each from power-on: what the model of the unit is compared with.
 *
 * Comes in on standard input, line by line; numbers are decimal, ticks count from power-on, lines of a kind come in the
 * order of their ticks:
 *   epoch E             the unit's time at power-on; begins a session
 *   again -             the power comes back where a run has ended: the flash stays, ticks go on, all else is anew
 *   cut N               the power fails at the Nth word or erase of the flash since it came
 *   ahead TICKS         pulses are laid so far ahead; at first, one at a time
 *   cause C             why the unit starts: power, watchdog or crystal (it does not run)
 *   byte TICKS          what a byte takes that the unit sends
 *   in T INPUT LEVEL    an input changes; as its port reads it, at first 1: open
 *   hear T HEX BROKEN   a byte has come by the line
 *   run T               runs all of the above up to T, and answers
 *   go T                the same, but only to the end of the unit's next answer if that comes before T, and the session
 *                       goes on: what follows comes after that
 * Goes out, for each session, or each part of it:
 *   sent T HEX          the end of a byte that the unit has sent
 *   signal T LEVEL NAME as it changes: outputs, pwm, led 0 to 7, polarity 1 to 4 (1: STEP falls, 2: DIR is turned)
 *   judge SENTENCE      pulses too close to each other or to a change of DIR
 *   pulses MOTOR T ...  of each motor that made any; a minus: backward
 *   at T                how far a part came
 *   end LATE IDLE       pulses that came too late, and whether nothing happens any more
 * Exit status 2: the input is no such thing, or too long.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base_limits.h"
#include "gve134.h"
#include "host_machine.h"

enum {
    PULSES_MAX = 400000,
    INPUTS_MAX = 1000,
    HEARD_MAX = 100000,
    LINE_BYTES_MAX = 100,
    INTERVAL_TICKS = 420 - 2, /* 5 us less 2 ticks */
    ROUNDING_TICKS = 1
};

struct train {
    int64_t pulse[PULSES_MAX];
    int64_t last;         /* 0: there was none */
    uint64_t turned_tick; /* when DIR last changed */
    uint32_t count;
};

struct probe {
    struct host_machine machine;
    struct gve134 unit;
    struct train trains[UNIT_MOTORS];
    struct host_input input[INPUTS_MAX];
    struct host_line_byte heard[HEARD_MAX];
    uint32_t input_count;
    uint32_t heard_count;
    bool runs;
    bool has_answered;
};

static _Noreturn void complain(const char *what)
{
    (void)fprintf(stderr, "gve-probe: %s\n", what);
    exit(2);
}

static uint64_t last_pulse(const struct train *train)
{
    return (uint64_t)(train->last < 0 ? -train->last : train->last);
}

static void judge(const char *what, unsigned motor, uint64_t tick)
{
    (void)printf("judge motor %u: %s at tick %" PRIu64 "\n", motor + 1U, what, tick);
}

static void on_step(void *context, uint64_t tick, unsigned motor, bool backward)
{
    struct train *train = &((struct probe *)context)->trains[motor];
    if (train->count == PULSES_MAX) {
        complain("too many pulses");
    }
    if (train->last != 0 && tick - last_pulse(train) < INTERVAL_TICKS) {
        judge("two pulses are too close", motor, tick);
    }
    bool turns = train->last != 0 && (train->last < 0) != backward;
    if (turns && tick - last_pulse(train) < HOST_HOLD_TICKS + HOST_SETUP_TICKS - ROUNDING_TICKS) {
        judge("DIR has no time to turn", motor, tick);
    }
    if (train->turned_tick != 0 && tick - train->turned_tick < HOST_SETUP_TICKS - ROUNDING_TICKS) {
        judge("DIR has just changed", motor, tick);
    }
    train->last = backward ? -(int64_t)tick : (int64_t)tick;
    train->pulse[train->count++] = train->last;
}

/* The driver of a board keeps HOLD by itself where an axis stands (hal_step_set_direction); the host has none. */
static void on_direction(void *context, uint64_t tick, unsigned motor, bool backward)
{
    (void)backward;
    ((struct probe *)context)->trains[motor].turned_tick = tick;
}

static void tell_signal(uint64_t tick, uint32_t level, const char *name)
{
    (void)printf("signal %" PRIu64 " %" PRIu32 " %s", tick, level, name);
}

static void on_polarity(void *context, uint64_t tick, unsigned motor, bool falling, bool turned)
{
    (void)context;
    tell_signal(tick, (uint32_t)falling | (uint32_t)turned << 1U, "polarity");
    (void)printf(" %u\n", motor + 1U);
}

static void on_pwm(void *context, uint64_t tick, uint32_t permille)
{
    (void)context;
    tell_signal(tick, permille, "pwm\n");
}

static void on_output(void *context, uint64_t tick, uint8_t levels)
{
    (void)context;
    tell_signal(tick, levels, "outputs\n");
}

static void on_led(void *context, uint64_t tick, unsigned led, bool on)
{
    (void)context;
    tell_signal(tick, on, "led");
    (void)printf(" %u\n", led);
}

static void on_line(void *context, uint64_t tick, uint8_t value)
{
    struct probe *probe = context;
    probe->has_answered = probe->has_answered || value == '\r';
    (void)printf("sent %" PRIu64 " %02x\n", tick, value);
}

static uint64_t pass(void *context)
{
    return gve134_poll(&((struct probe *)context)->unit);
}

static void begin(struct probe *probe)
{
    host_machine_select(&probe->machine);
    probe->machine.listener = (struct host_listener){
        .context = probe,
        .step = on_step,
        .direction = on_direction,
        .polarity = on_polarity,
        .pwm = on_pwm,
        .led = on_led,
        .output = on_output,
        .line = on_line,
    };
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        probe->trains[motor].count = 0;
        probe->trains[motor].last = 0;
        probe->trains[motor].turned_tick = 0;
    }
    probe->input_count = 0;
    probe->heard_count = 0;
    probe->runs = false;
}

static void set_cause(struct probe *probe, const char *cause)
{
    probe->machine.faults.no_crystal = strcmp(cause, "crystal") == 0;
    if (strcmp(cause, "watchdog") == 0) {
        probe->machine.faults.start_cause = HAL_BOARD_CAUSE_WATCHDOG;
    }
}

static void add_input(struct probe *probe, const char *text)
{
    uint64_t tick;
    unsigned input;
    unsigned level;
    if (probe->input_count == INPUTS_MAX || sscanf(text, "%" SCNu64 " %u %u", &tick, &input, &level) != 3) {
        complain("no such input");
    }
    probe->input[probe->input_count++] =
        (struct host_input){.tick = tick, .input = (uint8_t)input, .level = level == 0};
}

static void add_byte(struct probe *probe, const char *text)
{
    uint64_t tick;
    unsigned value;
    unsigned broken;
    if (probe->heard_count == HEARD_MAX || sscanf(text, "%" SCNu64 " %2x %u", &tick, &value, &broken) != 3) {
        complain("no such byte");
    }
    probe->heard[probe->heard_count++] =
        (struct host_line_byte){.tick = tick, .value = (uint8_t)value, .broken = broken != 0};
}

static void report(const struct probe *probe)
{
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        const struct train *train = &probe->trains[motor];
        (void)printf("pulses %u", motor + 1U);
        for (uint32_t i = 0; i < train->count; i++) {
            (void)printf(" %" PRId64, train->pulse[i]);
        }
        (void)printf("\n");
    }
    (void)printf("end %" PRIu64 " %d\n", probe->machine.late_steps, gve134_is_idle(&probe->unit));
    (void)fflush(stdout);
}

static bool has_answered(void *context)
{
    return ((struct probe *)context)->has_answered;
}

static void start(struct probe *probe)
{
    host_machine_set_script(&probe->machine, probe->input, probe->input_count);
    host_machine_set_line(&probe->machine, probe->heard, probe->heard_count);
    if (!probe->runs) {
        probe->runs = true;
        gve134_init(&probe->unit);
        gve134_start(&probe->unit);
    }
}

static void run(struct probe *probe, uint64_t tick)
{
    start(probe);
    host_machine_run(&probe->machine, tick, pass, NULL, probe);
    report(probe);
}

/* Forgets what has come and has been told. */
static void forget_past(struct probe *probe)
{
    uint32_t inputs = probe->machine.script_next;
    uint32_t bytes = probe->machine.line.script_next;
    probe->input_count -= inputs;
    probe->heard_count -= bytes;
    memmove(probe->input, probe->input + inputs, probe->input_count * sizeof probe->input[0]);
    memmove(probe->heard, probe->heard + bytes, probe->heard_count * sizeof probe->heard[0]);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        probe->trains[motor].count = 0;
    }
}

static void go(struct probe *probe, uint64_t tick)
{
    probe->has_answered = false;
    start(probe);
    host_machine_run(&probe->machine, tick, pass, has_answered, probe);
    (void)printf("at %" PRIu64 "\n", probe->machine.now);
    report(probe);
    forget_past(probe);
}

static void obey(struct probe *probe, const char *line)
{
    if (strncmp(line, "epoch ", 6) == 0) {
        host_machine_init(&probe->machine, strtoull(line + 6, NULL, 10));
        begin(probe);
    } else if (strncmp(line, "again ", 6) == 0) {
        host_machine_restart(&probe->machine);
        begin(probe);
    } else if (strncmp(line, "cut ", 4) == 0) {
        probe->machine.faults.flash_cut_after = (uint32_t)strtoul(line + 4, NULL, 10);
    } else if (strncmp(line, "ahead ", 6) == 0) {
        probe->machine.ahead_ticks = (uint32_t)strtoul(line + 6, NULL, 10);
    } else if (strncmp(line, "cause ", 6) == 0) {
        set_cause(probe, line + 6);
    } else if (strncmp(line, "byte ", 5) == 0) {
        host_machine_set_byte_ticks(&probe->machine, (uint32_t)strtoul(line + 5, NULL, 10));
    } else if (strncmp(line, "in ", 3) == 0) {
        add_input(probe, line + 3);
    } else if (strncmp(line, "hear ", 5) == 0) {
        add_byte(probe, line + 5);
    } else if (strncmp(line, "run ", 4) == 0) {
        run(probe, strtoull(line + 4, NULL, 10));
    } else if (strncmp(line, "go ", 3) == 0) {
        go(probe, strtoull(line + 3, NULL, 10));
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
