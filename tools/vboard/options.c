#include "options.h"

#include <stddef.h>
#include <string.h>

#include "flash.h"
#include "line.h"
#include "pins.h"
#include "vtime.h"

enum kind {
    KIND_TEXT,
    KIND_FLAG,
    KIND_NUMBER,
};

#define SECONDS_DECIMALS 9
#define MS_DECIMALS 6

struct row {
    const char *name;
    size_t offset; /* of the member: const char *, bool or uint64_t */
    enum kind kind;
    unsigned decimals; /* KIND_NUMBER */
    uint64_t unit;     /* what one of the last decimals is worth */
    uint64_t least;
    uint64_t most;
};

#define TEXT(name, member) {name, offsetof(struct options, member), KIND_TEXT, 0, 0, 0, 0}
#define FLAG(name, member) {name, offsetof(struct options, member), KIND_FLAG, 0, 0, 0, 0}

static const struct row rows[] = {
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
    FLAG("--art", art),
    FLAG("--no-crystal", no_crystal),
    FLAG("--slow-flash", slow_flash),
    FLAG("--match-equal", match_equal),
    FLAG("--exti-mask-first", exti_mask_first),
    FLAG("--pwm-at-once", pwm_at_once),
    FLAG("--left-by-loader", left_by_loader),
    FLAG("--power-back", power_back),
    {"--for", offsetof(struct options, for_ps), KIND_NUMBER, SECONDS_DECIMALS, 1000, 1, UINT64_C(1000000000000000)},
    {"--measure-from", offsetof(struct options, measure_from_ps), KIND_NUMBER, MS_DECIMALS, 1000, 0,
     UINT64_C(1000000000000)},
    {"--crystal-stops", offsetof(struct options, crystal_stops_ps), KIND_NUMBER, MS_DECIMALS, 1000, 0,
     UINT64_C(1000000000000)},
    {"--crystal", offsetof(struct options, crystal_hz), KIND_NUMBER, 6, 1, 4000000, 26000000},
    {"--lsi", offsetof(struct options, lsi_hz), KIND_NUMBER, 0, 1, 17000, 47000},
    {"--baud", offsetof(struct options, baud), KIND_NUMBER, 0, 1, 300, 4000000},
    {"--flash-erase", offsetof(struct options, erase_us), KIND_NUMBER, 3, 1, 1, 100000000},
    {"--timer-start", offsetof(struct options, timer_start), KIND_NUMBER, 0, 1, 0, UINT32_MAX},
};

static bool read_number(const char *text, unsigned decimals, uint64_t least, uint64_t most, uint64_t *number)
{
    const char *at = text;
    const char *end = text + strlen(text);
    return line_read_fixed(&at, end, decimals, most, number) && at == end && *number >= least;
}

static bool read_small(const char *name, const char *text, uint64_t least, uint64_t most, uint64_t *number)
{
    if (!read_number(text, 0, least, most, number)) {
        complain("%s %s: not a number from %u to %u; see --help", name, text, (unsigned)least, (unsigned)most);
        return false;
    }
    return true;
}

static bool read_stuck(struct options *options, const char *text)
{
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

/* The number of an operation of the flash, and what stands behind a colon; null if nothing does. */
static bool read_operation(const char *text, uint64_t *operation, const char **how)
{
    const char *end = text + strlen(text);
    if (!line_read_fixed(&text, end, 0, UINT32_MAX, operation) || *operation == 0 || (text != end && *text != ':')) {
        return false;
    }
    *how = text == end ? NULL : text + 1;
    return true;
}

static bool read_flash_failure(struct options *options, const char *text)
{
    static const struct {
        const char *name;
        uint32_t error; /* bits of FLASH_SR */
    } errors[] = {{"wrp", 1U << 4}, {"pga", 1U << 5}, {"pgp", 1U << 6}, {"pgs", 1U << 7},
                  {"op", 1U << 1},  {"silent", 0},    {"bit", 0}};
    const char *how = NULL;
    bool good = read_operation(text, &options->flash_fail, &how);
    how = how == NULL ? errors[0].name : how;
    for (unsigned i = 0; good && i < sizeof errors / sizeof *errors; i++) {
        if (strcmp(how, errors[i].name) == 0) {
            options->flash_error = errors[i].error;
            options->flash_bit = strcmp(how, "bit") == 0;
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
    *leaves = OPTIONS_CUT_SEED + (uint32_t)seed;
    return good;
}

static bool read_cut(struct options *options, const char *text)
{
    struct options_cut cut = {.leaves = OPTIONS_CUT_HALF};
    const char *how = NULL;
    if (options->cuts < OPTIONS_CUTS_MAX && read_operation(text, &cut.operation, &how) &&
        (how == NULL || read_leaves(how, &cut.leaves))) {
        options->cut[options->cuts++] = cut;
        return true;
    }
    complain("--power-cut %s: not an operation and what it leaves, or too many; see --help", text);
    return false;
}

static bool read_fault(struct options *options, const char *text)
{
    if (options->faults == FAULTS_MAX) {
        complain("--fault %s: one too many; there can be %d", text, FAULTS_MAX);
        return false;
    }
    options->fault[options->faults++] = text;
    return true;
}

static bool read_watch(struct options *options, const char *text)
{
    if (options->watches == OPTIONS_WATCHES_MAX) {
        complain("--watch %s: one too many; %d can be watched", text, OPTIONS_WATCHES_MAX);
        return false;
    }
    options->watch[options->watches++] = text;
    return true;
}

static bool read_set(struct options *options, const char *text)
{
    if (options->sets == OPTIONS_SETS_MAX) {
        complain("--set %s: one too many; %d can be set", text, OPTIONS_SETS_MAX);
        return false;
    }
    options->set[options->sets++] = text;
    return true;
}

static bool read_flash_kb(struct options *options, const char *text)
{
    bool half = strcmp(text, "512") == 0;
    options->flash_kb = half ? 512 : 1024;
    if (!half && strcmp(text, "1024") != 0) {
        complain("--flash-kb %s: write 512 or 1024", text);
        return false;
    }
    return true;
}

/* RM0090 section 38.6.1. Revision A names itself as an STM32F2 does (errata ES0182). */
static bool read_revision(struct options *options, const char *text)
{
    static const struct {
        char name;
        uint32_t idcode;
    } revisions[] = {{'A', 0x20006411}, {'Z', 0x10016413}, {'1', 0x10036413},
                     {'2', 0x10076413}, {'Y', 0x100F6413}, {'5', 0x101F6413}};
    for (unsigned i = 0; text[0] != '\0' && text[1] == '\0' && i < sizeof revisions / sizeof *revisions; i++) {
        if (revisions[i].name == text[0]) {
            options->idcode = revisions[i].idcode;
            return true;
        }
    }
    complain("--revision %s: write A, Z, 1, 2, Y or 5", text);
    return false;
}

static bool read_thresholds(struct options *options, const char *text)
{
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

static bool read_option_bytes(struct options *options, const char *text)
{
    const char *end = text + strlen(text);
    if (!faults_read_hex(text, end, &options->option_bytes)) {
        complain("--option-bytes %s: not up to eight hexadecimal digits", text);
        return false;
    }
    return true;
}

static bool read_ticks(struct options *options, const char *text)
{
    options->ticks_from_timer = strcmp(text, "timer") == 0;
    if (!options->ticks_from_timer && strcmp(text, "reset") != 0) {
        complain("--ticks %s: write reset or timer", text);
        return false;
    }
    return true;
}

typedef bool reader(struct options *options, const char *text);

/* The options that are more than a number or a name of a file; null: not one of them. */
static reader *find_reader(const char *name)
{
    static const struct {
        const char *name;
        reader *read;
    } readers[] = {
        {"--watch", read_watch},
        {"--set", read_set},
        {"--stuck", read_stuck},
        {"--flash-fail", read_flash_failure},
        {"--power-cut", read_cut},
        {"--fault", read_fault},
        {"--ticks", read_ticks},
        {"--flash-kb", read_flash_kb},
        {"--revision", read_revision},
        {"--thresholds", read_thresholds},
        {"--option-bytes", read_option_bytes},
    };
    for (unsigned i = 0; i < sizeof readers / sizeof *readers; i++) {
        if (strcmp(readers[i].name, name) == 0) {
            return readers[i].read;
        }
    }
    return NULL;
}

/* The options that are not in the table. False after a complaint. */
static bool read_special(struct options *options, const char *name, const char *text, bool *known)
{
    reader *read = find_reader(name);
    uint64_t number = 0;
    *known = true;
    if (read != NULL) {
        return read(options, text);
    }
    if (strcmp(name, "--node") == 0) {
        bool good = read_small(name, text, 1, 16, &number);
        options->node = (unsigned)number;
        return good;
    }
    if (strcmp(name, "--refill") == 0) {
        bool good = read_small(name, text, 1, 3, &number);
        options->refill = (uint32_t)number;
        return good;
    }
    if (strcmp(name, "--wait-states") == 0) {
        bool good = read_small(name, text, 0, 15, &number);
        options->wait_states = (int)number;
        return good;
    }
    if (strcmp(name, "--apb-wait") == 0) {
        bool good = read_small(name, text, 0, 100, &number);
        options->apb_wait = (uint32_t)number;
        return good;
    }
    if (strcmp(name, "--tcp") == 0) {
        options->tcp = read_small(name, text, 0, 65535, &number);
        options->tcp_port = (unsigned)number;
        return options->tcp;
    }
    *known = false;
    return true;
}

static bool read_row(struct options *options, const struct row *row, const char *text)
{
    char *member = (char *)options + row->offset;
    if (row->kind == KIND_TEXT) {
        memcpy(member, (const void *)&text, sizeof text);
        return true;
    }
    uint64_t number = 0;
    if (!read_number(text, row->decimals, row->least, row->most, &number)) {
        complain("%s %s: not such a number, or out of range; see --help", row->name, text);
        return false;
    }
    number *= row->unit;
    memcpy(member, &number, sizeof number);
    return true;
}

static const struct row *find_row(const char *name)
{
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (strcmp(rows[i].name, name) == 0) {
            return &rows[i];
        }
    }
    return NULL;
}

/* Reads one option; `text` is what stands behind it. False after a complaint. */
static bool read_option(struct options *options, const char *name, const char *text, bool *took_text)
{
    const struct row *row = find_row(name);
    bool known = row != NULL;
    *took_text = true;
    if (known && row->kind == KIND_FLAG) {
        bool yes = true;
        memcpy((char *)options + row->offset, &yes, sizeof yes);
        *took_text = false;
        return true;
    }
    if (text == NULL) {
        complain("%s: unknown, or something must stand behind it; see --help", name);
        return false;
    }
    bool good = known ? read_row(options, row, text) : read_special(options, name, text, &known);
    if (!known) {
        complain("%s: no such option; see --help", name);
    }
    return good && known;
}

enum exit_status options_read(struct options *options, int count, char *const arguments[])
{
    *options = (struct options){.for_ps = 10 * VTIME_PS_PER_SECOND,
                                .crystal_hz = 8000000,
                                .crystal_stops_ps = VTIME_NEVER,
                                .lsi_hz = 32000,
                                .baud = 19200,
                                .node = 1,
                                .thresholds = SUPPLY_TYPICAL,
                                .option_bytes = FLASH_OPTIONS_DELIVERED,
                                .idcode = 0x10076413,
                                .flash_kb = 1024,
                                .refill = 3,
                                .apb_wait = 8,
                                .wait_states = -1};
    for (int i = 0; i < count; i++) {
        bool took_text = false;
        if (!read_option(options, arguments[i], i + 1 < count ? arguments[i + 1] : NULL, &took_text)) {
            return EXIT_USAGE;
        }
        i += took_text ? 1 : 0;
    }
    if (options->elf == NULL) {
        complain("no program; write --elf FILE");
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}
