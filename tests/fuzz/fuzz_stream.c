#include "fuzz_stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct fuzz_stream fuzz_stream_of(const uint8_t *bytes, size_t length)
{
    return (struct fuzz_stream){.bytes = bytes, .length = length};
}

bool fuzz_stream_is_over(const struct fuzz_stream *stream)
{
    return stream->next >= stream->length;
}

uint8_t fuzz_take_byte(struct fuzz_stream *stream)
{
    return fuzz_stream_is_over(stream) ? 0 : stream->bytes[stream->next++];
}

uint16_t fuzz_take_pair(struct fuzz_stream *stream)
{
    uint8_t low = fuzz_take_byte(stream);
    return (uint16_t)(low | fuzz_take_byte(stream) << 8);
}

const uint8_t *fuzz_take_bytes(struct fuzz_stream *stream, size_t length, size_t *taken)
{
    const uint8_t *bytes = stream->bytes + stream->next;
    size_t left = stream->length - stream->next;
    *taken = length < left ? length : left;
    stream->next += *taken;
    return bytes;
}

const uint8_t *fuzz_take_text(struct fuzz_stream *stream, size_t *length)
{
    const uint8_t *text = stream->bytes + stream->next;
    size_t left = stream->length - stream->next;
    const uint8_t *end = memchr(text, 0, left);
    *length = end != NULL ? (size_t)(end - text) : left;
    stream->next += end != NULL ? *length + 1U : *length;
    return text;
}

size_t fuzz_insert(uint8_t *data, size_t size, size_t max_size, size_t head, unsigned place, const void *piece,
                   size_t length)
{
    if (size < head || size + length > max_size) {
        return size;
    }
    size_t at = head + place % (size - head + 1U);
    memmove(&data[at + length], &data[at], size - at);
    memcpy(&data[at], piece, length);
    return size + length;
}

int fuzz_run_at_epochs(const uint8_t *data, size_t size,
                       uint64_t (*run_once)(struct fuzz_stream stream, unsigned epoch))
{
    struct fuzz_stream stream = fuzz_stream_of(data, size);
    uint8_t head = fuzz_take_byte(&stream);
    uint64_t digest = run_once(stream, head);
    if ((head & 0x80U) != 0) {
        FUZZ_REQUIRE(run_once(stream, head + 1U) == digest);
    }
    return 0;
}

void fuzz_fail(const char *what, const char *file, int line)
{
    (void)fprintf(stderr, "%s:%d: broken promise: %s\n", file, line, what);
    abort();
}
