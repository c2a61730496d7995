/*
 * Vectors of paths, and numbers of any order of size, from the stream of a fuzzer.
 */
#ifndef FUZZ_VECTORS_H
#define FUZZ_VECTORS_H

#include <stdint.h>

#include "fuzz_stream.h"
#include "path_vector.h"

/* 1 to 2^bits: any order of size is as likely as any other. */
uint64_t fuzz_take_size(struct fuzz_stream *stream, unsigned bits);

/* 1 to `most`, likewise; and often `most`. */
uint32_t fuzz_take_limited(struct fuzz_stream *stream, uint32_t most);

/* A vector that may be given to a path: axes rest, have the same, one less, or anything; half of them are short. */
struct path_vector fuzz_take_vector(struct fuzz_stream *stream);

#endif
