#include "serve_talk.h"

#include <stdio.h>

#include "line.h"

enum {
    USER = -1, /* in place of the number of a client */
    ANSWER_BYTES_MAX = SERVE_STATUS_BYTES_MAX + 128,
};

void serve_talk_init(struct serve_talk *talk, struct serve_units *units, const struct serve_line *line,
                     struct serve_port *control)
{
    talk->units = units;
    talk->line = line;
    talk->control = control;
    serve_text_clear(&talk->user);
    for (unsigned i = 0; i < SERVE_CLIENTS_MAX; i++) {
        serve_text_clear(&talk->clients[i]);
    }
}

static void answer(struct serve_talk *talk, int client, const char *text, const char *end)
{
    size_t length = (size_t)(end - text);
    if (client == USER) {
        (void)fwrite(text, 1, length, stdout);
        (void)fflush(stdout);
    } else {
        serve_port_write(talk->control, (unsigned)client, text, length);
    }
}

static void answer_error(struct serve_talk *talk, int client, const char *wrong)
{
    char text[ANSWER_BYTES_MAX];
    char *at = line_put_string(text, "{\"error\": \"");
    at = line_put_string(at, wrong);
    answer(talk, client, text, line_put_string(at, "\"}\n"));
}

static void answer_done(struct serve_talk *talk, int client)
{
    char text[ANSWER_BYTES_MAX];
    answer(talk, client, text, line_put_string(text, "{\"ok\": true}\n"));
}

static char *put_count(const char *name, uint64_t count, char *at)
{
    at = line_put_string(at, ", \"");
    at = line_put_string(at, name);
    at = line_put_string(at, "\": ");
    return line_put_unsigned(at, count);
}

static void answer_status(struct serve_talk *talk, int client)
{
    char text[ANSWER_BYTES_MAX];
    for (unsigned i = 0; i < talk->units->count; i++) {
        char *at = line_put_string(text, "{");
        at = serve_unit_put_status(talk->units->list[i], at);
        at = put_count("clients", serve_port_clients(talk->line->port), at);
        at = put_count("dropped", talk->line->port->dropped, at);
        at = put_count("lost", talk->line->to_units.lost + talk->line->to_clients.lost, at);
        at = put_count("changed", talk->line->to_units.changed + talk->line->to_clients.changed, at);
        answer(talk, client, text, line_put_string(at, "}\n"));
    }
}

static void set_input(struct serve_talk *talk, int client, const struct serve_order *order)
{
    const char *wrong = serve_units_set_input(talk->units, order);
    if (wrong == NULL) {
        answer_done(talk, client);
    } else {
        answer_error(talk, client, wrong);
    }
}

static void obey(struct serve_talk *talk, int client, const struct serve_text *text)
{
    struct serve_order order = serve_order_read(text, talk->units->kind);
    switch (order.kind) {
    case SERVE_ORDER_NOTHING:
        break;
    case SERVE_ORDER_STATUS:
        answer_status(talk, client);
        break;
    case SERVE_ORDER_INPUT:
        set_input(talk, client, &order);
        break;
    case SERVE_ORDER_WRONG:
        answer_error(talk, client, talk->units->kind->order_help);
        break;
    }
}

static void take(struct serve_talk *talk, int client, struct serve_text *text, const char *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (serve_text_take(text, bytes[i])) {
            obey(talk, client, text);
            serve_text_clear(text);
        }
    }
}

void serve_talk_user(struct serve_talk *talk, const char *bytes, size_t count)
{
    take(talk, USER, &talk->user, bytes, count);
}

void serve_talk_begin(struct serve_talk *talk, unsigned client)
{
    serve_text_clear(&talk->clients[client]);
}

void serve_talk_client(struct serve_talk *talk, unsigned client, const char *bytes, size_t count)
{
    take(talk, (int)client, &talk->clients[client], bytes, count);
}
