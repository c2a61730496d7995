#include "pos_soak.h"

#include <string.h>

#include "base_tick.h"

enum {
    ADDRESS = 1,
    FUNCTION_READ = 4,
    FUNCTION_WRITE = 16,
    FUNCTION_BOTH = 23,
    CRC_BYTES = 2,
    HEAD_BYTES = 3,    /* of an answer with registers */
    WRITTEN_BYTES = 8, /* the answer of function 16 */
    BYTE_BITS = 11,
    AHEAD_TICKS = 512 * TICKS_PER_US,
};

#define SLOW_BD UINT64_C(19200)
#define FAST_BD UINT64_C(115200)

static void on_step(void *context, uint64_t tick, unsigned motor, bool backward)
{
    struct pos_soak *soak = context;
    struct pos_soak_motor *own = &soak->motors[motor];
    uint64_t since = tick - own->last_tick;
    soak->closest_ticks = since < soak->closest_ticks ? since : soak->closest_ticks;
    own->last_tick = tick;
    own->pulses++;
    if (backward ? own->slack > 0 : own->slack < own->backlash) {
        own->slack += backward ? -1 : 1;
    } else {
        own->position += backward ? -1 : 1;
    }
}

static void on_line(void *context, uint64_t tick, uint8_t value)
{
    struct pos_soak *soak = context;
    (void)tick;
    if (soak->heard_count < (uint32_t)POS_SOAK_FRAME_MAX) {
        soak->heard[soak->heard_count++] = value;
    }
}

static uint64_t pass(void *context)
{
    struct pos_soak *soak = context;
    return positioning_poll(&soak->unit);
}

static void start(struct pos_soak *soak, uint64_t baud)
{
    memset(&soak->unit, 0, sizeof soak->unit);
    positioning_init(&soak->unit);
    positioning_start(&soak->unit);
    host_machine_set_byte_ticks(&soak->machine, (uint32_t)(TICK_HZ * BYTE_BITS / baud));
    soak->since_start = 0;
}

void pos_soak_begin(struct pos_soak *soak, uint64_t epoch)
{
    memset(soak, 0, sizeof *soak);
    host_machine_init(&soak->machine, epoch);
    soak->machine.ahead_ticks = AHEAD_TICKS;
    soak->machine.listener = (struct host_listener){.context = soak, .step = on_step, .line = on_line};
    soak->closest_ticks = UINT64_MAX;
    host_machine_select(&soak->machine);
    start(soak, SLOW_BD);
    pos_soak_run(soak, POS_SOAK_CYCLE_MS);
}

void pos_soak_restart(struct pos_soak *soak)
{
    host_machine_restart(&soak->machine);
    start(soak, FAST_BD);
    pos_soak_run(soak, POS_SOAK_CYCLE_MS);
}

void pos_soak_require(struct pos_soak *soak, bool good, const char *promise)
{
    if (!good && soak->trouble == NULL) {
        soak->trouble = promise;
        soak->trouble_tick = soak->machine.now;
    }
}

void pos_soak_run(struct pos_soak *soak, uint32_t ms)
{
    uint64_t until = soak->machine.now + (uint64_t)ms * (uint64_t)TICKS_PER_MS;
    host_machine_run(&soak->machine, until, pass, NULL, soak);
}

/* ---- frames ---------------------------------------------------------------------------------------------------- */

/* Bit by bit, as the contract has it. */
static uint16_t crc_of(const uint8_t *bytes, uint32_t count)
{
    uint32_t rest = 0xFFFF;
    for (uint32_t bit = 0; bit < 8U * count; bit++) {
        rest ^= bit % 8U == 0U ? bytes[bit / 8U] : 0U;
        rest = (rest & 1U) != 0U ? rest >> 1U ^ 0xA001U : rest >> 1U;
    }
    return (uint16_t)rest;
}

static void put(struct pos_soak *soak, unsigned byte)
{
    soak->request[soak->request_length++] = (uint8_t)(byte & 0xFFU);
}

static void put_word(struct pos_soak *soak, unsigned word)
{
    put(soak, word >> 8U);
    put(soak, word);
}

static void put_words(struct pos_soak *soak, uint32_t count, const uint16_t *words)
{
    put(soak, 2U * count);
    for (uint32_t i = 0; i < count; i++) {
        put_word(soak, words[i]);
    }
}

static void begin(struct pos_soak *soak, unsigned function)
{
    soak->request_length = 0;
    put(soak, ADDRESS);
    put(soak, function);
}

/* Sends the request, and hears its answer: all of it, within the time, with so many bytes. */
static void ask(struct pos_soak *soak, uint32_t answer_bytes, uint32_t within_ms)
{
    uint16_t crc = crc_of(soak->request, soak->request_length);
    put(soak, crc);
    put(soak, (unsigned)crc >> 8U);
    for (uint32_t i = 0; i < soak->request_length; i++) {
        uint64_t tick = soak->machine.now + (i + 1U) * (uint64_t)soak->machine.line.byte_ticks;
        soak->script[i] = (struct host_line_byte){.tick = tick, .value = soak->request[i]};
    }
    soak->heard_count = 0;
    host_machine_set_line(&soak->machine, soak->script, soak->request_length);
    pos_soak_run(soak, within_ms);
    soak->requests++;
    soak->since_start++;
    bool whole = soak->heard_count == answer_bytes + (uint32_t)CRC_BYTES && soak->heard[0] == (unsigned)ADDRESS &&
                 soak->heard[1] == soak->request[1];
    pos_soak_require(soak, whole, "every request is answered in its cycle");
    pos_soak_require(soak, crc_of(soak->heard, soak->heard_count) == 0U, "an answer has its CRC");
}

void pos_soak_write(struct pos_soak *soak, uint16_t first, uint32_t count, const uint16_t *words, uint32_t within_ms)
{
    begin(soak, FUNCTION_WRITE);
    put_word(soak, first);
    put_word(soak, count);
    put_words(soak, count, words);
    ask(soak, WRITTEN_BYTES - CRC_BYTES, within_ms);
}

void pos_soak_write_and_read(struct pos_soak *soak, uint16_t first, uint32_t count, const uint16_t *words,
                             uint16_t from, uint32_t wanted)
{
    begin(soak, FUNCTION_BOTH);
    put_word(soak, from);
    put_word(soak, wanted);
    put_word(soak, first);
    put_word(soak, count);
    put_words(soak, count, words);
    ask(soak, HEAD_BYTES + 2U * wanted, POS_SOAK_CYCLE_MS);
}

void pos_soak_read(struct pos_soak *soak, uint16_t from, uint32_t wanted)
{
    begin(soak, FUNCTION_READ);
    put_word(soak, from);
    put_word(soak, wanted);
    ask(soak, HEAD_BYTES + 2U * wanted, POS_SOAK_CYCLE_MS);
}

uint16_t pos_soak_word(const struct pos_soak *soak, uint32_t index)
{
    const uint8_t *from = &soak->heard[(uint32_t)HEAD_BYTES + 2U * index];
    return (uint16_t)((unsigned)from[0] << 8U | from[1]);
}

uint32_t pos_soak_long(const struct pos_soak *soak, uint32_t index)
{
    return (uint32_t)pos_soak_word(soak, index) << 16U | pos_soak_word(soak, index + 1U);
}
