/*
 * What all fuzzers share: the input as a stream, and a requirement that stops the fuzzer.
 *
 * A stream that is over gives zeros, so every input is a good one.
 */
#ifndef FUZZ_STREAM_H
#define FUZZ_STREAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What libFuzzer calls: one run, which a -1 keeps out of the corpus, and the change of an input in place. The last is
 * what it offers for that. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed);
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max_size);

struct fuzz_stream {
    const uint8_t *bytes;
    size_t length;
    size_t next;
};

struct fuzz_stream fuzz_stream_of(const uint8_t *bytes, size_t length);

bool fuzz_stream_is_over(const struct fuzz_stream *stream);
uint8_t fuzz_take_byte(struct fuzz_stream *stream);

/* Two bytes, the low one first. */
uint16_t fuzz_take_pair(struct fuzz_stream *stream);

/* At most `length` bytes: where they stand; *taken is how many there are. */
const uint8_t *fuzz_take_bytes(struct fuzz_stream *stream, size_t length, size_t *taken);

/* A promise is broken: says so and where, and stops as a crash does. */
_Noreturn void fuzz_fail(const char *what, const char *file, int line);

#define FUZZ_REQUIRE(condition) ((condition) ? (void)0 : fuzz_fail(#condition, __FILE__, __LINE__))

#endif
