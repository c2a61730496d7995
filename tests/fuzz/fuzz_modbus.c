/*
 * Bytes to requests and answers of the positioning unit's line: exactly the frames that an independent reader finds
 * whole, good and for this unit are executed or refused; each is answered at most once, with a frame that the reader
 * finds good and that has the function of the request; the counts are the reader's; what is refused changes no
 * register, and no register is ever out of its range.
 *
 * Input: bytes of the line. FC: a silence of T. FD: a pause of three characters. FE: the next byte is bad. The mutator
 * puts requests into it and makes CRCs, as chance alone makes none.
 */
#include <stdlib.h>
#include <string.h>

#include "fuzz_stream.h"
#include "modbus_corpus.h"
#include "pos_bench.h"
#include "rig_crc.h"

enum {
    INPUT_MAX = 4096,
    SILENCE = 0xFC,
    PAUSE = 0xFD,
    BAD = 0xFE,
    FRAME_ROOM = 260,
    NODE = 1,
};

#define CHARACTER_TICKS ((uint64_t)48125)
#define SILENCE_TICKS ((uint64_t)168437)

/* The frame that is coming, as an independent reader keeps it. */
struct reader {
    uint8_t bytes[INPUT_MAX];
    uint32_t length;
    bool bad;
    bool paused;
    uint32_t counts[MODBUS_COUNTS_TOTAL];
};

struct run {
    struct pos_bench bench;
    struct reader reader;
    uint64_t tick;
};

static bool has_crc(const uint8_t *bytes, uint32_t length)
{
    uint32_t crc = rig_crc(bytes, length - 2U);
    return bytes[length - 2U] == (crc & 0xFFU) && bytes[length - 1U] == (crc >> 8U);
}

/* Counts the frame that is over. True: it is for this unit alone. */
static bool judge(struct reader *reader)
{
    enum modbus_count count = MODBUS_COUNT_FRAMES;
    if (reader->bad) {
        count = MODBUS_COUNT_BROKEN;
    } else if (reader->length < 4 || reader->length > 256) {
        count = MODBUS_COUNT_LENGTH;
    } else if (!has_crc(reader->bytes, reader->length)) {
        count = MODBUS_COUNT_CRC;
    } else {
        count = reader->bytes[0] > NODE ? MODBUS_COUNT_FOREIGN : MODBUS_COUNT_FRAMES;
        reader->counts[MODBUS_COUNT_PAUSES] += reader->paused ? 1U : 0U;
    }
    reader->counts[count]++;
    return count == MODBUS_COUNT_FRAMES && reader->bytes[0] == NODE;
}

static void require_counts(const struct run *run)
{
    for (unsigned i = 0; i <= (unsigned)MODBUS_COUNT_PAUSES; i++) {
        FUZZ_REQUIRE(run->bench.server.counts[i] == run->reader.counts[i]);
    }
}

/* What stands in the registers could be written there. */
static void require_registers(struct pos_bench *bench)
{
    static struct pos_write write;
    uint16_t values[32];
    for (uint32_t axis = 1; axis <= (uint32_t)POS_AXES; axis++) {
        pos_registers_read(&bench->registers, (axis * 100U) + 30U, 26, values);
        FUZZ_REQUIRE(pos_write_init(&write, &bench->registers, (axis * 100U) + 30U, 26, values));
    }
    pos_registers_read(&bench->registers, 600, 32, values);
    FUZZ_REQUIRE(pos_write_init(&write, &bench->registers, 600, 32, values));
    pos_registers_read(&bench->registers, 30, 3, values);
    FUZZ_REQUIRE(pos_write_init(&write, &bench->registers, 30, 3, values));
}

static void require_answer(struct run *run, const struct pos_registers *before)
{
    uint8_t answer[FRAME_ROOM];
    uint32_t length = 0;
    struct modbus *server = &run->bench.server;
    FUZZ_REQUIRE(modbus_is_sending(server));
    for (; modbus_is_sending(server); modbus_advance(server)) {
        FUZZ_REQUIRE(length < 256);
        answer[length++] = modbus_byte(server);
    }
    FUZZ_REQUIRE(length >= 5 && has_crc(answer, length) && answer[0] == NODE);
    FUZZ_REQUIRE((answer[1] | 0x80U) == (run->reader.bytes[1] | 0x80U));
    if ((answer[1] & 0x80U) != 0U) {
        FUZZ_REQUIRE(length == 5 && answer[2] >= 1 && answer[2] <= 6);
        FUZZ_REQUIRE(memcmp(before, &run->bench.registers, sizeof *before) == 0);
    }
}

static void run_wait(struct run *run)
{
    struct reader *reader = &run->reader;
    struct pos_registers before = run->bench.registers;
    run->tick += SILENCE_TICKS + CHARACTER_TICKS;
    pos_bench_poll(&run->bench, run->tick);
    if (reader->length != 0U && judge(reader)) {
        require_answer(run, &before);
    }
    FUZZ_REQUIRE(!modbus_is_sending(&run->bench.server));
    reader->length = 0;
    reader->bad = false;
    reader->paused = false;
    require_counts(run);
}

static void run_take(struct run *run, uint8_t value, bool bad, bool paused)
{
    struct reader *reader = &run->reader;
    uint32_t executed = run->bench.executed;
    run->tick += CHARACTER_TICKS * (paused ? 4U : 1U);
    reader->paused = reader->paused || (paused && reader->length != 0U);
    reader->bad = reader->bad || bad;
    reader->bytes[reader->length++] = value;
    pos_bench_take(&run->bench, &(struct hal_line_byte){.tick = run->tick, .value = value, .broken = bad});
    FUZZ_REQUIRE(run->bench.executed == executed && !modbus_is_sending(&run->bench.server));
}

static void run_step(struct run *run, struct fuzz_stream *stream)
{
    uint8_t value = fuzz_take_byte(stream);
    if (value == SILENCE) {
        run_wait(run);
    } else if (value == PAUSE || value == BAD) {
        run_take(run, fuzz_take_byte(stream), value == BAD, value == PAUSE);
    } else {
        run_take(run, value, false, false);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct run run;
    struct fuzz_stream stream = fuzz_stream_of(data, size);
    if (size >= INPUT_MAX) {
        return -1;
    }
    memset(&run, 0, sizeof run);
    pos_bench_init(&run.bench, NODE, 0);
    run.bench.busy_axes = size % 2U * 8U;
    run_wait(&run);
    while (!fuzz_stream_is_over(&stream)) {
        run_step(&run, &stream);
    }
    run_wait(&run);
    require_registers(&run.bench);
    return 0;
}

/* A request of the corpus with some bytes changed, its CRC, and a silence. */
static size_t make_request(uint8_t room[FRAME_ROOM], unsigned seed)
{
    size_t length = 0;
    const char *text = modbus_corpus[seed % MODBUS_CORPUS];
    for (; *text != '\0' && length < 100; text += text[2] == ' ' ? 3 : 2) {
        char pair[3] = {text[0], text[1], '\0'};
        room[length++] = (uint8_t)strtoul(pair, NULL, 16);
    }
    for (unsigned changes = seed / 64U % 4U; changes > 0; changes--) {
        seed = seed * 1664525U + 1013904223U;
        room[1U + seed / 65536U % (length - 1U)] = (uint8_t)(seed >> 8U);
    }
    uint32_t crc = rig_crc(room, (uint32_t)length);
    room[length++] = (uint8_t)(crc & 0xFFU);
    room[length++] = (uint8_t)(crc >> 8U);
    room[length++] = SILENCE;
    return length;
}

/* One time in two, puts a request somewhere. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    uint8_t request[FRAME_ROOM];
    size = LLVMFuzzerMutate(data, size, max_size);
    size_t length = make_request(request, seed / 2U);
    return seed % 2U == 0 ? size : fuzz_insert(data, size, max_size, 0, seed / 256U, request, length);
}
