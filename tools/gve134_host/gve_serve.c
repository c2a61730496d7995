#include "gve_serve.h"

#include "base_tick.h"
#include "gve134.h"
#include "gve_kind.h"
#include "serve.h"

const char gve_serve_usage[] =
    "usage: gve134-host serve [--tcp PORT | --pty PATH] [--flash FILE] [--speed X] [--baud N]\n"
    "                         [--unpaced] [--control PORT] [--address ADDRESS] [--noise N] [--loss N] [--seed N]\n"
    "                         [--json] [--until-eof]\n"
    "\n"
    "A unit in real time, until Ctrl-C. When ready it prints where it listens.\n"
    "\n"
    "--tcp PORT        listens there (5000); 0 takes any free port\n"
    "--pty PATH        makes a pty and the link PATH to it\n"
    "--flash FILE      keeps the EEPROM\n"
    "--speed X         times real time, 0.001 to 1000; 0: as fast as possible (1)\n"
    "--baud N          the rate of the line (115200)\n" SERVE_HELP_OF_ALL "\n"
    "Lines on standard input: 3=0 closes input 3 to ground, 3=1 opens it, ? prints the state. Each is\n"
    "answered by a line of JSON, but an empty one by nothing. All inputs are open at the start.\n"
    "\n"
    "example: gve134-host serve --flash unit.flash\n";

static bool read_baud(void *target, const char *value)
{
    struct serve_options *options = target;
    return gve_read_baud(value, &options->baud);
}

/* ---- whose an answer is ---- */

enum {
    ADDRESS_BYTES = 2,
    HEAD_BYTES = ADDRESS_BYTES + 2, /* with what tells the names that matter here */
};

/* The begin of a line as the unit reads it: from its last ! on, in capitals, without LF; zeros after it. */
struct head {
    uint8_t text[HEAD_BYTES];
    uint32_t length;
};

static uint8_t capital(uint8_t byte)
{
    return byte >= 'a' && byte <= 'z' ? (uint8_t)(byte - 'a' + 'A') : byte;
}

static struct head head_of(const uint8_t *line, uint32_t length)
{
    struct head head = {.length = 0};
    for (uint32_t i = 0; i < length; i++) {
        if (line[i] == '!') {
            head = (struct head){.length = 0};
        }
        if (line[i] != '\n' && head.length < (uint32_t)HEAD_BYTES) {
            head.text[head.length++] = capital(line[i]);
        }
    }
    return head;
}

static bool is_named(const struct head *head, char name)
{
    const uint8_t *begin = head->text + ADDRESS_BYTES;
    return begin[0] == (uint8_t)name && (begin[1] == 0 || begin[1] == ',');
}

static bool is_of_packet(const struct head *head, char which)
{
    const uint8_t *begin = head->text + ADDRESS_BYTES;
    return begin[0] == '*' && begin[1] == (uint8_t)which;
}

static bool is_for_unit(const struct head *head)
{
    unsigned address = (unsigned)head->text[1] - '0';
    return head->text[0] == '!' && (address == (unsigned)GVE134_INTERPOLATOR || address == (unsigned)GVE134_SPINDLE);
}

/* Of an open packet all but what ends it. */
static bool is_inside(const struct head *head, bool goes_on)
{
    return is_of_packet(head, 'S') || (goes_on && !is_of_packet(head, 'E') && !is_named(head, 'H'));
}

static enum serve_asks asks(const uint8_t *line, uint32_t length, bool goes_on)
{
    const struct head head = head_of(line, length);
    if (!is_for_unit(&head)) {
        return goes_on ? SERVE_ASKS_MORE : SERVE_ASKS_NOTHING;
    }
    if (is_named(&head, 'J')) {
        return SERVE_ASKS_RESET;
    }
    if (is_inside(&head, goes_on)) {
        return SERVE_ASKS_MORE;
    }
    if (is_named(&head, '>')) {
        return SERVE_ASKS_AGAIN;
    }
    return is_named(&head, '@') ? SERVE_ASKS_APART : SERVE_ASKS;
}

static bool owes(const void *context)
{
    const struct gve134 *unit = context;
    bool has_heard = unit->line.count == 0 && gve_receiver_wake(&unit->line.receiver) == TICK_NEVER;
    bool is_done = unit->waiting == (uint8_t)GVE134_WAITS_NOT && !gve_line_is_sending(&unit->line);
    return !has_heard || !is_done;
}

/* The unit after a reset has made no answer: what it sends is older. */
static bool answers_reset(const void *context)
{
    const struct gve134 *unit = context;
    const struct gve_answer *answer = &unit->line.answer;
    bool has_none = answer->last.length == 0 && answer->apart.length == 0;
    return has_none || unit->waiting == (uint8_t)GVE134_WAITS_FOR_RESET;
}

enum exit_status gve_serve(int count, char *const arguments[])
{
    const struct argument baud = ARGUMENT_OTHER_ROW("--baud", read_baud);
    struct serve_options options;
    struct serve_kind kind = {
        .unit = &gve_kind_of_unit,
        .tool = "gve134",
        .order_help = "not understood; write 3=0 or 3=1 for input 3 (there are 1 to 4, 7 and 8), or ?",
        .flash_mark = "GVE1",
        .asks = asks,
        .owes = owes,
        .answers_reset = answers_reset,
    };
    enum exit_status status = serve_options_read(&options, &baud, count, arguments);
    if (status != EXIT_DONE) {
        return status;
    }
    kind.byte_ticks = gve_byte_ticks(options.baud != 0 ? options.baud : GVE_BAUD);
    return serve_run(&kind, &options);
}
