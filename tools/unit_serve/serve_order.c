#include "serve_order.h"

#include "base_limits.h"
#include "line.h"
#include "serve_options.h"

bool serve_text_take(struct serve_text *text, char byte)
{
    if (byte == '\n') {
        return true;
    }
    if (text->length < SERVE_ORDER_BYTES_MAX) {
        text->bytes[text->length++] = byte;
    }
    return false;
}

void serve_text_clear(struct serve_text *text)
{
    text->length = 0;
}

static bool is_blank(char byte)
{
    return byte == ' ' || byte == '\t' || byte == '\r';
}

static bool read_number(const char **at, const char *end, uint8_t max, uint8_t *number)
{
    uint64_t value = 0;
    bool good = line_read_fixed(at, end, 0, max, &value);
    *number = (uint8_t)value;
    return good;
}

static bool read_sign(const char **at, const char *end, char sign)
{
    if (*at == end || **at != sign) {
        return false;
    }
    (*at)++;
    return true;
}

/* [node.]input=level */
static bool read_input(const char *at, const char *end, const struct serve_kind *kind, struct serve_order *order)
{
    uint8_t level = 0;
    if (!read_number(&at, end, SERVE_NODE_MAX, &order->input)) {
        return false;
    }
    if (kind->has_nodes && read_sign(&at, end, '.')) {
        order->node = order->input;
        if (order->node == 0 || !read_number(&at, end, UNIT_INPUTS, &order->input)) {
            return false;
        }
    }
    bool good = read_sign(&at, end, '=') && read_number(&at, end, 1, &level) && at == end;
    order->level = level != 0;
    return good && unit_kind_has_input(kind->unit, order->input);
}

struct serve_order serve_order_read(const struct serve_text *text, const struct serve_kind *kind)
{
    struct serve_order order = {.kind = SERVE_ORDER_NOTHING};
    const char *at = text->bytes;
    const char *end = at + text->length;
    while (at != end && is_blank(*at)) {
        at++;
    }
    while (at != end && is_blank(end[-1])) {
        end--;
    }
    if (at == end) {
        return order;
    }
    if (end - at == 1 && *at == '?') {
        order.kind = SERVE_ORDER_STATUS;
    } else {
        bool good = text->length < SERVE_ORDER_BYTES_MAX && read_input(at, end, kind, &order);
        order.kind = good ? SERVE_ORDER_INPUT : SERVE_ORDER_WRONG;
    }
    return order;
}
