#include "path_fixed.h"

#include <assert.h>

#include "path_vector.h"
#include "step_scale.h"

enum {
    WORD_BITS = 64,
    ROOT_BITS = 124 /* wide_root_nearest takes squares below 2^124 */
};

struct wide path_wide_times(struct wide value, uint64_t factor)
{
    struct wide product = wide_multiply(value.low, factor);
    product.high += value.high * factor;
    return product;
}

struct wide path_fixed_divide(struct wide dividend, uint64_t divisor)
{
    uint64_t rest = 0;
    uint64_t whole = wide_divide(dividend, divisor, &rest);
    uint64_t fraction = wide_divide((struct wide){.high = rest}, divisor, &rest);
    return (struct wide){.high = whole, .low = fraction};
}

struct wide path_fixed_part(struct wide value, uint64_t divisor)
{
    uint64_t rest = 0;
    struct wide left = {.high = value.high % divisor, .low = value.low};
    return (struct wide){.high = value.high / divisor, .low = wide_divide(left, divisor, &rest)};
}

struct wide path_fixed_multiply(struct wide a, struct wide b)
{
    struct wide whole = wide_multiply(a.high, b.high);
    if (whole.high != 0 || whole.low > PATH_FIXED_NEVER) {
        return (struct wide){.high = PATH_FIXED_NEVER};
    }
    struct wide product = {.high = whole.low, .low = wide_multiply(a.low, b.low).high};
    product = wide_add(product, wide_multiply(a.high, b.low));
    return wide_add(product, wide_multiply(a.low, b.high));
}

static unsigned bits_of(uint64_t value)
{
    uint32_t high = (uint32_t)(value >> 32U);
    return high != 0 ? 32U + wide_bits(high) : wide_bits((uint32_t)value);
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
    uint64_t root = wide_root_nearest(square);
    int64_t rest = wide_to_signed(square.low - root * root);
    uint64_t size = rest < 0 ? (uint64_t)-rest : (uint64_t)rest;
    struct wide fraction = {.low = wide_divide((struct wide){size >> 1U, size << (WORD_BITS - 1U)}, root, &unused)};
    struct wide whole = {.high = root};
    return rest < 0 ? wide_subtract(whole, fraction) : wide_add(whole, fraction);
}

/* The slope of a speed v is 2*128*f*v, and speeds count in 1/256 steps/s: the square of the slope is f^2 * speed2. */
static_assert(STEP_SLOPE_PER_SPEED == (uint64_t)PATH_SPEED_UNITS * TICK_HZ, "speeds must suit the generator's scale");
static_assert(TICK_HZ % 2U == 0, "half of f^2 must be whole");

struct wide path_fixed_slope(uint64_t twice_speed2)
{
    if (twice_speed2 == 0) {
        return (struct wide){0};
    }
    struct wide square = wide_multiply(PATH_SLOPE2_PER_TWICE_SPEED2, twice_speed2);
    unsigned bits = square.high != 0 ? WORD_BITS + bits_of(square.high) : bits_of(square.low);
    unsigned shift = (ROOT_BITS - bits) / 2U;
    return shift_right(fine_root(wide_shift_left(wide_shift_left(square, shift), shift)), shift);
}

struct wide path_fixed_pace(struct wide slope)
{
    unsigned shift = WORD_BITS - 1U - bits_of(slope.high);
    uint64_t divisor = wide_shift_left(slope, shift).high;
    return path_fixed_divide(wide_shift_left((struct wide){.low = STEP_QUANTA}, shift), divisor);
}
