#include "fuzz_pos_line.h"

#include <string.h>

#include "base_tick.h"
#include "fuzz_stream.h"
#include "rig_crc.h"

enum {
    ANSWER_TICKS = (256 + 8) * FUZZ_POS_BYTE_TICKS,
    GOOD_WAIT_TICKS = 750 * TICKS_PER_US,
};

void fuzz_pos_line_begin(struct fuzz_pos_line *line, struct fuzz_pos *fuzz)
{
    *line = (struct fuzz_pos_line){.fuzz = fuzz, .deaf = true, .last_tick = fuzz->machine.now};
}

static bool is_good(const uint8_t *bytes, uint32_t length)
{
    if (length < 4 || length > 256) {
        return false;
    }
    uint32_t crc = rig_crc(bytes, length - 2U);
    return bytes[length - 2U] == (crc & 0xFFU) && bytes[length - 1U] == (crc >> 8U);
}

uint64_t fuzz_pos_line_silence_ticks(const struct fuzz_pos_line *line)
{
    const struct modbus_receiver *receiver = &line->fuzz->unit.server.receiver;
    return (uint64_t)receiver->silence_ticks + receiver->character_ticks;
}

/* One whole answer to a request to this unit alone, or none. */
static void require_answer(struct fuzz_pos_line *line, bool wanted, uint8_t function)
{
    const uint8_t *sent = line->fuzz->sent;
    uint32_t length = line->fuzz->sent_count;
    if (wanted && !fuzz_pos_is_over(line->fuzz)) {
        FUZZ_REQUIRE(is_good(sent, length) && sent[0] == FUZZ_POS_NODE && (sent[1] | 0x80U) == (function | 0x80U));
        FUZZ_REQUIRE((sent[1] & 0x80U) == 0 || (length == 5 && sent[2] >= 1 && sent[2] <= 6));
    } else {
        FUZZ_REQUIRE(wanted || length == 0);
    }
    line->fuzz->sent_count = 0;
}

static uint32_t count_of(const struct fuzz_pos_line *line, enum modbus_count count)
{
    return line->fuzz->unit.server.counts[count];
}

/* The silence after what has come is over. */
static void close_frame(struct fuzz_pos_line *line)
{
    bool good = line->length != 0 && !line->bad && is_good(line->bytes, line->length);
    bool over = fuzz_pos_is_over(line->fuzz);
    line->taken += good ? 1U : 0U;
    line->dropped += line->length != 0 && !good ? 1U : 0U;
    if (!line->vague && !over) {
        FUZZ_REQUIRE(line->taken == count_of(line, MODBUS_COUNT_FRAMES) + count_of(line, MODBUS_COUNT_FOREIGN));
        FUZZ_REQUIRE(line->dropped == count_of(line, MODBUS_COUNT_CRC) + count_of(line, MODBUS_COUNT_LENGTH) +
                                          count_of(line, MODBUS_COUNT_BROKEN));
        require_answer(line, good && line->bytes[0] == FUZZ_POS_NODE, line->bytes[1]);
    }
    line->fuzz->sent_count = 0;
    line->length = 0;
    line->bad = false;
    line->deaf = false;
}

void fuzz_pos_line_wait(struct fuzz_pos_line *line, uint64_t ticks)
{
    uint64_t end = line->last_tick + fuzz_pos_line_silence_ticks(line);
    bool open = line->length != 0 || line->deaf;
    uint64_t now = line->fuzz->machine.now;
    if (open && now + ticks >= end) {
        ticks = now + ticks < end + ANSWER_TICKS ? end + ANSWER_TICKS - now : ticks;
        fuzz_pos_run(line->fuzz, ticks);
        close_frame(line);
    } else {
        bool vague = open && now + ticks + GOOD_WAIT_TICKS >= end;
        fuzz_pos_run(line->fuzz, ticks);
        if (vague) {
            line->vague = true;
        }
    }
}

static void read_bytes(struct fuzz_pos_line *line, const uint8_t *bytes, uint32_t length, uint32_t broken)
{
    for (uint32_t i = 0; i < length; i++) {
        if (!line->deaf && line->length < FUZZ_POS_LINE_ROOM) {
            line->bytes[line->length++] = bytes[i];
            line->bad = line->bad || i == broken;
        }
    }
    line->last_tick = line->fuzz->machine.now + (uint64_t)length * FUZZ_POS_BYTE_TICKS;
    if (!line->bad && is_good(line->bytes, line->length) && line->bytes[0] == FUZZ_POS_NODE) {
        line->fuzz->heard_tick = line->last_tick;
    }
}

void fuzz_pos_line_put(struct fuzz_pos_line *line, const uint8_t *bytes, uint32_t length, uint32_t broken)
{
    for (uint32_t i = 0; i < length; i++) {
        line->script[i] = (struct host_line_byte){
            .tick = line->fuzz->machine.now + (i + 1U) * (uint64_t)FUZZ_POS_BYTE_TICKS,
            .value = bytes[i],
            .broken = i == broken,
        };
    }
    read_bytes(line, bytes, length, broken);
    host_machine_set_line(&line->fuzz->machine, line->script, length);
    fuzz_pos_run(line->fuzz, (length + 1U) * (uint64_t)FUZZ_POS_BYTE_TICKS);
}

void fuzz_pos_line_ask(struct fuzz_pos_line *line, const uint8_t *bytes, uint32_t length)
{
    uint8_t frame[FUZZ_POS_FRAME_ROOM];
    uint32_t executed = line->fuzz->executed;
    memcpy(frame, bytes, length);
    uint32_t crc = rig_crc(frame, length);
    frame[length] = (uint8_t)(crc & 0xFFU);
    frame[length + 1U] = (uint8_t)(crc >> 8U);
    fuzz_pos_line_put(line, frame, length + 2U, UINT32_MAX);
    fuzz_pos_line_wait(line, fuzz_pos_line_silence_ticks(line));
    memmove(line->request, bytes, length);
    line->request_length = line->fuzz->executed == executed + 1U ? length : 0;
}
