#include "soak_line.h"

#include <string.h>

#include "base_tick.h"

enum {
    WAIT_MS = 25,          /* an answer has begun within 20 ms */
    ANSWER_MS_MAX = 10000, /* the longest takes 9 s, were every byte escaped */
    STATUS_BYTES = 102,
    KEPT_MAX = 2 + 86, /* address, number, and what of an answer outlives a broadcast */
};

void soak_require(struct soak_master *master, bool good, const char *promise)
{
    if (!good && master->trouble == NULL) {
        master->trouble = promise;
        master->trouble_tick = master->soak->machine.now;
    }
}

void soak_hear(struct soak_master *master, const uint8_t *bytes, uint32_t length, uint64_t broken_mask)
{
    struct soak_unit *soak = master->soak;
    for (uint32_t i = 0; i < length; i++) {
        bool broken = (broken_mask >> i % 64U & 1U) != 0;
        uint64_t tick = soak->machine.now + (uint64_t)(i + 1U) * HOST_LINE_BYTE_TICKS;
        master->script[i] = (struct host_line_byte){.tick = tick, .value = bytes[i], .broken = broken};
        master->tally.broken += broken ? 1U : 0U;
    }
    soak->sent_count = 0;
    host_machine_set_line(&soak->machine, master->script, length);
    soak_unit_run(soak, (uint64_t)(length + 1U) * HOST_LINE_BYTE_TICKS);
    soak_unit_run(soak, (uint64_t)WAIT_MS * TICKS_PER_MS);
    for (unsigned i = 0; i < ANSWER_MS_MAX && soak->machine.line.to_send_count != 0; i++) {
        soak_unit_run(soak, TICKS_PER_MS);
    }
    soak_require(master, soak->machine.line.to_send_count == 0, "an answer has an end");
    soak_require(master, soak->sent_lost == 0, "an answer is not longer than it may be");
}

/* Says the last request and takes its answer. */
static void exchange(struct soak_master *master)
{
    soak_hear(master, master->frame, master->frame_length, 0);
    master->content_length = frame_read(master->content, master->soak->sent, master->soak->sent_count);
    bool answered = master->content_length >= 3 && master->content[0] == (SOAK_NODE | 0x80U) &&
                    master->content[1] == master->number;
    master->tally.requests++;
    master->tally.answers += answered ? 1U : 0U;
    judge_exchange(&master->soak->judge, 1, answered ? 1 : 0);
    soak_require(master, answered, "every request has one answer, with its number");
    master->known = answered;
}

void soak_request(struct soak_master *master, const uint8_t *message, uint32_t length)
{
    master->number = (uint8_t)(master->number == UINT8_MAX ? 1 : master->number + 1U);
    master->frame_length = frame_write(master->frame, SOAK_NODE, master->number, message, length);
    exchange(master);
    soak_require(master, master->content[2] == message[0], "an answer has the number of its message");
}

void soak_repeat(struct soak_master *master)
{
    uint32_t length = master->content_length;
    memcpy(master->before, master->content, length);
    exchange(master);
    master->tally.repeats++;
    soak_require(master, length == master->content_length && memcmp(master->before, master->content, length) == 0,
                 "a repeat has the answer of the first time");
}

void soak_broadcast(struct soak_master *master, const uint8_t *message, uint32_t length)
{
    uint8_t frame[SOAK_FRAME_MAX];
    soak_hear(master, frame, frame_write(frame, 0, 0, message, length), 0);
    master->tally.broadcasts++;
    master->known = master->known && master->content_length <= KEPT_MAX;
    judge_exchange(&master->soak->judge, 0, master->soak->sent_count != 0 ? 1 : 0);
    soak_require(master, master->soak->sent_count == 0, "a broadcast has no answer");
}

void soak_send(struct soak_master *master, unsigned motor, const char *text, unsigned flag_mask)
{
    uint8_t message[SOAK_TEXT_MAX + 2] = {MESSAGES_SET_COMMAND, (uint8_t)('0' + motor)};
    size_t length = strlen(text);
    soak_require(master, length <= SOAK_TEXT_MAX, "the test's texts fit");
    memcpy(message + 2, text, length);
    soak_request(master, message, (uint32_t)length + 2U);
    uint8_t flag = master->content[4];
    master->tally.full += flag == 3 ? 1U : 0U;
    soak_require(master, master->content_length == 6 && flag < 4 && (flag_mask >> flag & 1U) != 0,
                 "Set Command has the flag that its text calls for");
}

void soak_ask_status(struct soak_master *master)
{
    const uint8_t message[1] = {MESSAGES_GET_STATUS};
    soak_request(master, message, sizeof message);
    soak_require(master, master->content_length == 2 + STATUS_BYTES, "the status has its length");
}

uint32_t soak_status_number(const struct soak_master *master, unsigned byte)
{
    const uint8_t *from = master->content + 2 + byte;
    return from[0] | (uint32_t)from[1] << 8U | (uint32_t)from[2] << 16U | (uint32_t)from[3] << 24U;
}
