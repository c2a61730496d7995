/*
 * rkm04-judge: judges the files that the simulator and the virtual board write.
 *
 *     rkm04-judge STEPS.csv [TRACE.csv] [--start-speed S] [--speed V] [--accel A] [--slowest V] [--slack TICKS]
 *                 [--counter-set]
 *
 * Prints a complaint a line. Exit status 0: none, 1: some, 2: the call or a file is wrong. Without a trace nothing is
 * known of moves: then only what holds for pulses of any kind is judged.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "judge.h"
#include "interpreter.h"

enum {
    LINE_BYTES = 256,
    COLUMNS = 4,
    STATUS_GOOD = 0,
    STATUS_BAD = 1,
    STATUS_WRONG = 2
};

static const char *const event_texts[] = {
#define X(name, text) text,
    HAL_TRACE_EVENTS(X)
#undef X
};

static const char *const stop_texts[AXIS_CAUSES] = {
#define X(name, text) [AXIS_CAUSE_##name] = (text),
    INTERPRETER_CAUSES(X)
#undef X
};

/* One of the two files, and its next line. */
struct input {
    const char *path;
    FILE *file;
    unsigned columns;
    char line[LINE_BYTES];
    char *cell[COLUMNS];
    uint64_t tick;
    bool over;
};

_Noreturn static void refuse(const char *path, const char *what)
{
    (void)fprintf(stderr, "rkm04-judge: %s: %s\n", path, what);
    exit(STATUS_WRONG);
}

static bool read_line(struct input *input)
{
    if (fgets(input->line, sizeof input->line, input->file) == NULL) {
        return false;
    }
    input->line[strcspn(input->line, "\r\n")] = '\0';
    return true;
}

static int64_t to_number(const struct input *input, const char *text)
{
    char *end = NULL;
    int64_t number = strtoll(text, &end, 10);
    if (end == text || *end != '\0') {
        refuse(input->path, "a number is missing");
    }
    return number;
}

/* Cuts the next line into cells; the last cell has what is left. */
static void advance(struct input *input)
{
    input->over = input->file == NULL || !read_line(input);
    char *at = input->line;
    for (unsigned i = 0; i < input->columns && !input->over; i++) {
        input->cell[i] = at;
        char *comma = i + 1U < input->columns ? strchr(at, ',') : NULL;
        if (comma != NULL) {
            *comma = '\0';
            at = comma + 1;
        } else if (i + 1U < input->columns) {
            refuse(input->path, "a line has too few cells");
        }
    }
    input->tick = input->over ? UINT64_MAX : (uint64_t)to_number(input, input->cell[0]);
}

static void open_input(struct input *input, const char *path, unsigned columns)
{
    *input = (struct input){.path = path, .columns = columns, .over = true};
    if (path != NULL) {
        input->file = fopen(path, "r");
        if (input->file == NULL) {
            refuse(path, "cannot be read");
        }
    }
}

static uint32_t read_rate(struct input *steps)
{
    static const char prefix[] = "# tick_hz=";
    if (!read_line(steps) || strncmp(steps->line, prefix, sizeof prefix - 1) != 0) {
        refuse(steps->path, "not a steps file");
    }
    uint32_t rate = (uint32_t)to_number(steps, steps->line + sizeof prefix - 1);
    if (!read_line(steps) || strcmp(steps->line, "tick,motor,position") != 0) {
        refuse(steps->path, "not a steps file");
    }
    return rate;
}

static int find_text(const struct input *input, const char *const *texts, size_t count, const char *text)
{
    for (size_t i = 0; i < count; i++) {
        if (strcmp(texts[i], text) == 0) {
            return (int)i;
        }
    }
    refuse(input->path, "an event is not known");
}

static void judge_line(struct judge *judge, const struct input *trace)
{
    enum hal_trace_event event =
        (enum hal_trace_event)find_text(trace, event_texts, sizeof event_texts / sizeof event_texts[0], trace->cell[2]);
    int64_t value = 0;
    if (event == HAL_TRACE_STOP) {
        value = find_text(trace, stop_texts, sizeof stop_texts / sizeof stop_texts[0], trace->cell[3]);
    } else if (event == HAL_TRACE_MOVE || event == HAL_TRACE_DONE) {
        value = to_number(trace, trace->cell[3]);
    }
    judge_event(judge, trace->tick, (unsigned)to_number(trace, trace->cell[1]), event, value);
    judge->events_of_pass = 0; /* a file does not tell of passes */
}

/* At the same tick, pulses come before events. */
static void judge_files(struct judge *judge, struct input *steps, struct input *trace)
{
    uint64_t event_tick = 0;
    while (!steps->over || !trace->over) {
        if (!steps->over && steps->tick <= trace->tick) {
            judge_pulse_to(judge, steps->tick, (unsigned)to_number(steps, steps->cell[1]),
                           to_number(steps, steps->cell[2]));
            advance(steps);
        } else {
            if (trace->tick < event_tick) {
                judge_events_back(judge, trace->tick);
            }
            event_tick = trace->tick;
            judge_line(judge, trace);
            advance(trace);
        }
    }
}

static uint32_t *find_limit(struct judge_limits *limits, const char *name)
{
    if (strcmp(name, "--start-speed") == 0) {
        return &limits->start_speed;
    }
    if (strcmp(name, "--speed") == 0) {
        return &limits->speed;
    }
    if (strcmp(name, "--accel") == 0) {
        return &limits->accel;
    }
    if (strcmp(name, "--slowest") == 0) {
        return &limits->slowest;
    }
    return strcmp(name, "--slack") == 0 ? &limits->slack_ticks : NULL;
}

struct call {
    const char *paths[2];
    struct judge_limits limits;
};

static void read_call(struct call *call, int count, char **arguments)
{
    unsigned paths = 0;
    for (int i = 1; i < count; i++) {
        uint32_t *limit = find_limit(&call->limits, arguments[i]);
        if (strcmp(arguments[i], "--counter-set") == 0) {
            call->limits.counter_set = true;
        } else if (limit != NULL && i + 1 < count) {
            *limit = (uint32_t)strtoul(arguments[++i], NULL, 10);
        } else if (arguments[i][0] != '-' && paths < 2) {
            call->paths[paths++] = arguments[i];
        } else {
            refuse(arguments[i], "no such option, or its value is missing");
        }
    }
    if (paths == 0) {
        refuse("STEPS.csv", "is missing");
    }
}

static int tell(const struct judge *judge)
{
    char text[JUDGE_TEXT_BYTES + 32];
    for (uint32_t i = 0; i < judge->complaints; i++) {
        judge_tell(judge, i, text);
        (void)puts(text);
    }
    if (judge->lost_complaints != 0) {
        (void)printf("and %" PRIu32 " more\n", judge->lost_complaints);
    }
    return judge->complaints == 0 ? STATUS_GOOD : STATUS_BAD;
}

int main(int count, char **arguments)
{
    static struct judge judge;
    struct call call = {.limits = judge_default_limits()};
    struct input steps;
    struct input trace;
    read_call(&call, count, arguments);
    open_input(&steps, call.paths[0], 3);
    open_input(&trace, call.paths[1], COLUMNS);
    call.limits.tick_hz = read_rate(&steps);
    if (trace.file != NULL && (!read_line(&trace) || strcmp(trace.line, "tick,motor,event,value") != 0)) {
        refuse(trace.path, "not a trace file");
    }
    judge_init(&judge, &call.limits);
    judge.without_moves = trace.file == NULL;
    advance(&steps);
    advance(&trace);
    judge_files(&judge, &steps, &trace);
    judge_finish(&judge, UINT64_MAX);
    return tell(&judge);
}
