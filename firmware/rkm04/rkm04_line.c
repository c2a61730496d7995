#include "rkm04_line.h"

#include <assert.h>
#include <string.h>

#include "base_tick.h"
#include "hal_line.h"
#include "hal_time.h"

/* The longest answer that outlives a broadcast: Get Position of all motors. Longer ones only tell what has been read,
 * so a request that is executed again because its answer is lost does no harm. */
enum {
    KEPT_BYTES_MAX = 86
};

static_assert((uint32_t)LINK_REQUEST_BYTES_MAX <= (uint32_t)MESSAGES_REQUEST_BYTES_MAX, "every request has an answer");
static_assert((uint32_t)LINK_OPENING == (uint32_t)MESSAGES_VERSION, "Version opens a session");
static_assert((uint32_t)MESSAGES_ANSWER_BYTES_MAX >= (uint32_t)STORE_TEXT_BYTES_MAX, "a stored program must fit");
static_assert((uint32_t)LINK_ANSWER_BYTES_MAX >= (uint32_t)MESSAGES_ANSWER_BYTES_MAX, "every answer can be sent");

void rkm04_line_start(struct rkm04_line *line, struct messages *messages, uint64_t now_ticks)
{
    line->messages = messages;
    line->passed_tick = now_ticks;
    link_init(&line->link, hal_line_node(), line->answer);
}

void rkm04_line_note_pass(struct rkm04_line *line, uint64_t now_ticks)
{
    line->passed_tick = now_ticks;
}

const uint32_t *rkm04_line_counts(const struct rkm04_line *line)
{
    return line->link.receiver.counts;
}

uint8_t *rkm04_line_spare(struct rkm04_line *line)
{
    return &line->answer[0];
}

/* When a request counts as having come. Its last byte, the same moment for all units on the line, as long as motors
 * may begin that far in the past; never before a moment that programs have lived through. */
static uint64_t request_tick(const struct rkm04_line *line, uint64_t end_tick)
{
    uint64_t now = hal_time_now();
    uint64_t tick = end_tick < line->passed_tick ? line->passed_tick : end_tick;
    return now - tick > INTERPRETER_CLOCK_SLACK_TICKS ? now : tick;
}

/* The broadcast's own answer goes into the buffer too, and is lost there; the one that is kept is put back. */
static void execute_broadcast(struct rkm04_line *line, const struct link_request *request, uint64_t tick)
{
    uint8_t kept[KEPT_BYTES_MAX];
    memcpy(kept, line->answer, sizeof kept);
    (void)messages_answer(line->messages, request->message, request->length, tick, line->answer);
    memcpy(line->answer, kept, sizeof kept);
    if (link_kept_bytes(&line->link) > sizeof kept) {
        link_forget(&line->link);
    }
}

static void execute(struct rkm04_line *line, const struct link_request *request)
{
    uint64_t tick = request_tick(line, request->end_tick);
    if (request->broadcast) {
        execute_broadcast(line, request, tick);
    } else {
        link_answer(&line->link,
                    messages_answer(line->messages, request->message, request->length, tick, line->answer));
    }
}

/* True: it has executed a request, and there may be more bytes. */
static bool receive_request(struct rkm04_line *line)
{
    struct hal_line_byte byte;
    struct link_request request;
    while (hal_line_read(&byte)) {
        if (link_take(&line->link, &byte, &request)) {
            execute(line, &request);
            return true;
        }
    }
    return false;
}

static void send_answer(struct rkm04_line *line)
{
    while (link_is_sending(&line->link) && hal_line_write(link_byte(&line->link))) {
        link_advance(&line->link);
    }
}

uint64_t rkm04_line_poll(struct rkm04_line *line)
{
    send_answer(line);
    if (link_is_sending(&line->link)) {
        return TICK_NEVER;
    }
    if (receive_request(line)) {
        return hal_time_now();
    }
    uint64_t wake = link_poll(&line->link, hal_time_now());
    send_answer(line);
    return wake;
}
