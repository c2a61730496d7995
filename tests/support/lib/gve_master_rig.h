/*
 * The master against the line of a unit (firmware/gve134/line) and a few of its commands: the bytes of one are handed
 * to the other, some of them lost or damaged.
 */
#ifndef GVE_MASTER_RIG_H
#define GVE_MASTER_RIG_H

#include "unity.h"

#include <string.h>

#include "base_tick.h"
#include "gve_line.h"
#include "gve_master.h"

enum {
    BAUD = 115200,
    BYTES_MAX = 8192,
    FAULTS_MAX = 64,
    FOREVER_MS = 120000,
    CODE_NONE = 8,
};

#define MS UINT64_C(1000000)
#define UNIT "IP134/200 v1"

enum fault {
    FINE,
    LOST,
    DAMAGED,
    CUT,
    BARE, /* what a unit without checksums says of a command with one */
};

static struct gve_master master;
static struct gve_line unit;
static uint64_t now_ns;
static enum fault requests[FAULTS_MAX]; /* what becomes of the next ones */
static enum fault answers[FAULTS_MAX];
static unsigned frames; /* that the master has sent */
static unsigned said;   /* answers */
static unsigned halts;  /* H that were sent */
static unsigned executed;
static unsigned staged;  /* in the packet under way */
static bool packet_open; /* begun and not ended */
static bool packet_bad;
static bool off;      /* nobody is there */
static bool echo;     /* what is sent comes back */
static bool mute;     /* nothing is answered, whatever is executed */
static bool restarts; /* when the next command has come */
static const char *name;
static const char *flags; /* answered to F, and to P4 */
static const char *positions;
static uint64_t home_ns; /* W is answered then; 0: none is under way */
static uint64_t home_ms; /* so long it takes */
static uint8_t refusal;  /* the code of vectors; CODE_NONE: they are executed */
static uint8_t bytes[BYTES_MAX];
static uint32_t bytes_length; /* what comes to the master next */

static inline void rig_set_up(void)
{
    gve_master_init(&master, BAUD, GVE_MASTER_SUMS_ON);
    gve_line_init(&unit, 0, 7);
    now_ns = 0;
    memset(requests, 0, sizeof requests);
    memset(answers, 0, sizeof answers);
    frames = said = halts = executed = staged = 0;
    packet_open = packet_bad = off = echo = mute = restarts = false;
    name = UNIT;
    flags = "00";
    positions = "0,0,0,0";
    home_ns = 0;
    home_ms = 1000;
    refusal = CODE_NONE;
    bytes_length = 0;
}

static inline enum fault next_of(enum fault *faults)
{
    enum fault fault = faults[0];
    memmove(faults, faults + 1, (FAULTS_MAX - 1) * sizeof *faults);
    return fault;
}

static inline uint32_t harmed(uint8_t *data, uint32_t length, enum fault fault)
{
    switch (fault) {
    case LOST:
        return 0;
    case DAMAGED:
        data[length / 2] ^= 4U;
        return length;
    case CUT:
        return length - 1;
    case BARE:
        memcpy(data, "4\r", 2);
        return 2;
    case FINE:
        break;
    }
    return length;
}

static inline void say(const char *text)
{
    memcpy(bytes + bytes_length, text, strlen(text));
    bytes_length += (uint32_t)strlen(text);
}

static inline void send_answer(void)
{
    uint32_t begin = bytes_length;
    for (; gve_line_is_sending(&unit); gve_line_advance(&unit)) {
        bytes[bytes_length++] = gve_line_byte(&unit);
    }
    said++;
    bytes_length = begin + (mute ? 0 : harmed(bytes + begin, bytes_length - begin, next_of(answers)));
}

static inline void answer(enum gve_code code, bool inta, const char *values)
{
    gve_line_answer(&unit, code, inta, (const uint8_t *)values, (uint32_t)strlen(values));
    send_answer();
}

static inline void end_packet(const struct gve_command *end)
{
    bool taken = !packet_bad && (unsigned)end->numbers[0] == staged;
    char values[2] = {taken ? (char)('0' + staged) : '0', '\0'};
    executed += taken ? staged : 0;
    packet_open = false;
    answer(taken ? GVE_DONE : GVE_DAMAGED, false, values);
}

static inline void execute(const struct gve_command *command)
{
    switch (command->opcode) {
    case GVE_INDEX:
        gve_line_answer_index(&unit, false);
        send_answer();
        break;
    case GVE_REPEAT:
        gve_line_answer_again(&unit, false);
        send_answer();
        break;
    case GVE_VERSION:
        answer(GVE_DONE, false, name);
        break;
    case GVE_POSITION_2:
        answer(GVE_DONE, false, "0,-5");
        break;
    case GVE_POSITION_4:
        answer(GVE_DONE, false, positions);
        break;
    case GVE_FLAGS:
        answer(GVE_DONE, false, flags);
        break;
    case GVE_REFERENCE:
        home_ns = now_ns + home_ms * MS;
        executed++;
        break;
    case GVE_HALT:
        answer(GVE_DONE, true, "");
        break;
    case GVE_RESET:
        answer(GVE_DONE, false, "");
        gve_line_init(&unit, 0, 7);
        break;
    case GVE_LINE:
    case GVE_CONTINUE:
        executed += refusal == CODE_NONE ? 1 : 0;
        answer(refusal == CODE_NONE ? GVE_DONE : (enum gve_code)refusal, false, "");
        break;
    default:
        answer(GVE_DONE, false, "");
        break;
    }
}

static inline void serve(const struct gve_request *request)
{
    bool is_command = request->kind == GVE_REQUEST_COMMAND;
    if (restarts) {
        restarts = false;
        gve_line_init(&unit, 0, 7);
    } else if (is_command && request->fault == GVE_FAULT_NONE && request->command.opcode == GVE_PACKET_BEGIN) {
        packet_open = true;
        packet_bad = false;
        staged = 0;
    } else if (is_command && request->command.opcode == GVE_PACKET_END && packet_open) {
        end_packet(&request->command);
    } else if (packet_open && request->kind == GVE_REQUEST_DAMAGE) {
        packet_open = false;
        answer(GVE_DAMAGED, false, "0");
    } else if (packet_open) {
        packet_bad = packet_bad || !is_command;
        staged++;
    } else if (!is_command) {
        answer(GVE_DAMAGED, false, "");
    } else if (request->fault != GVE_FAULT_NONE) {
        answer(gve_fault_code((enum gve_fault)request->fault), false, "");
    } else {
        execute(&request->command);
    }
}

static inline void pass_time_in_unit(void)
{
    struct gve_request request;
    (void)gve_line_poll(&unit, TICKS_PER_MS * (now_ns / MS));
    bool is_home = home_ns != 0 && (now_ns >= home_ns || gve_line_keeps(&unit, GVE_HALT));
    if (is_home) {
        bool is_cut_short = now_ns < home_ns;
        home_ns = 0;
        answer(GVE_DONE, is_cut_short, "");
    }
    while (home_ns == 0 && gve_line_next(&unit, &request)) {
        serve(&request);
    }
}

/* Carries what the master has written. */
static inline void carry(void)
{
    static uint8_t written[GVE_WIRE_OUT_BYTES];
    uint32_t length = master.wire.out_length;
    memcpy(written, master.wire.out, length);
    frames++;
    halts += length > 3 && memcmp(written, "!0H", 3) == 0 ? 1 : 0;
    if (echo) {
        memcpy(bytes + bytes_length, written, length);
        bytes_length += length;
    }
    length = off ? 0 : harmed(written, length, next_of(requests));
    for (uint32_t i = 0; i < length; i++) {
        gve_line_take(&unit, &(struct hal_line_byte){.tick = TICKS_PER_MS * (now_ns / MS), .value = written[i]});
    }
    master.wire.out_length = 0;
}

/* A millisecond passes. */
static inline enum gve_master_end pass(void)
{
    enum gve_master_end end = gve_master_poll(&master, now_ns);
    if (master.wire.out_length > 0) {
        carry();
    }
    now_ns += MS;
    pass_time_in_unit();
    gve_master_take(&master, bytes, bytes_length, now_ns);
    bytes_length = 0;
    return end;
}

static inline enum gve_master_end finish(void)
{
    for (unsigned ms = 0; ms < FOREVER_MS; ms++) {
        enum gve_master_end end = pass();
        if (end != GVE_MASTER_WAITS) {
            return end;
        }
    }
    TEST_FAIL_MESSAGE("the request does not end");
    return GVE_MASTER_WAITS;
}

static inline void begin(enum gve_master_kind kind, const char *text)
{
    const struct gve_master_order order = {.kind = (uint8_t)kind, .length = (uint32_t)strlen(text), .wait_ms = 30000};
    memcpy(master.text, text, order.length);
    gve_master_begin(&master, &order, now_ns);
}

static inline enum gve_master_end request(enum gve_master_kind kind, const char *text)
{
    begin(kind, text);
    return finish();
}

static inline enum gve_master_end ask(const char *text)
{
    return request(GVE_MASTER_ASK, text);
}

/* All is ready, and nothing was counted. */
static inline void connect(void)
{
    TEST_ASSERT_EQUAL(GVE_MASTER_ANSWERED, request(GVE_MASTER_CONNECT, ""));
    frames = said = executed = 0;
}

#endif
