/*
 * Bytes to frames: only what an independent check finds to be a whole and good frame for this unit is delivered, and
 * all of that is.
 *
 * Input: the node (low 4 bits) | which byte is broken, 0: none | which byte comes after a gap, 0: none | the bytes of
 * the line. Built with tiny limits, so that frames are too long often. The mutator mends the FCS of frames, as chance
 * alone makes no good one.
 */
#include <string.h>

#include "frames.h"
#include "fuzz_stream.h"
#include "link_receiver.h"

enum {
    HEAD_BYTES = 3,
    FRAME_MAX = 4096, /* of an input */
};

/* What stands on the line since the last flag, as the independent check sees it. */
struct checker {
    uint8_t frame[FRAME_MAX];
    uint8_t content[FRAME_MAX];
    uint32_t length;
    bool open;  /* a flag has come */
    bool dirty; /* a broken byte or a gap */
};

struct bench {
    struct link_receiver receiver;
    uint8_t message[LINK_BUFFER_BYTES];
    struct checker checker;
    uint64_t tick;
    uint32_t frames;
};

/* Every escape is one of a flag or of an escape. */
static bool is_escaped_well(const uint8_t *frame, uint32_t length)
{
    for (uint32_t i = 0; i < length; i++) {
        if (frame[i] == LINK_ESCAPE) {
            i++;
            if (i == length || (frame[i] != (LINK_FLAG ^ LINK_ESCAPED) && frame[i] != (LINK_ESCAPE ^ LINK_ESCAPED))) {
                return false;
            }
        }
    }
    return true;
}

/* The length of the message that a flag has completed; 0: none for this node. */
static uint32_t checker_close(struct checker *checker, uint8_t node)
{
    uint32_t length = 0;
    checker->frame[checker->length++] = LINK_FLAG;
    if (checker->open && !checker->dirty && is_escaped_well(checker->frame + 1, checker->length - 2)) {
        length = frame_read(checker->content, checker->frame, checker->length);
    }
    bool ours = length != 0 && (checker->content[0] == node || checker->content[0] == 0);
    bool fits = length >= 3 && length - LINK_HEAD_BYTES <= LINK_REQUEST_BYTES_MAX;
    checker->frame[0] = LINK_FLAG;
    checker->length = 1;
    checker->open = true;
    checker->dirty = false;
    return ours && fits ? length - LINK_HEAD_BYTES : 0;
}

static uint32_t checker_take(struct checker *checker, uint8_t node, const struct hal_line_byte *byte, bool gap)
{
    checker->dirty = checker->dirty || gap || byte->broken;
    if (byte->broken) {
        return 0;
    }
    if (byte->value == LINK_FLAG) {
        return checker_close(checker, node);
    }
    FUZZ_REQUIRE(checker->length < FRAME_MAX - 1);
    checker->frame[checker->length++] = byte->value;
    return 0;
}

static void bench_take(struct bench *bench, uint8_t value, bool broken, bool gap)
{
    bench->tick += gap ? LINK_GAP_TICKS + 1U : TICKS_PER_MS / 2U;
    struct hal_line_byte byte = {.tick = bench->tick, .value = value, .broken = broken};
    uint32_t expected = checker_take(&bench->checker, bench->receiver.node, &byte, gap);
    bool delivered = link_receiver_take(&bench->receiver, &byte);
    FUZZ_REQUIRE(delivered == (expected != 0));
    if (delivered) {
        const uint8_t *content = bench->checker.content;
        bench->frames++;
        FUZZ_REQUIRE(bench->receiver.length == expected);
        FUZZ_REQUIRE(bench->receiver.address == content[0] && bench->receiver.number == content[1]);
        FUZZ_REQUIRE(memcmp(bench->message, content + LINK_HEAD_BYTES, expected) == 0);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct bench bench;
    struct fuzz_stream stream = fuzz_stream_of(data, size);
    if (size >= FRAME_MAX) {
        return -1;
    }
    uint8_t node = (uint8_t)(1U + fuzz_take_byte(&stream) % LINK_NODE_MAX);
    uint8_t broken = fuzz_take_byte(&stream);
    uint8_t gap = fuzz_take_byte(&stream);
    link_receiver_init(&bench.receiver, node, bench.message);
    bench.checker.length = 1;
    bench.checker.open = false;
    bench.checker.dirty = false;
    bench.checker.frame[0] = LINK_FLAG;
    bench.frames = 0;
    bench.tick = 0;
    for (size_t i = 1; !fuzz_stream_is_over(&stream); i++) {
        bench_take(&bench, fuzz_take_byte(&stream), i == broken, i == gap);
    }
    FUZZ_REQUIRE(bench.receiver.counts[LINK_COUNT_FRAMES] == bench.frames);
    return 0;
}

/* Makes one segment between two flags (or the end) a frame with a good FCS, as far as there is room. */
static size_t mend(uint8_t *data, size_t size, size_t max_size, size_t begin, size_t end)
{
    static uint8_t plain[FRAME_MAX];
    static uint8_t frame[FRAME_BYTES_MAX(FRAME_MAX)];
    uint32_t length = 0;
    for (size_t i = begin; i < end && length < FRAME_MAX; i++) {
        bool escape = data[i] == LINK_ESCAPE && i + 1 < end;
        plain[length++] = escape ? data[++i] ^ LINK_ESCAPED : data[i];
    }
    if (length < LINK_HEAD_BYTES + 1U) {
        return size;
    }
    uint32_t message = length > LINK_HEAD_BYTES + 1U + LINK_FCS_BYTES ? length - LINK_HEAD_BYTES - LINK_FCS_BYTES
                                                                      : length - LINK_HEAD_BYTES;
    uint8_t address = plain[0] % 4U == 0 ? 0 : (uint8_t)(1U + data[0] % LINK_NODE_MAX);
    uint32_t made =
        frame_write(frame, plain[0] % 16U == 1 ? plain[0] : address, plain[1], plain + LINK_HEAD_BYTES, message);
    if (size - (end - begin) + made > max_size) {
        return size;
    }
    memmove(data + begin + made, data + end, size - end);
    memcpy(data + begin, frame, made);
    return size - (end - begin) + made;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    size = LLVMFuzzerMutate(data, size, max_size);
    if (seed % 2U == 0 || size <= HEAD_BYTES) {
        return size;
    }
    size_t begin = HEAD_BYTES + seed / 2U % (size - HEAD_BYTES);
    while (begin < size && data[begin] == LINK_FLAG) {
        begin++;
    }
    size_t end = begin;
    while (end < size && data[end] != LINK_FLAG) {
        end++;
    }
    return mend(data, size, max_size, begin, end);
}
