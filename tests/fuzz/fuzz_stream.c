#include "fuzz_stream.h"

#include <stdio.h>
#include <stdlib.h>

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

void fuzz_fail(const char *what, const char *file, int line)
{
    (void)fprintf(stderr, "%s:%d: broken promise: %s\n", file, line, what);
    abort();
}
