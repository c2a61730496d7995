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

/* The bytes up to a 0, which is passed, or to the end: where they stand; *length is how many there are. */
const uint8_t *fuzz_take_text(struct fuzz_stream *stream, size_t *length);

/* Puts a piece into an input, at one of the places after so many bytes of head that `place` chooses. Returns the size
 * of the input, which stays as it is where there is no head or no room. */
size_t fuzz_insert(uint8_t *data, size_t size, size_t max_size, size_t head, unsigned place, const void *piece,
                   size_t length);

/* The input is a head and what one run takes: it is run at the epoch of the head, and where bit 7 of that is set once
 * more at the next one, with the same digest. Returns what LLVMFuzzerTestOneInput does. */
int fuzz_run_at_epochs(const uint8_t *data, size_t size,
                       uint64_t (*run_once)(struct fuzz_stream stream, unsigned epoch));

/* A promise is broken: says so and where, and stops as a crash does. */
_Noreturn void fuzz_fail(const char *what, const char *file, int line);

#define FUZZ_REQUIRE(condition) ((condition) ? (void)0 : fuzz_fail(#condition, __FILE__, __LINE__))

#endif
