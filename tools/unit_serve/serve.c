#include "serve.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base_tick.h"
#include "json.h"
#include "serve_clock.h"
#include "serve_line.h"
#include "serve_port.h"
#include "serve_signal.h"
#include "serve_socket.h"
#include "serve_talk.h"
#include "serve_units.h"
#include "units.h"

enum {
    PORT_SLOTS = 1 + SERVE_CLIENTS_MAX,
    SLOT_SIGNAL = 0,
    SLOT_USER = 1, /* standard input */
    SLOT_LINE = 2,
    SLOT_CONTROL = SLOT_LINE + PORT_SLOTS,
    SLOTS = SLOT_CONTROL + PORT_SLOTS,

    CHUNK_BYTES = 1024,
};

static_assert((unsigned)SERVE_ROOM_MIN >= (unsigned)SERVE_REQUEST_BYTES_MAX + (unsigned)CHUNK_BYTES,
              "what is held of a request and all that is read at a time fit");
static_assert((unsigned)SLOTS <= (unsigned)SOCKET_SLOTS_MAX, "all are waited for at once");

/* While motors run the units are looked at this often, not at every pulse. */
#define REST_NS UINT64_C(1000000)

/* So long units may run before clients are looked at again. */
#define BUSY_NS UINT64_C(5000000)

/* So much they run at a time. */
#define SLICE_TICKS ((uint64_t)TICKS_PER_MS)

struct serve {
    const struct serve_kind *kind;
    const struct serve_options *options;
    struct serve_units units;
    struct serve_line line;
    struct serve_turns turns;
    struct serve_port line_port;
    struct serve_port control_port;
    struct serve_talk talk;
    struct serve_clock clock;
    uint64_t rested_ns; /* real time at which the units caught up last */
    struct socket_slot slots[SLOTS];
    bool touched; /* bytes or inputs have come that the units have not seen yet */
    bool over;    /* standard input has ended, and this is to end with it */
};

static enum exit_status open_ports(struct serve *serve)
{
    const struct serve_options *options = serve->options;
    enum exit_status status = options->pty != NULL
                                  ? serve_port_open_pty(&serve->line_port, options->pty)
                                  : serve_port_listen(&serve->line_port, "--tcp", options->address, options->tcp_port);
    if (status == EXIT_DONE && options->control) {
        status = serve_port_listen(&serve->control_port, "--control", options->address, options->control_port);
    }
    return status;
}

static enum exit_status tell_ready(const struct serve *serve)
{
    const char *line = serve->line_port.name;
    const char *control = serve->control_port.name;
    if (!serve->options->json) {
        (void)printf(*control != '\0' ? "listening on %s, control on %s\n" : "listening on %s\n", line, control);
        return finish_output();
    }
    (void)fputs("{\"listening\": ", stdout);
    json_print_string(line);
    (void)fputs(", \"control\": ", stdout);
    if (*control != '\0') {
        json_print_string(control);
    } else {
        (void)fputs("null", stdout);
    }
    for (unsigned i = 0; serve->kind->has_nodes && i < serve->options->units; i++) {
        (void)printf("%s%u", i == 0 ? ", \"nodes\": [" : ", ", (unsigned)serve->options->nodes[i]);
    }
    (void)fputs(serve->kind->has_nodes ? "]}\n" : "}\n", stdout);
    return finish_output();
}

/* Lets the units run as far as the clock has come, or until clients have waited long enough. If the units are
 * hopelessly too slow for it, the clock goes on from where they are. */
static void follow_clock(struct serve *serve)
{
    uint64_t begin_ns = units_real_ns();
    uint64_t target = serve_clock_tick(&serve->clock, begin_ns);
    while (serve->units.now < target && units_real_ns() - begin_ns < BUSY_NS) {
        uint64_t left = target - serve->units.now;
        serve_units_run(&serve->units, serve->units.now + (left < SLICE_TICKS ? left : SLICE_TICKS));
    }
    uint64_t lag_max = (uint64_t)serve->clock.milli_speed * SERVE_LAG_MS_MAX * TICKS_PER_MS / 1000U;
    if (serve->units.now < target && target - serve->units.now > lag_max) {
        serve_clock_set(&serve->clock, begin_ns, serve->units.now);
    }
}

/* Up to there units may wait for silence on the line. */
static uint64_t silence_end(const struct serve *serve)
{
    return serve->line.last_tick + serve->kind->silence_ticks;
}

/* Without a clock: lets them run while there is work, to its next event where that is far; and through the silence on
 * the line for which they wait. */
static void run_ahead(struct serve *serve)
{
    uint64_t begin_ns = units_real_ns();
    while (serve_units_have_work(&serve->units) && units_real_ns() - begin_ns < BUSY_NS) {
        uint64_t next = serve_units_next_tick(&serve->units);
        uint64_t slice = serve->units.now + SLICE_TICKS;
        serve_units_run(&serve->units, next < slice ? slice : next + 1U);
    }
    if (!serve_units_have_work(&serve->units)) {
        serve_units_run(&serve->units, silence_end(serve));
    }
}

/* What has come acts at once: it is not left for the next look at the clock. */
static void show_touch(struct serve *serve)
{
    uint64_t last = serve->options->unpaced ? serve->line.last_tick : 0;
    uint64_t now = serve->units.now;
    serve_units_run(&serve->units, (last < now ? now : last) + 1U);
    serve->touched = false;
}

static void catch_up(struct serve *serve)
{
    if (serve->options->milli_speed == 0) {
        run_ahead(serve);
    } else {
        follow_clock(serve);
    }
    serve->rested_ns = units_real_ns();
}

/* A program that has been stored is in the file before the answer is out. */
static void pass_on(struct serve *serve)
{
    serve_units_save(&serve->units);
    serve_line_flush(&serve->line);
}

static void put_in_turn(struct serve *serve, unsigned client, const uint8_t *bytes, size_t count)
{
    uint64_t now_ns = units_real_ns();
    if (!serve_units_owe(&serve->units)) {
        serve_turns_forget(&serve->turns);
    }
    for (size_t i = 0; i < count; i++) {
        uint32_t length = serve_turns_take(&serve->turns, client, bytes[i], now_ns);
        serve_line_put(&serve->line, serve->units.now, serve->turns.held[client].bytes, length);
    }
}

static bool has_room(struct serve *serve)
{
    return serve_line_room(&serve->line, serve->units.now) >= (uint32_t)SERVE_ROOM_MIN;
}

static void hear_line(struct serve *serve, unsigned client)
{
    uint8_t bytes[CHUNK_BYTES];
    size_t count = has_room(serve) ? serve_port_read(&serve->line_port, client, bytes, sizeof bytes) : 0;
    if (serve->line.turns != NULL) {
        put_in_turn(serve, client, bytes, count);
    } else {
        serve_line_put(&serve->line, serve->units.now, bytes, (uint32_t)count);
    }
    serve_units_hear(&serve->units, &serve->line);
    serve->touched = serve->touched || count > 0;
}

static void hear_control(struct serve *serve, unsigned client)
{
    char bytes[CHUNK_BYTES];
    size_t count = serve_port_read(&serve->control_port, client, bytes, sizeof bytes);
    serve_talk_client(&serve->talk, client, bytes, count);
    serve->touched = serve->touched || count > 0;
}

/* At its end, and where reading is not allowed, it is listened to no more; or all ends. */
static void hear_user(struct serve *serve)
{
    char bytes[CHUNK_BYTES];
    ptrdiff_t count = socket_read(serve->slots[SLOT_USER].fd, bytes, sizeof bytes);
    if (count > 0) {
        serve_talk_user(&serve->talk, bytes, (size_t)count);
        serve->touched = true;
    } else if (count == 0 || (errno != EINTR && errno != EAGAIN)) {
        serve->slots[SLOT_USER].fd = -1;
        serve->over = serve->options->until_eof;
    }
}

static void hear_all(struct serve *serve)
{
    const struct socket_slot *line = &serve->slots[SLOT_LINE];
    const struct socket_slot *control = &serve->slots[SLOT_CONTROL];
    if (serve->slots[SLOT_USER].ready) {
        hear_user(serve);
    }
    for (unsigned i = 0; i < SERVE_CLIENTS_MAX; i++) {
        if (line[1U + i].ready) {
            hear_line(serve, i);
        }
        if (control[1U + i].ready) {
            hear_control(serve, i);
        }
    }
    if (line->ready) {
        int client = serve_port_accept(&serve->line_port);
        if (client >= 0 && serve->line.turns != NULL) {
            serve_turns_begin(&serve->turns, (unsigned)client);
        }
    }
    if (control->ready) {
        int client = serve_port_accept(&serve->control_port);
        if (client >= 0) {
            serve_talk_begin(&serve->talk, (unsigned)client);
        }
    }
}

static void fill_slots(struct socket_slot *slots, const struct serve_port *port, bool reads)
{
    slots[0] = (struct socket_slot){.fd = port->listener};
    for (unsigned i = 0; i < SERVE_CLIENTS_MAX; i++) {
        slots[1U + i] = (struct socket_slot){.fd = reads ? port->clients[i] : -1};
    }
}

/* How long there is nothing to do. False: without end. */
static bool find_rest(const struct serve *serve, uint64_t *rest_ns)
{
    *rest_ns = 0;
    if (serve->options->milli_speed == 0) {
        return serve_units_have_work(&serve->units) || serve->units.now < silence_end(serve);
    }
    uint64_t next = serve_units_next_tick(&serve->units);
    if (next == TICK_NEVER) {
        return false;
    }
    uint64_t due_ns = serve_clock_ns(&serve->clock, next);
    uint64_t soon_ns = serve->rested_ns + REST_NS;
    uint64_t now_ns = units_real_ns();
    due_ns = due_ns < soon_ns ? soon_ns : due_ns;
    *rest_ns = due_ns > now_ns ? due_ns - now_ns : 0;
    return true;
}

/* False: the end has been asked for. */
static bool wait_for_something(struct serve *serve)
{
    uint64_t rest_ns = 0;
    bool limited = find_rest(serve, &rest_ns);
    fill_slots(&serve->slots[SLOT_LINE], &serve->line_port, has_room(serve));
    fill_slots(&serve->slots[SLOT_CONTROL], &serve->control_port, true);
    serve_units_hear(&serve->units, &serve->line);
    socket_wait(serve->slots, SLOTS, limited ? &rest_ns : NULL);
    return !serve->slots[SLOT_SIGNAL].ready && !serve->over;
}

static void serve_for_ever(struct serve *serve)
{
    serve->clock.milli_speed = serve->options->milli_speed;
    serve_clock_set(&serve->clock, units_real_ns(), serve->units.now);
    catch_up(serve);
    while (!serve->over && wait_for_something(serve)) {
        catch_up(serve);
        hear_all(serve);
        if (serve->touched) {
            show_touch(serve);
        }
        pass_on(serve);
    }
}

static enum exit_status begin(struct serve *serve)
{
    if (!socket_start()) {
        return EXIT_REFUSED;
    }
    bool in_turn = serve->kind->asks != NULL && serve->options->pty == NULL;
    serve_turns_init(&serve->turns, serve->kind);
    serve_line_init(&serve->line, &serve->line_port, in_turn ? &serve->turns : NULL, serve->kind->byte_ticks,
                    serve->options);
    serve_talk_init(&serve->talk, &serve->units, &serve->line, &serve->control_port);
    serve->slots[SLOT_SIGNAL] = (struct socket_slot){.fd = serve_signal_catch()};
    serve->slots[SLOT_USER] = (struct socket_slot){.fd = socket_user()};
    if (serve->slots[SLOT_SIGNAL].fd < 0) {
        return EXIT_REFUSED;
    }
    enum exit_status status = serve_units_begin(&serve->units, serve->kind, serve->options, &serve->line);
    if (status == EXIT_DONE) {
        status = open_ports(serve);
    }
    return status == EXIT_DONE ? tell_ready(serve) : status;
}

enum exit_status serve_run(const struct serve_kind *kind, const struct serve_options *options)
{
    struct serve *serve = calloc(1, sizeof *serve);
    if (serve == NULL) {
        complain("there is not memory enough for a line; close other programs");
        return EXIT_REFUSED;
    }
    serve->kind = kind;
    serve->options = options;
    serve_port_init(&serve->line_port);
    serve_port_init(&serve->control_port);
    enum exit_status status = begin(serve);
    if (status == EXIT_DONE) {
        serve_for_ever(serve);
        status = serve_units_save_rest(&serve->units) ? EXIT_DONE : EXIT_REFUSED;
    }
    serve_port_close(&serve->line_port);
    serve_port_close(&serve->control_port);
    serve_units_discard(&serve->units);
    free(serve);
    return status;
}
