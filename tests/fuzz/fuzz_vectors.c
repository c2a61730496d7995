#include "fuzz_vectors.h"

enum {
    SHORT_MAX = 63
};

uint64_t fuzz_take_size(struct fuzz_stream *stream, unsigned bits)
{
    unsigned exponent = fuzz_take_byte(stream) % (bits + 1U);
    uint64_t size = (UINT64_C(256) + fuzz_take_byte(stream)) << exponent >> 8U;
    return size < UINT64_C(1) << bits ? size : UINT64_C(1) << bits;
}

uint32_t fuzz_take_limited(struct fuzz_stream *stream, uint32_t most)
{
    uint8_t exponent = fuzz_take_byte(stream);
    uint64_t size = (UINT64_C(256) + fuzz_take_byte(stream)) << exponent % 32U >> 8U;
    return exponent < 32U * 6U && size < most ? (uint32_t)size : most;
}

static int32_t take_steps(struct fuzz_stream *stream, uint8_t form, int32_t longest)
{
    int32_t steps = 0;
    switch (form % 4U) {
    case 0:
        break;
    case 1:
        steps = longest;
        break;
    case 2:
        steps = (int32_t)(1U + fuzz_take_pair(stream) % (uint32_t)longest);
        break;
    default:
        steps = longest > 1 ? longest - 1 : 1;
        break;
    }
    return (form & 4U) != 0 ? -steps : steps;
}

static uint64_t square(int64_t value)
{
    return (uint64_t)(value * value);
}

struct path_vector fuzz_take_vector(struct fuzz_stream *stream)
{
    uint8_t form = fuzz_take_byte(stream);
    int32_t longest = (int32_t)fuzz_take_limited(stream, (form & 1U) != 0 ? INT32_MAX : SHORT_MAX);
    struct path_vector vector = {.border_speed = UINT32_MAX};
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        vector.steps[axis] = take_steps(stream, fuzz_take_byte(stream), longest);
    }
    unsigned last = form / 64U;
    vector.steps[last] = (form & 2U) != 0 ? -longest : longest;
    vector.speed = fuzz_take_limited(stream, PATH_SPEED_MAX);
    vector.accel = fuzz_take_limited(stream, PATH_ACCEL_MAX);
    vector.extent2 = square(longest);
    if ((form & 4U) != 0 && last < 3) {
        vector.extent2 = square(vector.steps[0]) + square(vector.steps[1]) + square(vector.steps[2]);
    }
    if ((form & 8U) != 0) {
        vector.border_speed = fuzz_take_limited(stream, PATH_SPEED_MAX) - 1U;
    }
    return vector;
}
