#include "unit_line.h"

#include <assert.h>
#include <string.h>

#include "base_tick.h"
#include "hal_line.h"
#include "hal_time.h"
#include "unit.h"

/* The longest answer that outlives a broadcast: Get Position of all motors. Longer ones only tell what has been read,
 * so a request that is executed again because its answer is lost does no harm. */
enum {
    KEPT_BYTES_MAX = 86
};

static_assert((uint32_t)LINK_REQUEST_BYTES_MAX <= (uint32_t)PROTOCOL_REQUEST_BYTES_MAX, "every request has an answer");
static_assert((uint32_t)LINK_OPENING == (uint32_t)PROTOCOL_VERSION, "Version opens a session");
static_assert((uint32_t)LINK_ANSWER_BYTES_MAX >= (uint32_t)PROTOCOL_ANSWER_BYTES_MAX, "every answer can be sent");

void unit_line_start(struct unit *unit)
{
    link_init(&unit->link, hal_line_node(), unit->answer);
}

/* When a request counts as having come. Its last byte, the same moment for all units on the line, as long as motors
 * may begin that far in the past; never before a moment that programs have lived through. */
static uint64_t request_tick(const struct unit *unit, uint64_t end_tick)
{
    uint64_t now = hal_time_now();
    uint64_t tick = end_tick < unit->polled_tick ? unit->polled_tick : end_tick;
    return now - tick > INTERPRETER_CLOCK_SLACK_TICKS ? now : tick;
}

/* The broadcast's own answer goes into the buffer too, and is lost there; the one that is kept is put back. */
static void execute_broadcast(struct unit *unit, const struct link_request *request, uint64_t tick)
{
    uint8_t kept[KEPT_BYTES_MAX];
    memcpy(kept, unit->answer, sizeof kept);
    (void)protocol_answer(&unit->protocol, request->message, request->length, tick, unit->answer);
    memcpy(unit->answer, kept, sizeof kept);
    if (link_kept_bytes(&unit->link) > sizeof kept) {
        link_forget(&unit->link);
    }
}

static void execute(struct unit *unit, const struct link_request *request)
{
    uint64_t tick = request_tick(unit, request->end_tick);
    if (request->broadcast) {
        execute_broadcast(unit, request, tick);
    } else {
        link_answer(&unit->link,
                    protocol_answer(&unit->protocol, request->message, request->length, tick, unit->answer));
    }
}

/* True: it has executed a request, and there may be more bytes. */
static bool receive_request(struct unit *unit)
{
    struct hal_line_byte byte;
    struct link_request request;
    while (hal_line_read(&byte)) {
        if (link_take(&unit->link, &byte, &request)) {
            execute(unit, &request);
            return true;
        }
    }
    return false;
}

static void send_answer(struct unit *unit)
{
    while (link_is_sending(&unit->link) && hal_line_write(link_byte(&unit->link))) {
        link_advance(&unit->link);
    }
}

uint64_t unit_line_poll(struct unit *unit)
{
    send_answer(unit);
    if (link_is_sending(&unit->link)) {
        return TICK_NEVER;
    }
    if (receive_request(unit)) {
        return hal_time_now();
    }
    uint64_t wake = link_poll(&unit->link, hal_time_now());
    send_answer(unit);
    return wake;
}
