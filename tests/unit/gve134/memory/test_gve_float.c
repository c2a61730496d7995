#include "unity.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gve_float.h"

enum {
    SEED = 134,
    MANTISSA_BITS = 23,
    EXPONENTS = 256,
    RANDOM_MANTISSAS = 300, /* beside those near powers of two */
    RANDOM_TEXTS = 200000,
    TEXT_ROOM = 256,
};

#define SIGN UINT32_C(0x80000000)
#define INFINITE UINT32_C(0x7F800000)
#define UNTOUCHED UINT32_C(0x12345678)

static uint64_t random_state;

void setUp(void)
{
    random_state = SEED;
}

void tearDown(void)
{
}

static uint32_t random_word(void)
{
    random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(random_state >> 32U);
}

static uint32_t random_below(uint32_t limit)
{
    return (uint32_t)(((uint64_t)random_word() * limit) >> 32U);
}

static float single_of(uint32_t bits)
{
    float single;
    memcpy(&single, &bits, sizeof single);
    return single;
}

static uint32_t bits_of(float single)
{
    uint32_t bits;
    memcpy(&bits, &single, sizeof bits);
    return bits;
}

static enum gve_float_status read(const char *text, uint32_t *bits)
{
    return gve_float_read((const uint8_t *)text, (uint32_t)strlen(text), bits);
}

static void assert_read(uint32_t expected, const char *text)
{
    uint32_t bits = UNTOUCHED;
    TEST_ASSERT_EQUAL_INT_MESSAGE(GVE_FLOAT_OK, read(text, &bits), text);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(expected, bits, text);
}

static void assert_refused(enum gve_float_status status, const char *text)
{
    uint32_t bits = UNTOUCHED;
    TEST_ASSERT_EQUAL_INT_MESSAGE(status, read(text, &bits), text);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(UNTOUCHED, bits, text);
}

/* The C library reads decimals right, too. */
static void assert_read_as_the_library_does(const char *text)
{
    float single = strtof(text, NULL);
    if (isinf(single)) {
        assert_refused(GVE_FLOAT_TOO_LARGE, text);
    } else {
        assert_read(bits_of(single), text);
    }
}

static const char *put(uint32_t bits)
{
    static char bytes[GVE_FLOAT_PUT_BYTES_MAX + 1];
    struct text text;
    text_init(&text, (uint8_t *)bytes, GVE_FLOAT_PUT_BYTES_MAX);
    gve_float_put(&text, bits);
    bytes[text.length] = '\0';
    return bytes;
}

static void assert_there_and_back(uint32_t bits)
{
    char expected[TEXT_ROOM];
    (void)snprintf(expected, sizeof expected, "%.9G", (double)single_of(bits));
    const char *text = put(bits);
    TEST_ASSERT_EQUAL_STRING(expected, text);
    assert_read(bits, text);
}

void test_the_examples_of_the_documents_are_put(void)
{
    TEST_ASSERT_EQUAL_STRING("1.5", put(0x3FC00000));
    TEST_ASSERT_EQUAL_STRING("0.100000001", put(bits_of(0.1F)));
    TEST_ASSERT_EQUAL_STRING("1.50000005E-07", put(bits_of(1.5e-7F)));
    TEST_ASSERT_EQUAL_STRING("INF", put(INFINITE));
    TEST_ASSERT_EQUAL_STRING("-INF", put(INFINITE | SIGN));
    TEST_ASSERT_EQUAL_STRING("NAN", put(INFINITE + 1U));
    TEST_ASSERT_EQUAL_STRING("NAN", put(UINT32_MAX));
    TEST_ASSERT_EQUAL_STRING("0", put(0));
    TEST_ASSERT_EQUAL_STRING("-0", put(SIGN));
}

void test_powers_of_ten_change_from_fixed_to_scientific_where_the_library_does(void)
{
    TEST_ASSERT_EQUAL_STRING("100000000", put(bits_of(1e8F)));
    TEST_ASSERT_EQUAL_STRING("1E+09", put(bits_of(1e9F)));
    for (int exponent = -45; exponent <= 38; exponent++) {
        char text[TEXT_ROOM];
        (void)snprintf(text, sizeof text, "1e%d", exponent);
        uint32_t bits = bits_of(strtof(text, NULL));
        assert_there_and_back(bits);
        assert_there_and_back(bits - 1U);
        assert_there_and_back(bits + 1U);
    }
}

void test_every_exponent_goes_to_text_as_the_library_puts_it_and_back_to_the_same_bits(void)
{
    for (uint32_t exponent = 0; exponent < EXPONENTS - 1U; exponent++) {
        uint32_t first = exponent << MANTISSA_BITS;
        assert_there_and_back(first);
        assert_there_and_back(first + 1U);
        assert_there_and_back(first + (1U << (MANTISSA_BITS - 1)));
        assert_there_and_back(first + (1U << MANTISSA_BITS) - 1U);
        for (unsigned i = 0; i < RANDOM_MANTISSAS; i++) {
            uint32_t sign = random_below(2) * SIGN;
            assert_there_and_back(sign | (first + random_below(1U << MANTISSA_BITS)));
        }
    }
}

void test_texts_of_all_forms_are_read(void)
{
    assert_read(0x3FC00000, "1.5");
    assert_read(0x3FC00000, "0001.500");
    assert_read(0x3FC00000, "15E-1");
    assert_read(0x3FC00000, "0.15e1");
    assert_read(0x3FC00000, "0.15E+1");
    assert_read(0xBFC00000, "-1.5");
    assert_read(0, "0");
    assert_read(SIGN, "-0");
    assert_read(0, "0E99999999999");
    assert_read(SIGN, "-1E-99999999999");
    assert_read(bits_of(1.0F), "1E0000");
    assert_read(bits_of(1.0F), "10000000000000000000000000000000000000000000000000E-49");
    assert_read(bits_of(1.0F), "0.0000000000000000000000000000000000000000000000001E49");
}

void test_what_is_no_number_is_refused(void)
{
    static const char *const texts[] = {
        "",  "-",    "+1", "--1", ".5",   "1.",  "1.E5",  "E5",  "1E",   "1E-", "1E+-5", "1E5.0",
        "x", "1.5 ", " 1", "1,5", "0x10", "INF", "1.5.5", "NAN", "1E5E", "-.5", "1-",    "1e+",
    };
    for (unsigned i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        assert_refused(GVE_FLOAT_NO_NUMBER, texts[i]);
    }
}

void test_the_largest_number_is_taken_and_the_first_that_would_be_infinite_is_too_large(void)
{
    assert_read(INFINITE - 1U, "3.40282346638528859811704183484516925440E38");
    assert_read(INFINITE - 1U, "3.4028235677973366163753939545814225E38");
    assert_refused(GVE_FLOAT_TOO_LARGE, "340282356779733661637539395458142568448"); /* half way to 2^128: to even */
    assert_refused(GVE_FLOAT_TOO_LARGE, "-3.5E38");
    assert_refused(GVE_FLOAT_TOO_LARGE, "1E39");
    assert_refused(GVE_FLOAT_TOO_LARGE, "1E99999999999999");
    assert_refused(GVE_FLOAT_TOO_LARGE, "1000000000000000000000000000000000000000E0");
}

void test_an_exponent_of_any_length_is_not_taken_for_a_small_one(void)
{
    assert_refused(GVE_FLOAT_TOO_LARGE, "1E4294967297");
    assert_refused(GVE_FLOAT_TOO_LARGE, "1E18446744073709551617");
    assert_read(0, "1E-4294967297");
    assert_read(0, "1E-18446744073709551617");
}

void test_what_stands_after_the_text_of_a_number_does_not_count(void)
{
    uint32_t bits = UNTOUCHED;
    TEST_ASSERT_EQUAL_INT(GVE_FLOAT_OK, gve_float_read((const uint8_t *)"15", 1, &bits));
    TEST_ASSERT_EQUAL_HEX32(bits_of(1.0F), bits);
}

void test_half_of_the_smallest_number_is_zero_and_a_little_more_is_the_smallest(void)
{
    assert_read(0, "7.0064923216240853546186479164495806564013097093825788587853E-46");
    assert_read(1, "7.0064923216240853546186479164495806564013097093825788587854E-46");
    assert_read(0, "1E-46");
    assert_read(0, "9.9999999999999999999999999E-47");
}

/* What lies half way between two neighbours has a short text only for some exponents; there all of it is tried. */
void test_a_text_half_way_between_two_singles_goes_to_the_even_one_and_beside_it_to_the_nearer(void)
{
    for (unsigned i = 0; i < RANDOM_TEXTS / 10; i++) {
        int exponent = (int)random_below(150) - 60;
        uint32_t mantissa = (1U << MANTISSA_BITS) + random_below(1U << MANTISSA_BITS);
        double half_way = ldexp(2.0 * mantissa + 1.0, exponent);
        char text[TEXT_ROOM];
        (void)snprintf(text, sizeof text, "%.*f", exponent < 0 ? -exponent : 0, half_way);
        if (strlen(text) < GVE_FLOAT_READ_BYTES_MAX) {
            assert_read_as_the_library_does(text);
            text[strlen(text) - 1]++;
            if (strspn(text, "0123456789.") == strlen(text)) {
                assert_read_as_the_library_does(text);
            }
            text[strlen(text) - 1] -= 2;
            if (strspn(text, "0123456789.") == strlen(text)) {
                assert_read_as_the_library_does(text);
            }
        }
    }
}

static void make_text(char *text)
{
    uint32_t length = 0;
    uint32_t whole = 1U + random_below(random_below(2) == 0 ? 4 : 34);
    uint32_t places = random_below(random_below(2) == 0 ? 4 : 34);
    if (random_below(2) == 0) {
        text[length++] = '-';
    }
    for (uint32_t i = 0; i < whole; i++) {
        text[length++] = (char)('0' + random_below(10));
    }
    if (places != 0) {
        text[length++] = '.';
    }
    for (uint32_t i = 0; i < places; i++) {
        text[length++] = (char)('0' + random_below(10));
    }
    text[length] = '\0';
    if (random_below(4) != 0) {
        (void)snprintf(&text[length], TEXT_ROOM - length, "E%d", (int)random_below(100) - 60);
    }
}

void test_random_decimals_are_read_as_the_library_reads_them(void)
{
    for (unsigned i = 0; i < RANDOM_TEXTS; i++) {
        char text[TEXT_ROOM];
        make_text(text);
        assert_read_as_the_library_does(text);
    }
}
