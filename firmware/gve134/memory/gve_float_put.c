#include <stdbool.h>

#include "gve_big.h"
#include "gve_float.h"
#include "gve_float_format.h"

enum {
    DIGITS = 9,
    FIXED_EXPONENT_MIN = -4, /* of the first digit; below it and from DIGITS on the text has an E */
    QUOTIENT_BITS = 30,      /* 10^9 and less */
    LOG_NUMERATOR = 1233,    /* log10(2) = 1233 / 4096, near enough for every exponent of a single */
    LOG_BITS = 12,
    LOG_OFFSET = 64, /* keeps the logarithm positive while it is rounded down */
};

#define NEXT_POWER UINT32_C(1000000000) /* what has one digit more than DIGITS */

/* digits * 10^(exponent - 8), digits from 10^8 to 10^9 - 1 */
struct scientific {
    uint32_t digits;
    int32_t exponent;
};

/* significand * 2^low * 10^(8 - exponent) */
static struct gve_quotient scale(uint32_t significand, int32_t low, int32_t exponent)
{
    struct gve_big numerator = gve_big_of(significand);
    struct gve_big denominator = gve_big_of(1);
    int32_t tens = DIGITS - 1 - exponent;
    gve_big_shift_left(low < 0 ? &denominator : &numerator, (uint32_t)(low < 0 ? -low : low));
    gve_big_scale_ten(tens < 0 ? &denominator : &numerator, (uint32_t)(tens < 0 ? -tens : tens));
    return gve_big_divide(numerator, denominator, QUOTIENT_BITS + 1);
}

static int32_t find_ten_exponent(uint32_t significand, int32_t low)
{
    int32_t two = low - 1;
    for (uint32_t rest = significand; rest != 0; rest >>= 1U) {
        two++;
    }
    uint32_t log = (uint32_t)(two * LOG_NUMERATOR + LOG_OFFSET * (1 << LOG_BITS)) >> LOG_BITS;
    return (int32_t)log - LOG_OFFSET;
}

static struct scientific make_scientific(uint32_t significand, int32_t low)
{
    int32_t exponent = find_ten_exponent(significand, low);
    struct gve_quotient quotient = scale(significand, low, exponent);
    if (quotient.floor >= NEXT_POWER) {
        exponent++;
        quotient = scale(significand, low, exponent);
    }
    if (quotient.nearest == NEXT_POWER) {
        exponent++;
        quotient.nearest /= 10U;
    }
    return (struct scientific){.digits = quotient.nearest, .exponent = exponent};
}

/* Puts digits without the zeros at their end, with a point after the first `whole` of them; where that is 0 or less,
 * with zeros before them. */
static void put_digits(struct text *text, uint32_t digits, int32_t whole)
{
    uint8_t decimals[DIGITS];
    int32_t count = 0;
    for (int32_t i = DIGITS; i-- > 0; digits /= 10U) {
        decimals[i] = (uint8_t)('0' + digits % 10U);
        count = count == 0 && decimals[i] != '0' ? i + 1 : count;
    }
    for (int32_t place = whole > 0 ? 0 : whole - 1; place < count || place < whole; place++) {
        if (place == whole) {
            text_put_byte(text, '.');
        }
        text_put_byte(text, place < 0 || place >= count ? (uint8_t)'0' : decimals[place]);
    }
}

static void put_exponent(struct text *text, int32_t exponent)
{
    uint32_t size = (uint32_t)(exponent < 0 ? -exponent : exponent);
    text_put_byte(text, 'E');
    text_put_byte(text, exponent < 0 ? '-' : '+');
    text_put_byte(text, (uint8_t)('0' + size / 10U));
    text_put_byte(text, (uint8_t)('0' + size % 10U));
}

static void put_finite(struct text *text, uint32_t significand, int32_t low)
{
    struct scientific number = make_scientific(significand, low);
    bool fixed = number.exponent >= FIXED_EXPONENT_MIN && number.exponent < DIGITS;
    put_digits(text, number.digits, fixed ? number.exponent + 1 : 1);
    if (!fixed) {
        put_exponent(text, number.exponent);
    }
}

void gve_float_put(struct text *text, uint32_t bits)
{
    uint32_t size = bits & ~FLOAT_SIGN;
    if (size > FLOAT_INFINITY) {
        text_put_string(text, "NAN");
        return;
    }
    if (size != bits) {
        text_put_byte(text, '-');
    }
    if (size == FLOAT_INFINITY) {
        text_put_string(text, "INF");
    } else if (size == 0) {
        text_put_byte(text, '0');
    } else {
        uint32_t exponent = size >> FLOAT_FRACTION_BITS;
        uint32_t hidden = exponent != 0 ? FLOAT_FRACTION + 1U : 0U;
        int32_t low = (int32_t)(exponent != 0 ? exponent - 1U : 0U) + FLOAT_EXPONENT_MIN;
        put_finite(text, (size & FLOAT_FRACTION) | hidden, low);
    }
}
