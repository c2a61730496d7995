#include "opcodes.h"

#include <inttypes.h>
#include <stdio.h>

#include "base_tick.h"
#include "hal_trace.h"
#include "json.h"
#include "program_instruction.h"
#include "program_memory.h"
#include "messages.h"
#include "summary.h"
#include "rkm04.h"
#include "interpreter.h"
#include "words.h"

struct name {
    const char *name;
    const char *text;
};

static const char *const form_names[] = {
    [PROGRAM_FORM_NONE] = "NONE",     [PROGRAM_FORM_NUMBER] = "NUMBER", [PROGRAM_FORM_IO] = "IO",
    [PROGRAM_FORM_SIGNED] = "SIGNED", [PROGRAM_FORM_PLUS] = "PLUS",     [PROGRAM_FORM_MINUS] = "MINUS",
    [PROGRAM_FORM_HIGH] = "HIGH",     [PROGRAM_FORM_LOW] = "LOW",
};

#define X(name, text) {#name, text},
static const struct name events[] = {HAL_TRACE_EVENTS(X)};
static const struct name errors[] = {INTERPRETER_ERRORS(X)};
#undef X

static const struct name stops[AXIS_CAUSES] = {
#define X(name, text) [AXIS_CAUSE_##name] = {#name, text},
    INTERPRETER_CAUSES(X)
#undef X
};

static void print_opcodes(void)
{
    for (unsigned i = 0; i < PROGRAM_OPCODES; i++) {
        const struct program_row *row = program_opcode_row(i);
        (void)printf("%s{\"name\":\"%s\",\"letter\":", i == 0 ? "\n" : ",\n", row->name);
        json_print_text((const char *)&row->letter, 1);
        (void)printf(",\"form\":\"%s\",\"min\":%" PRId32 ",\"max\":%" PRId32 ",\"meaning\":\"%s\"}",
                     form_names[row->form], row->min, row->max, words_meaning(i));
    }
}

static void print_names(const char *key, const struct name *names, size_t count)
{
    (void)printf(",\n\"%s\":[", key);
    for (size_t i = 0; i < count; i++) {
        (void)printf("%s{\"name\":\"%s\",\"text\":", i == 0 ? "" : ",", names[i].name);
        json_print_string(names[i].text);
        (void)putchar('}');
    }
    (void)putchar(']');
}

static void print_states(void)
{
    (void)printf(",\n\"states\":[");
    for (unsigned i = 0; i < SUMMARY_STATES; i++) {
        (void)printf("%s\"%s\"", i == 0 ? "" : ",", summary_state_text(i));
    }
    (void)putchar(']');
}

static void print_messages(void)
{
    const char *before = "";
    (void)printf(",\n\"messages\":{");
#define X(name, number)                                                                                                \
    (void)printf("%s\"%s\":%d", before, #name, (number));                                                              \
    before = ",";
    MESSAGES_MESSAGES(X)
#undef X
    (void)putchar('}');
    (void)before;
}

enum exit_status opcodes_print(void)
{
    (void)printf("{\"opcodes\":[");
    print_opcodes();
    (void)putchar(']');
    print_names("events", events, sizeof events / sizeof events[0]);
    print_names("stops", stops, sizeof stops / sizeof stops[0]);
    print_names("errors", errors, sizeof errors / sizeof errors[0]);
    print_states();
    print_messages();
    (void)printf(",\n\"tick_hz\":%" PRIu32 ",\"commands_max\":%d,\"message_bytes_max\":%d,\"version\":\"%s\"}\n",
                 TICK_HZ, PROGRAM_COMMANDS_MAX, MESSAGES_REQUEST_BYTES_MAX, RKM04_VERSION);
    return finish_output();
}
