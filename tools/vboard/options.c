#include "options.h"

#include <stddef.h>
#include <string.h>

#include "line.h"
#include "pins.h"
#include "vtime.h"

const char options_usage[] =
    "usage: rkm04-vboard --elf FILE [OPTION ...]\n"
    "\n"
    "Runs the program of an STM32F405 or F407 instruction by instruction and prints a summary (JSON).\n"
    "\n"
    "  --elf FILE            the program\n"
    "  --pins FILE           signals on pins: lines `m1_step PA0`, `bi1 PC0 low`, `line USART2`\n"
    "  --for SECONDS         ends after so much virtual time (10)\n"
    "  --end-at SYMBOL       ends when this function is reached\n"
    "  --inputs FILE         levels of the inputs: lines ms,input,level\n"
    "  --node N              the address on switch S1, 1 to 16 (1)\n"
    "  --line-script FILE    bytes on the line: lines `ms hexbytes`; * behind a byte: framing error, ~: noise\n"
    "  --line-log FILE       bytes the unit sends: lines `ms hexbyte`; * behind it: nobody could read it\n"
    "  --baud RATE           of the line (19200)\n"
    "  --pty PATH, --tcp PORT  a client on the line, in real time\n"
    "  --steps, --vcd FILE   write pulses and waveforms\n"
    "  --ticks reset|timer   the steps' ticks count from power-on or from the start of TIM2 (reset)\n"
    "  --flash FILE          content of the flash, read before and written after\n"
    "  --set SYMBOL=HEX      bytes put over a constant of the program; may be repeated\n"
    "  --watch SYMBOL        a variable to be shown in the summary; may be repeated\n"
    "  --stack-limit SYMBOL  the lowest address of the stack\n"
    "  --measure-from MS     the statistics begin then (0)\n"
    "  --profile FILE        write where the cycles went, instruction by instruction\n"
    "cycle model:\n"
    "  --refill P            cycles to refill the pipeline, 1 to 3 (3)\n"
    "  --wait-states N       of the flash, 0 to 15 (as FLASH_ACR says)\n"
    "  --apb-wait N          cycles by which an access to a slow bus takes longer (3)\n"
    "  --art                 model the accelerator of the flash\n"
    "  --match-equal         a compare value written while the timer stands on it matches\n"
    "  --exti-mask-first     an edge on a masked line of EXTI leaves nothing pending\n"
    "  --pwm-at-once         a channel that comes from a forced level shows the comparison at once\n"
    "faults:\n"
    "  --crystal MHZ         frequency of the crystal (8); --no-crystal: there is none\n"
    "  --crystal-stops MS    it stops then\n"
    "  --lsi HZ              rate of the watchdog's oscillator (32000)\n"
    "  --slow-flash          flash times of the worst case\n"
    "  --flash-erase MS      an erase takes that long (as the data sheet says)\n"
    "  --flash-fail N[:HOW]  the N-th operation of the flash fails: wrp, pga, pgp, pgs or op is what it tells (wrp);\n"
    "                        silent: it tells nothing and does nothing; bit: it leaves one bit as it was\n"
    "  --power-cut N[:LEAVES]  power is cut in the N-th one, which leaves nothing, all, half, or what a number gives\n"
    "                        as a seed (half); may be repeated; --power-back: power comes back at once\n"
    "  --timer-start N       TIM2 starts with this count (0)\n"
    "  --fault MS:WHAT       something goes wrong then, until the next reset; may be repeated:\n"
    "                        jump=PLACE    the program goes on there\n"
    "                        sp=PLACE      the stack pointer points there\n"
    "                        word=PLACE:X  a word of memory has this value\n"
    "                        hold=PLACE    the program does not get past this instruction; interrupts do\n"
    "                        lose=N[,MS]   exception N is not taken, or not for some time\n"
    "                        power         power goes and comes back at once\n"
    "                        supply=MV     the voltage detector sees this supply (3300)\n"
    "                        A PLACE is hexadecimal, or a symbol, or SYMBOL+HEX.\n"
    "  --stuck PIN=LEVEL     a pin is stuck; may be repeated\n"
    "\n"
    "example: rkm04-vboard --elf rkm04.elf --pins board.pins --line-script send.txt --for 2 --steps steps.csv\n";

enum kind {
    KIND_TEXT,
    KIND_FLAG,
    KIND_NUMBER,
};

#define SECONDS_DECIMALS 9
#define MS_DECIMALS 6

struct row {
    const char *name;
    size_t offset;     /* of the member: const char *, bool or uint64_t */
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
    TEXT("--end-at", end_at),
    TEXT("--stack-limit", stack_limit),
    FLAG("--art", art),
    FLAG("--no-crystal", no_crystal),
    FLAG("--slow-flash", slow_flash),
    FLAG("--match-equal", match_equal),
    FLAG("--exti-mask-first", exti_mask_first),
    FLAG("--pwm-at-once", pwm_at_once),
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
        {"--watch", read_watch},   {"--set", read_set}, {"--stuck", read_stuck},
        {"--flash-fail", read_flash_failure}, {"--power-cut", read_cut}, {"--fault", read_fault},
        {"--ticks", read_ticks},
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
                                .refill = 3,
                                .apb_wait = 3,
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
