#include "path_fixed.h"

#include <assert.h>

#include "path_divide.h"
#include "path_root.h"
#include "path_vector.h"
#include "step_scale.h"

enum {
    WORD_BITS = 64,
    ROOT_BITS = 124 /* path_root takes squares below 2^124 */
};

struct wide path_fixed_divide(struct wide dividend, uint64_t divisor)
{
    const struct path_divisor ready = path_divisor_of(divisor);
    return path_divide_fixed(dividend, &ready);
}

struct wide path_fixed_multiply(struct wide a, struct wide b)
{
    struct wide whole = path_wide_multiply(a.high, b.high);
    if (whole.high != 0 || whole.low > PATH_FIXED_NEVER) {
        return (struct wide){.high = PATH_FIXED_NEVER};
    }
    struct wide product = path_wide_add((struct wide){.high = whole.low}, path_wide_multiply(a.high, b.low));
    if (a.low == 0) {
        return product;
    }
    product = path_wide_add(product, (struct wide){.low = path_wide_multiply(a.low, b.low).high});
    return path_wide_add(product, path_wide_multiply(a.low, b.high));
}

/* By 1 to 63 bits. */
static struct wide shift_right(struct wide value, unsigned bits)
{
    return (struct wide){
        .high = value.high >> bits,
        .low = (value.low >> bits) | (value.high << (WORD_BITS - bits)),
    };
}

/* The root of a square of 122 bits or more: the nearest whole number and, from the rest that it leaves, rest / (2*root)
 * more or less, which is exact to 1/(8*root). */
static struct wide fine_root(struct wide square)
{
    uint64_t unused = 0;
    uint64_t root = path_root(square);
    const struct path_divisor ready = path_divisor_of(root);
    int64_t rest = wide_to_signed(square.low - root * root);
    uint64_t size = rest < 0 ? (uint64_t)-rest : (uint64_t)rest;
    struct wide half = {.high = size >> 1U, .low = size << (WORD_BITS - 1U)};
    struct wide fraction = {.low = path_divide(half, &ready, &unused)};
    struct wide whole = {.high = root};
    return rest < 0 ? path_wide_subtract(whole, fraction) : path_wide_add(whole, fraction);
}

/* The slope of a speed v is 2*128*f*v, and speeds count in 1/256 steps/s: the square of the slope is f^2 * speed2. */
static_assert(STEP_SLOPE_PER_SPEED == (uint64_t)PATH_SPEED_UNITS * TICK_HZ, "speeds must suit the generator's scale");
static_assert(TICK_HZ % 2U == 0, "half of f^2 must be whole");

struct wide path_fixed_slope(uint64_t twice_speed2)
{
    if (twice_speed2 == 0) {
        return (struct wide){0};
    }
    struct wide square = path_wide_multiply(PATH_SLOPE2_PER_TWICE_SPEED2, twice_speed2);
    unsigned bits = square.high != 0 ? WORD_BITS + path_wide_bits(square.high) : path_wide_bits(square.low);
    unsigned shift = (ROOT_BITS - bits) / 2U;
    return shift_right(fine_root(path_wide_shift(path_wide_shift(square, shift), shift)), shift);
}

struct wide path_fixed_pace(struct wide slope)
{
    unsigned shift = WORD_BITS - 1U - path_wide_bits(slope.high);
    uint64_t divisor = path_wide_shift(slope, shift).high;
    return path_fixed_divide(path_wide_shift((struct wide){.low = STEP_QUANTA}, shift), divisor);
}
