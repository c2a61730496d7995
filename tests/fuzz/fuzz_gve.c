/*
 * Bytes to requests and answers of the GVE134's line: exactly what an independent reader finds whole, for this unit and
 * with a right checksum is a command, and exactly what it finds damaged is told; each command is one of the table, and
 * its own text is read as the same; an answer has the right checksum; the index counts.
 *
 * Input: bytes of the line. FB: as many as the next byte says come together. FC: 1 s of silence, FD: 100 ms, FE: the
 * next byte has a framing error. The mutator puts commands of the table into it, as chance alone makes no checksum.
 */
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base_tick.h"
#include "fuzz_stream.h"
#include "gve_float.h"
#include "gve_line.h"

enum {
    INPUT_MAX = 4096,
    TOGETHER = 0xFB,
    GAP = 0xFC,
    SILENCE = 0xFD,
    BROKEN = 0xFE,
    EXPECTED_MAX = 4,
    TEXT_ROOM = 120,
    BYTE_TICKS = 729,
};

/* What the independent reader holds: the line as text from the address on, and what it expects. */
struct reader {
    char line[INPUT_MAX];
    uint32_t length;
    bool open;     /* after ! */
    bool skipping; /* the rest of a damaged line of a packet */
    bool throwing;
    bool owed;
    bool packet;
    bool told; /* damage of this packet */
    bool sums;
    uint32_t silence_ms;
    uint8_t expected[EXPECTED_MAX]; /* enum gve_request_kind */
    uint32_t count;
    uint8_t index;
};

struct bench {
    struct gve_line line;
    struct reader reader;
    uint64_t tick;
};

static void expect(struct reader *reader, enum gve_request_kind kind)
{
    FUZZ_REQUIRE(reader->count < EXPECTED_MAX);
    reader->expected[reader->count++] = (uint8_t)kind;
}

static bool is_ours(const struct reader *reader)
{
    return reader->length != 0 && (reader->line[0] == '0' || reader->line[0] == '7');
}

static void hurt(struct reader *reader, bool ours)
{
    if (!reader->packet) {
        reader->throwing = true;
        reader->owed = ours;
    } else if (!reader->told) {
        expect(reader, GVE_REQUEST_BAD_LINE);
        reader->told = true;
    }
    reader->open = false;
    reader->skipping = true;
}

static void reader_wait(struct reader *reader, uint32_t ms)
{
    reader->silence_ms += ms;
    bool second = reader->silence_ms >= 1000;
    bool damage = reader->throwing ? reader->owed : second && (reader->packet || (reader->open && is_ours(reader)));
    if (reader->throwing || second) {
        reader->throwing = reader->open = reader->packet = reader->skipping = false;
        if (damage) {
            expect(reader, GVE_REQUEST_DAMAGE);
        }
    }
}

static bool has_sum(struct reader *reader)
{
    unsigned sum = '!';
    char tail[8];
    if (reader->length > 80 || reader->length < 3) {
        return false;
    }
    for (uint32_t i = 0; i < reader->length - 2; i++) {
        sum += (uint8_t)reader->line[i];
    }
    (void)snprintf(tail, sizeof tail, ",%02X", sum % 256U);
    reader->length -= 3;
    return strncasecmp(&reader->line[reader->length], tail, 3) == 0;
}

/* What a command changes for the bytes after it. */
static void follow(struct reader *reader)
{
    const char *text = &reader->line[1];
    bool interpolator = reader->line[0] == '0';
    if (interpolator && strcasecmp(text, "*S") == 0) {
        reader->packet = true;
        reader->told = false;
    } else if ((interpolator && (strcasecmp(text, "H") == 0 || strncasecmp(text, "*E", 2) == 0)) ||
               strcasecmp(text, "J") == 0) {
        reader->packet = false;
    } else if (!reader->packet && (strcmp(text, "%+") == 0 || strcmp(text, "%-") == 0)) {
        reader->sums = text[1] == '+';
    } else {
        /* changes nothing */
    }
}

static void reader_end_line(struct reader *reader)
{
    bool ours = is_ours(reader);
    if (reader->sums && !has_sum(reader)) {
        hurt(reader, ours);
        reader->skipping = false;
        return;
    }
    reader->open = false;
    if (ours) {
        reader->line[reader->length] = '\0';
        expect(reader, GVE_REQUEST_COMMAND);
        reader->index += reader->line[1] == '@' || reader->line[1] == '>' ? 0 : 1;
        if (memchr(reader->line, 0, reader->length) == NULL) {
            follow(reader);
        } else if (reader->line[0] == '0' && strncasecmp(&reader->line[1], "*E", 2) == 0) {
            reader->packet = false;
        }
    }
}

static void reader_take(struct reader *reader, uint8_t value, bool broken)
{
    bool watched = reader->open && (reader->sums || reader->length == 0 || is_ours(reader));
    bool stray = !reader->open && !reader->skipping && reader->sums;
    reader->silence_ms = 0;
    if (reader->throwing || (!broken && value == '\n')) {
        return;
    }
    if (broken) {
        if (watched || stray) {
            hurt(reader, watched && is_ours(reader));
        }
    } else if (value == '!') {
        if (watched) {
            hurt(reader, is_ours(reader));
        }
        reader->open = !reader->throwing;
        reader->skipping = false;
        reader->length = 0;
    } else if (value == '\r') {
        if (reader->open) {
            reader_end_line(reader);
        }
        reader->skipping = false;
    } else if (reader->open) {
        reader->line[reader->length++] = (char)value;
    } else if (stray) {
        hurt(reader, false);
    } else {
        /* between the lines */
    }
}

/* The text of one parameter. */
static void put_number(char *room, uint8_t parameter, int32_t number)
{
    uint8_t bytes[GVE_FLOAT_PUT_BYTES_MAX];
    struct text text;
    switch ((enum gve_form)gve_kind(parameter)->form) {
    case GVE_FORM_AXIS:
        (void)snprintf(room, TEXT_ROOM, "%c", "XYZA"[number]);
        break;
    case GVE_FORM_HEX:
    case GVE_FORM_HEX_WORD:
        (void)snprintf(room, TEXT_ROOM, "%X", (unsigned)number);
        break;
    case GVE_FORM_SINGLE:
        text_init(&text, bytes, sizeof bytes);
        gve_float_put(&text, (uint32_t)number);
        (void)snprintf(room, TEXT_ROOM, "%.*s", (int)text.length, (const char *)bytes);
        break;
    case GVE_FORM_DECIMAL:
    case GVE_FORM_NONZERO:
        (void)snprintf(room, TEXT_ROOM, "%d", (int)number);
        break;
    }
}

/* A command written anew is the same command. */
static void require_round_trip(const struct gve_command *command)
{
    char text[TEXT_ROOM * (GVE_NUMBERS_MAX + 1)];
    const struct gve_row *row = gve_row(command->opcode);
    FUZZ_REQUIRE(command->count >= row->least && command->count <= row->most);
    (void)snprintf(text, sizeof text, "%s", row->text);
    for (unsigned i = 0; i < command->count; i++) {
        char number[TEXT_ROOM];
        put_number(number, row->parameters[i], command->numbers[i]);
        (void)strcat(strcat(text, i == 0 ? "" : ","), number);
    }
    enum gve_address address = row->address == GVE_ADDRESS_SPINDLE ? GVE_ADDRESS_SPINDLE : GVE_ADDRESS_INTERPOLATOR;
    struct gve_reading again = gve_command_read((const uint8_t *)text, (uint32_t)strlen(text), address);
    FUZZ_REQUIRE(again.fault == GVE_FAULT_NONE);
    FUZZ_REQUIRE(again.command.opcode == command->opcode && again.command.count == command->count);
    FUZZ_REQUIRE(memcmp(again.command.numbers, command->numbers, sizeof command->numbers) == 0);
}

static void require_answer(struct bench *bench, const struct gve_request *request)
{
    char out[GVE_ANSWER_BYTES_MAX + 1];
    char expected[TEXT_ROOM];
    unsigned length = 0;
    bool command = request->kind == (uint8_t)GVE_REQUEST_COMMAND;
    enum gve_code code = command ? gve_fault_code((enum gve_fault)request->fault) : GVE_DAMAGED;
    gve_line_answer(&bench->line, code, true, (const uint8_t *)"17", 2);
    while (gve_line_is_sending(&bench->line)) {
        out[length++] = (char)gve_line_byte(&bench->line);
        gve_line_advance(&bench->line);
    }
    out[length] = '\0';
    unsigned sum = 8U + code + (8U + code > 9U ? 'A' - 10U : '0') + ',' + '1' + '7' + ',';
    (void)snprintf(expected, sizeof expected, bench->reader.sums ? "%X,17,%02X\r" : "%X,17\r", 8U + code, sum % 256U);
    FUZZ_REQUIRE(strcmp(out, expected) == 0);
}

/* What has come is what the reader expects; all is taken at once. */
static void drain(struct bench *bench)
{
    struct reader *reader = &bench->reader;
    struct gve_request request;
    for (uint32_t i = 0; i < reader->count; i++) {
        FUZZ_REQUIRE(gve_line_next(&bench->line, &request));
        FUZZ_REQUIRE(request.kind == reader->expected[i]);
        if (request.kind == (uint8_t)GVE_REQUEST_COMMAND && request.fault == (uint8_t)GVE_FAULT_NONE) {
            require_round_trip(&request.command);
        }
        require_answer(bench, &request);
        FUZZ_REQUIRE(bench->line.receiver.packet == reader->packet);
    }
    FUZZ_REQUIRE(!gve_line_next(&bench->line, &request));
    FUZZ_REQUIRE(bench->line.index == reader->index);
    reader->count = 0;
}

static void bench_wait(struct bench *bench, uint32_t ms)
{
    bench->tick += (uint64_t)ms * TICKS_PER_MS;
    (void)gve_line_poll(&bench->line, bench->tick);
    reader_wait(&bench->reader, ms);
    drain(bench);
}

static void bench_take(struct bench *bench, uint8_t value, bool broken)
{
    bench->tick += BYTE_TICKS;
    gve_line_take(&bench->line, &(struct hal_line_byte){.tick = bench->tick, .value = value, .broken = broken});
    reader_take(&bench->reader, value, broken);
    drain(bench);
}

/* They end with a line, as those of the seam do. */
static void bench_take_run(struct bench *bench, struct fuzz_stream *stream)
{
    struct hal_line_run run = {.count = 0};
    uint32_t most = 1U + fuzz_take_byte(stream) % (uint32_t)HAL_LINE_RUN_MAX;
    while (run.count < most && !fuzz_stream_is_over(stream) && (run.count == 0 || run.bytes[run.count - 1U] != '\r')) {
        run.bytes[run.count] = fuzz_take_byte(stream);
        reader_take(&bench->reader, run.bytes[run.count], false);
        run.count++;
    }
    bench->tick += BYTE_TICKS;
    run.tick = bench->tick;
    gve_line_take_run(&bench->line, &run);
    drain(bench);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct bench bench;
    struct fuzz_stream stream = fuzz_stream_of(data, size);
    if (size >= INPUT_MAX) {
        return -1;
    }
    memset(&bench.reader, 0, sizeof bench.reader);
    bench.tick = 0;
    gve_line_init(&bench.line, 0, 7);
    while (!fuzz_stream_is_over(&stream)) {
        uint8_t value = fuzz_take_byte(&stream);
        if (value == GAP || value == SILENCE) {
            bench_wait(&bench, value == GAP ? 1000 : 100);
        } else if (value == TOGETHER) {
            bench_take_run(&bench, &stream);
        } else if (value == BROKEN) {
            bench_take(&bench, fuzz_take_byte(&stream), true);
        } else {
            bench_take(&bench, value, false);
        }
    }
    return 0;
}

/* A line with the example of a command, with its checksum or without. */
static size_t make_line(char room[TEXT_ROOM], unsigned choice)
{
    unsigned opcode = choice % GVE_OPCODES;
    unsigned sum = 0;
    size_t length = (size_t)snprintf(room, TEXT_ROOM, "!%c%s,", gve_row(opcode)->address == 2 ? '7' : '0',
                                     gve_words(opcode)->example);
    for (size_t i = 0; i < length; i++) {
        sum += (uint8_t)room[i];
    }
    if (choice / GVE_OPCODES % 2U == 0) {
        length--;
    } else {
        length += (size_t)snprintf(&room[length], TEXT_ROOM - length, "%02X", sum % 256U);
    }
    room[length] = '\r';
    return length + 1;
}

/* One time in two, puts a line somewhere. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    char line[TEXT_ROOM];
    size = LLVMFuzzerMutate(data, size, max_size);
    size_t length = make_line(line, seed / 2U);
    return seed % 2U == 0 ? size : fuzz_insert(data, size, max_size, 0, seed / 256U, line, length);
}
