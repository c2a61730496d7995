#include "options.h"

#include <stddef.h>
#include <string.h>

#include "arguments.h"
#include "core.h"
#include "line.h"
#include "pins.h"
#include "vtime.h"

enum {
    SECONDS_DECIMALS = 9,
    MS_DECIMALS = 6,
};

static bool read_small(const char *name, const char *text, uint64_t least, uint64_t most, uint64_t *number)
{
    if (!arguments_read_number(text, (struct argument_number){.least = least, .most = most}, number)) {
        complain("%s %s: not a number from %u to %u; see --help", name, text, (unsigned)least, (unsigned)most);
        return false;
    }
    return true;
}

static bool read_stuck(void *target, const char *text)
{
    struct options *options = target;
    char name[8] = "";
    const char *equals = strchr(text, '=');
    size_t length = equals == NULL ? 0 : (size_t)(equals - text);
    struct options_stuck *stuck = &options->stuck[options->stucks];
    if (options->stucks < OPTIONS_STUCK_MAX && length > 0 && length < sizeof name) {
        memcpy(name, text, length);
        stuck->level = equals[1] == '1';
        if (pins_read_name(name, &stuck->pin) && (equals[1] == '0' || equals[1] == '1') && equals[2] == '\0') {
            options->stucks++;
            return true;
        }
    }
    complain("--stuck %s: not a pin and its level, or too many; write for example PA0=1", text);
    return false;
}

static bool read_wire(void *target, const char *text)
{
    struct options *options = target;
    if (options->wires < WIRES_MAX && wires_read(text, &options->wire[options->wires])) {
        options->wires++;
        return true;
    }
    complain("--wire %s: not two pins, or too many; write for example PA0=PB6", text);
    return false;
}

/* The number of an operation of the flash, and what follows a colon; null if nothing does. */
static bool read_operation(const char *text, uint64_t *operation, const char **how)
{
    const char *end = text + strlen(text);
    if (!line_read_fixed(&text, end, 0, UINT32_MAX, operation) || *operation == 0 || (text != end && *text != ':')) {
        return false;
    }
    *how = text == end ? NULL : text + 1;
    return true;
}

static bool read_flash_failure(void *target, const char *text)
{
    struct options *options = target;
    static const struct {
        const char *name;
        uint32_t error; /* bits of FLASH_SR */
    } errors[] = {{"wrp", 1U << 4}, {"pga", 1U << 5}, {"pgp", 1U << 6}, {"pgs", 1U << 7},
                  {"op", 1U << 1},  {"silent", 0},    {"bit", 0}};
    const char *how = NULL;
    bool good = read_operation(text, &options->flash_settings.fail, &how);
    how = how == NULL ? errors[0].name : how;
    for (unsigned i = 0; good && i < sizeof errors / sizeof *errors; i++) {
        if (strcmp(how, errors[i].name) == 0) {
            options->flash_settings.error = errors[i].error;
            options->flash_settings.bit = strcmp(how, "bit") == 0;
            return true;
        }
    }
    complain("--flash-fail %s: not an operation and how it fails; see --help", text);
    return false;
}

static bool read_leaves(const char *text, uint32_t *leaves)
{
    static const char *const names[] = {"nothing", "all", "half"};
    const char *end = text + strlen(text);
    uint64_t seed = 0;
    for (unsigned i = 0; i < sizeof names / sizeof *names; i++) {
        if (strcmp(text, names[i]) == 0) {
            *leaves = i;
            return true;
        }
    }
    bool good = line_read_fixed(&text, end, 0, 1000000000, &seed) && text == end;
    *leaves = FLASH_CUT_SEED + (uint32_t)seed;
    return good;
}

static bool read_cut(void *target, const char *text)
{
    struct options *options = target;
    struct flash_settings *flash = &options->flash_settings;
    struct flash_cut cut = {.leaves = FLASH_CUT_HALF};
    const char *how = NULL;
    if (flash->cuts < FLASH_CUTS_MAX && read_operation(text, &cut.operation, &how) &&
        (how == NULL || read_leaves(how, &cut.leaves))) {
        flash->cut[flash->cuts++] = cut;
        return true;
    }
    complain("--power-cut %s: not an operation and what it leaves, or too many; see --help", text);
    return false;
}

static bool read_fault(void *target, const char *text)
{
    struct options *options = target;
    if (options->faults == FAULTS_MAX) {
        complain("--fault %s: one too many; there can be %d", text, FAULTS_MAX);
        return false;
    }
    options->fault[options->faults++] = text;
    return true;
}

static bool read_watch(void *target, const char *text)
{
    struct options *options = target;
    if (options->watches == OPTIONS_WATCHES_MAX) {
        complain("--watch %s: one too many; %d can be watched", text, OPTIONS_WATCHES_MAX);
        return false;
    }
    options->watch[options->watches++] = text;
    return true;
}

static bool read_set(void *target, const char *text)
{
    struct options *options = target;
    if (options->sets == OPTIONS_SETS_MAX) {
        complain("--set %s: one too many; %d can be set", text, OPTIONS_SETS_MAX);
        return false;
    }
    options->set[options->sets++] = text;
    return true;
}

static bool read_flash_kb(void *target, const char *text)
{
    struct options *options = target;
    bool half = strcmp(text, "512") == 0;
    options->flash_settings.kb = half ? 512 : 1024;
    if (!half && strcmp(text, "1024") != 0) {
        complain("--flash-kb %s: write 512 or 1024", text);
        return false;
    }
    return true;
}

/* RM0090 section 38.6.1. Revision A names itself as an STM32F2 does (errata ES0182). */
static bool read_revision(void *target, const char *text)
{
    struct options *options = target;
    static const struct {
        char name;
        uint32_t idcode;
    } revisions[] = {{'A', CORE_IDCODE_A}, {'Z', 0x10016413}, {'1', 0x10036413},
                     {'2', 0x10076413},    {'Y', 0x100F6413}, {'5', 0x101F6413}};
    for (unsigned i = 0; text[0] != '\0' && text[1] == '\0' && i < sizeof revisions / sizeof *revisions; i++) {
        if (revisions[i].name == text[0]) {
            options->idcode = revisions[i].idcode;
            return true;
        }
    }
    complain("--revision %s: write A, Z, 1, 2, Y or 5", text);
    return false;
}

static bool read_thresholds(void *target, const char *text)
{
    struct options *options = target;
    static const char *const names[] = {"low", "typical", "high"};
    for (unsigned i = 0; i < sizeof names / sizeof *names; i++) {
        if (strcmp(names[i], text) == 0) {
            options->thresholds = (enum supply_corner)i;
            return true;
        }
    }
    complain("--thresholds %s: write low, typical or high", text);
    return false;
}

static bool read_option_bytes(void *target, const char *text)
{
    struct options *options = target;
    const char *end = text + strlen(text);
    if (!line_read_hex(text, end, &options->flash_settings.option_bytes)) {
        complain("--option-bytes %s: not up to eight hexadecimal digits", text);
        return false;
    }
    return true;
}

static bool read_ticks(void *target, const char *text)
{
    struct options *options = target;
    options->ticks_from_timer = strcmp(text, "timer") == 0;
    if (!options->ticks_from_timer && strcmp(text, "reset") != 0) {
        complain("--ticks %s: write reset or timer", text);
        return false;
    }
    return true;
}

static bool read_step_timer(void *target, const char *text)
{
    enum {
        TIM2,
        TIM5 = 3
    };
    struct options *options = target;
    options->timer_settings.steps = strcmp(text, "TIM5") == 0 ? TIM5 : TIM2;
    if (options->timer_settings.steps == TIM2 && strcmp(text, "TIM2") != 0) {
        complain("--step-timer %s: write TIM2 or TIM5", text);
        return false;
    }
    return true;
}

static bool read_format(void *target, const char *text)
{
    static const char *const names[] = {
        [USART_8E1] = "8E1", [USART_8O1] = "8O1", [USART_8N1] = "8N1", [USART_8N2] = "8N2"};
    struct options *options = target;
    for (unsigned i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(text, names[i]) == 0) {
            options->format = (enum usart_format)i;
            return true;
        }
    }
    complain("--format %s: no format; write 8E1, 8O1, 8N1 or 8N2", text);
    return false;
}

static bool read_node(void *target, const char *text)
{
    struct options *options = target;
    uint64_t number = 0;
    bool good = read_small("--node", text, 1, 16, &number);
    options->node = (unsigned)number;
    return good;
}

static bool read_refill(void *target, const char *text)
{
    struct options *options = target;
    uint64_t number = 0;
    bool good = read_small("--refill", text, 1, 3, &number);
    options->refill = (uint32_t)number;
    return good;
}

static bool read_wait_states(void *target, const char *text)
{
    struct options *options = target;
    uint64_t number = 0;
    bool good = read_small("--wait-states", text, 0, 15, &number);
    options->wait_states = (int)number;
    return good;
}

static bool read_apb_wait(void *target, const char *text)
{
    struct options *options = target;
    uint64_t number = 0;
    bool good = read_small("--apb-wait", text, 0, 100, &number);
    options->apb_wait = (uint32_t)number;
    return good;
}

static bool read_tcp(void *target, const char *text)
{
    struct options *options = target;
    uint64_t number = 0;
    options->tcp = read_small("--tcp", text, 0, 65535, &number);
    options->tcp_port = (unsigned)number;
    return options->tcp;
}

#define TEXT(name, member) ARGUMENT_TEXT_ROW(options, name, member)
#define FLAG(name, member) ARGUMENT_FLAG_ROW(options, name, member)
#define OTHER(name, reader) ARGUMENT_OTHER_ROW(name, reader)
#define NUMBER(option, member, ...)                                                                                    \
    {                                                                                                                  \
        .name = (option), .kind = ARGUMENT_NUMBER, .offset = offsetof(struct options, member), .number = {             \
            __VA_ARGS__                                                                                                \
        }                                                                                                              \
    }

/* Decimals, least, most, and what one unit is in the member: times are kept in picoseconds. */
static const struct argument rows[] = {
    TEXT("--elf", elf),
    TEXT("--pins", pins),
    TEXT("--inputs", inputs),
    TEXT("--line-script", line_script),
    TEXT("--line-log", line_log),
    TEXT("--steps", steps),
    TEXT("--vcd", vcd),
    TEXT("--flash", flash),
    TEXT("--profile", profile),
    TEXT("--pty", pty),
    TEXT("--supply", supply),
    TEXT("--end-at", end_at),
    TEXT("--stack-limit", stack_limit),
    FLAG("--lockstep", lockstep),
    FLAG("--art", art),
    FLAG("--shared-bus", shared_bus),
    FLAG("--no-crystal", no_crystal),
    FLAG("--slow-flash", flash_settings.slow),
    FLAG("--match-equal", timer_settings.match_equal),
    FLAG("--exti-mask-first", exti_mask_first),
    FLAG("--pwm-at-once", timer_settings.pwm_at_once),
    FLAG("--requests-stay", timer_settings.requests_stay),
    FLAG("--left-by-loader", left_by_loader),
    FLAG("--loader-uses-ram", loader_uses_ram),
    FLAG("--power-back", flash_settings.power_back),
    NUMBER("--for", for_ps, SECONDS_DECIMALS, 1, UINT64_C(1000000000000000), 1000),
    NUMBER("--measure-from", measure_from_ps, MS_DECIMALS, 0, UINT64_C(1000000000000), 1000),
    NUMBER("--crystal-stops", crystal_stops_ps, MS_DECIMALS, 0, UINT64_C(1000000000000), 1000),
    NUMBER("--crystal", crystal_hz, 6, 4000000, 26000000, 1),
    NUMBER("--lsi", lsi_hz, 0, 17000, 47000, 1),
    NUMBER("--baud", baud, 0, 300, 4000000, 1),
    NUMBER("--flash-erase", flash_settings.erase_us, 3, 1, 100000000, 1),
    NUMBER("--timer-start", timer_settings.start, 0, 0, UINT32_MAX, 1),
    OTHER("--watch", read_watch),
    OTHER("--set", read_set),
    OTHER("--stuck", read_stuck),
    OTHER("--wire", read_wire),
    OTHER("--flash-fail", read_flash_failure),
    OTHER("--power-cut", read_cut),
    OTHER("--fault", read_fault),
    OTHER("--ticks", read_ticks),
    OTHER("--step-timer", read_step_timer),
    OTHER("--flash-kb", read_flash_kb),
    OTHER("--revision", read_revision),
    OTHER("--thresholds", read_thresholds),
    OTHER("--option-bytes", read_option_bytes),
    OTHER("--node", read_node),
    OTHER("--format", read_format),
    OTHER("--refill", read_refill),
    OTHER("--wait-states", read_wait_states),
    OTHER("--apb-wait", read_apb_wait),
    OTHER("--tcp", read_tcp),
};

static const struct argument_table table = {
    .rows = rows,
    .count = sizeof rows / sizeof rows[0],
    .unknown = "no such option; see --help",
    .missing = "unknown, or something must stand behind it; see --help",
    .takes_empty = true,
};

enum exit_status options_read(struct options *options, int count, char *const arguments[])
{
    *options = (struct options){.for_ps = 10 * VTIME_PS_PER_SECOND,
                                .crystal_hz = 8000000,
                                .crystal_stops_ps = VTIME_NEVER,
                                .lsi_hz = 32000,
                                .baud = 19200,
                                .format = USART_8N1,
                                .node = 1,
                                .thresholds = SUPPLY_TYPICAL,
                                .flash_settings = {.option_bytes = FLASH_OPTIONS_DELIVERED, .kb = 1024},
                                .idcode = 0x10076413,
                                .refill = 3,
                                .apb_wait = 8,
                                .wait_states = -1};
    if (arguments_read(&table, options, count, arguments) != EXIT_DONE) {
        return EXIT_USAGE;
    }
    if (options->elf == NULL) {
        complain("no program; write --elf FILE");
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}
