#include <assert.h>
#include <stdbool.h>

#include "gve_big.h"
#include "gve_float.h"
#include "gve_float_format.h"

/*
 * A text is digits * 10^exponent, a quotient of two whole numbers. One of them is shifted until the quotient has the
 * bits of a significand; what is left over rounds it.
 */
enum {
    TEN_EXPONENT_MIN = -45, /* 10^-46 is less than half of the smallest single, 1.4 * 10^-45 */
    TEN_EXPONENT_MAX = 39,  /* 10^39 is more than the largest, 3.4 * 10^38 */
    EXPONENT_MAX = 1000,    /* as good as any larger one */
    TENS_MAX = GVE_FLOAT_READ_BYTES_MAX - TEN_EXPONENT_MIN,
    TEN_BITS_TENTHS = 34, /* more than 10 times the bits of a decimal digit */
};

static_assert(TENS_MAX * TEN_BITS_TENTHS / 10 + FLOAT_SIGNIFICAND_BITS + 1 <= GVE_BIG_WORDS * 32,
              "a denominator fits, with room for the division");
static_assert(EXPONENT_MAX > GVE_FLOAT_READ_BYTES_MAX + TENS_MAX, "digits do not make up for a cut exponent");

/* What a text says. */
struct decimal {
    struct gve_big digits;
    int32_t exponent; /* of ten */
    int32_t count;    /* digits from the first that is not 0 */
    bool negative;
};

struct reader {
    const uint8_t *text;
    uint32_t length;
    uint32_t next;
};

static uint8_t reader_peek(const struct reader *reader)
{
    return reader->next < reader->length ? reader->text[reader->next] : 0;
}

static bool reader_take(struct reader *reader, uint8_t byte)
{
    bool found = reader_peek(reader) == byte;
    reader->next += found ? 1U : 0U;
    return found;
}

static bool reader_take_digit(struct reader *reader, uint32_t *digit)
{
    uint8_t byte = reader_peek(reader);
    if (byte < '0' || byte > '9') {
        return false;
    }
    *digit = (uint32_t)byte - '0';
    reader->next++;
    return true;
}

/* Reads digits of the number, each of which changes the exponent by so much. False: there is none. */
static bool read_digits(struct reader *reader, struct decimal *decimal, int32_t exponent_step)
{
    uint32_t begin = reader->next;
    uint32_t digit = 0;
    while (reader_take_digit(reader, &digit)) {
        gve_big_multiply(&decimal->digits, 10, digit);
        decimal->exponent += exponent_step;
        decimal->count += decimal->count != 0 || digit != 0 ? 1 : 0;
    }
    return reader->next > begin;
}

static bool read_exponent(struct reader *reader, struct decimal *decimal)
{
    bool negative = reader_take(reader, '-');
    if (!negative) {
        (void)reader_take(reader, '+');
    }
    uint32_t begin = reader->next;
    uint32_t digit = 0;
    int32_t exponent = 0;
    while (reader_take_digit(reader, &digit)) {
        exponent = exponent * 10 + (int32_t)digit;
        exponent = exponent > EXPONENT_MAX ? EXPONENT_MAX : exponent;
    }
    decimal->exponent += negative ? -exponent : exponent;
    return reader->next > begin;
}

static bool read_text(struct reader *reader, struct decimal *decimal)
{
    *decimal = (struct decimal){.negative = reader_take(reader, '-')};
    bool good = read_digits(reader, decimal, 0);
    if (good && reader_take(reader, '.')) {
        good = read_digits(reader, decimal, -1);
    }
    if (good && (reader_take(reader, 'E') || reader_take(reader, 'e'))) {
        good = read_exponent(reader, decimal);
    }
    return good && reader->next == reader->length;
}

/* Whether numerator / denominator is below 2^exponent. */
static bool is_below_power(const struct gve_big *numerator, const struct gve_big *denominator, int32_t exponent)
{
    struct gve_big high = *numerator;
    struct gve_big low = *denominator;
    if (exponent >= 0) {
        gve_big_shift_left(&low, (uint32_t)exponent);
    } else {
        gve_big_shift_left(&high, (uint32_t)-exponent);
    }
    return gve_big_compare(&high, &low) < 0;
}

/* The exponent of a single's lowest bit for a quotient that is not 0. */
static int32_t find_low_exponent(const struct gve_big *numerator, const struct gve_big *denominator)
{
    int32_t exponent = (int32_t)gve_big_bits(numerator) - (int32_t)gve_big_bits(denominator);
    if (is_below_power(numerator, denominator, exponent)) {
        exponent--;
    }
    int32_t low = exponent - (FLOAT_SIGNIFICAND_BITS - 1);
    return low < FLOAT_EXPONENT_MIN ? FLOAT_EXPONENT_MIN : low;
}

/* The bits of what is not 0 and neither too small nor far too large; FLOAT_INFINITY: it is too large. */
static uint32_t make_bits(const struct decimal *decimal)
{
    struct gve_big numerator = decimal->digits;
    struct gve_big denominator = gve_big_of(1);
    gve_big_scale_ten(decimal->exponent < 0 ? &denominator : &numerator,
                      (uint32_t)(decimal->exponent < 0 ? -decimal->exponent : decimal->exponent));
    int32_t low = find_low_exponent(&numerator, &denominator);
    gve_big_shift_left(low < 0 ? &numerator : &denominator, (uint32_t)(low < 0 ? -low : low));
    struct gve_quotient quotient = gve_big_divide(numerator, denominator, FLOAT_SIGNIFICAND_BITS);
    /* The highest bit of the significand adds one to the exponent, and so does a carry into the bit above it. */
    return ((uint32_t)(low - FLOAT_EXPONENT_MIN) << FLOAT_FRACTION_BITS) + quotient.nearest;
}

enum gve_float_status gve_float_read(const uint8_t *text, uint32_t length, uint32_t *bits)
{
    assert(length <= GVE_FLOAT_READ_BYTES_MAX);
    struct reader reader = {.text = text, .length = length};
    struct decimal decimal;
    if (!read_text(&reader, &decimal)) {
        return GVE_FLOAT_NO_NUMBER;
    }
    uint32_t made = 0;
    int32_t tens = decimal.count + decimal.exponent;
    if (decimal.count != 0 && tens > TEN_EXPONENT_MAX) {
        return GVE_FLOAT_TOO_LARGE;
    }
    if (decimal.count != 0 && tens >= TEN_EXPONENT_MIN) {
        made = make_bits(&decimal);
    }
    if (made >= FLOAT_INFINITY) {
        return GVE_FLOAT_TOO_LARGE;
    }
    *bits = made | (decimal.negative ? FLOAT_SIGN : 0U);
    return GVE_FLOAT_OK;
}
