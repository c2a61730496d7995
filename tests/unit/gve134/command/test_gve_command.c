#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gve_command.h"

enum {
    TEXT_ROOM = 100,
};

void setUp(void)
{
}

void tearDown(void)
{
}

static struct gve_reading read_at(enum gve_address address, const char *text)
{
    return gve_command_read((const uint8_t *)text, (uint32_t)strlen(text), address);
}

static struct gve_reading read(const char *text)
{
    return read_at(GVE_ADDRESS_INTERPOLATOR, text);
}

static void assert_command(enum gve_opcode opcode, const char *text)
{
    struct gve_reading reading = read(text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(GVE_FAULT_NONE, reading.fault, text);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(gve_words(opcode)->name, gve_words(reading.command.opcode)->name, text);
}

static void assert_number(int32_t expected, unsigned place, const char *text)
{
    struct gve_reading reading = read(text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(GVE_FAULT_NONE, reading.fault, text);
    TEST_ASSERT_EQUAL_INT32_MESSAGE(expected, reading.command.numbers[place], text);
}

static void assert_fault(enum gve_fault fault, uint32_t place, const char *text)
{
    struct gve_reading reading = read(text);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(gve_fault_text(fault), gve_fault_text(reading.fault), text);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(place, reading.place, text);
}

static void assert_code(enum gve_code code, const char *text)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(code, gve_fault_code(read(text).fault), text);
}

void test_the_example_of_each_command_is_that_command_in_either_case(void)
{
    for (unsigned opcode = 0; opcode < GVE_OPCODES; opcode++) {
        const struct gve_row *row = gve_row(opcode);
        const char *example = gve_words(opcode)->example;
        char lower[TEXT_ROOM] = "";
        for (unsigned i = 0; example[i] != '\0'; i++) {
            char letter = example[i];
            lower[i] = letter >= 'A' && letter <= 'Z' ? (char)(letter - 'A' + 'a') : letter;
        }
        for (unsigned address = 1; address <= 2; address++) {
            if ((row->address & address) != 0) {
                struct gve_reading upper = read_at((enum gve_address)address, example);
                struct gve_reading same = read_at((enum gve_address)address, lower);
                TEST_ASSERT_EQUAL_INT_MESSAGE(GVE_FAULT_NONE, upper.fault, example);
                TEST_ASSERT_EQUAL_UINT_MESSAGE(opcode, upper.command.opcode, example);
                TEST_ASSERT_EQUAL_UINT_MESSAGE(opcode, same.command.opcode, example);
                TEST_ASSERT_EQUAL_INT32_ARRAY(upper.command.numbers, same.command.numbers, GVE_NUMBERS_MAX);
            }
        }
    }
}

void test_the_longest_name_wins(void)
{
    assert_command(GVE_SPEED, "V10");
    assert_command(GVE_CORRECTED, "VK");
    assert_command(GVE_UNCORRECTED, "VN");
    assert_command(GVE_LIMITS, "VL10,10,10,10");
    assert_command(GVE_POSITION_2, "P");
    assert_command(GVE_POSITION_4, "P4");
    assert_command(GVE_READ_SINGLE, "EFR10");
    assert_command(GVE_FLAGS, "F");
    assert_command(GVE_DELETE, "D");
    assert_code(GVE_WRONG_SYNTAX, "P5");
    assert_code(GVE_WRONG_SYNTAX, "VX");
}

void test_a_long_name_with_too_much_after_it_is_not_taken_for_a_short_one(void)
{
    assert_fault(GVE_FAULT_SURPLUS, 2, "VK10");
    assert_fault(GVE_FAULT_SURPLUS, 2, "VN200000");
    assert_fault(GVE_FAULT_SURPLUS, 2, "PF0");
    TEST_ASSERT_EQUAL_UINT(GVE_CORRECTED, read("VK10").command.opcode);
    TEST_ASSERT_EQUAL_UINT(GVE_POSITION_3, read("PF0").command.opcode);
}

void test_what_stands_after_the_text_does_not_count(void)
{
    static const uint8_t bytes[] = "L1,-5";
    struct gve_reading reading = gve_command_read(bytes, 3, GVE_ADDRESS_INTERPOLATOR);
    TEST_ASSERT_EQUAL_INT(GVE_FAULT_NO_DECIMAL, reading.fault);
    TEST_ASSERT_EQUAL_UINT32(3, reading.place);
}

void test_what_no_name_fits_is_unknown(void)
{
    static const char *const texts[] = {"",   "X", "X5", "E", "E5", "S", "I",   "I3",   "%",
                                        "%5", "*", "*X", "M", "0",  ",", " L1", "\xE1", "EU10"};
    for (unsigned i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        assert_fault(GVE_FAULT_UNKNOWN, 0, texts[i]);
        TEST_ASSERT_EQUAL_UINT(GVE_OPCODES, read(texts[i]).command.opcode);
        TEST_ASSERT_EQUAL_UINT32(0, read(texts[i]).parameter);
    }
}

void test_the_spindle_knows_its_own_commands_and_no_others(void)
{
    TEST_ASSERT_EQUAL_UINT(GVE_SPINDLE, read_at(GVE_ADDRESS_SPINDLE, "V1000").command.opcode);
    TEST_ASSERT_EQUAL_INT(GVE_FAULT_BOUNDS, read_at(GVE_ADDRESS_SPINDLE, "V1001").fault);
    TEST_ASSERT_EQUAL_INT(GVE_FAULT_MISSING, read_at(GVE_ADDRESS_SPINDLE, "V").fault);
    TEST_ASSERT_EQUAL_INT(GVE_FAULT_NO_DECIMAL, read_at(GVE_ADDRESS_SPINDLE, "VX").fault);
    static const char *const others[] = {"VK", "VL10,10,10,10", "H", "L1", "PF", "*S", "*E1", "SR2", "F"};
    for (unsigned i = 0; i < sizeof others / sizeof others[0]; i++) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(GVE_FAULT_UNKNOWN, read_at(GVE_ADDRESS_SPINDLE, others[i]).fault, others[i]);
    }
}

void test_a_vector_has_one_to_four_numbers_and_the_others_are_zero(void)
{
    static const int32_t expected[GVE_NUMBERS_MAX] = {1, -2, 0, 0, 0};
    struct gve_reading reading = read("C1,-2");
    TEST_ASSERT_EQUAL_INT(GVE_FAULT_NONE, reading.fault);
    TEST_ASSERT_EQUAL_UINT8(2, reading.command.count);
    TEST_ASSERT_EQUAL_INT32_ARRAY(expected, reading.command.numbers, GVE_NUMBERS_MAX);
    TEST_ASSERT_EQUAL_UINT8(4, read("L1,2,3,4").command.count);
    assert_fault(GVE_FAULT_MISSING, 1, "L");
    assert_fault(GVE_FAULT_SURPLUS, 9, "C1,2,3,4,5");
}

void test_the_limits_of_the_contract_are_taken(void)
{
    static const char *const good[] = {
        "L2147483647,-2147483647,0,1",
        "T1",
        "T24",
        "$1",
        "$2147483647",
        "A1",
        "A8000",
        "V10",
        "V200000",
        "B10",
        "B200000",
        "VL10,200000,10,200000",
        "VJ0,200000,0,200000",
        "XM1",
        "XM1000",
        "NA-2147483647",
        "WX-1,10,1,10",
        "WA2147483647,200000,2147483647,200000",
        "SR0",
        "SR7",
        "SW0,00",
        "SW6,ff",
        "O0,FB",
        "O0,0",
        "ERFF",
        "EURFC",
        "EFR0",
        "EWFF,0",
        "EUWFC,FFFFFFFF",
        "EUW0,1",
        "*E0",
        "*E128",
    };
    for (unsigned i = 0; i < sizeof good / sizeof good[0]; i++) {
        assert_code(GVE_DONE, good[i]);
    }
}

void test_what_is_past_the_limits_of_the_contract_is_out_of_bounds(void)
{
    static const char *const bad[] = {
        "L2147483648",
        "T18446744073709551617",
        "L-2147483648",
        "L0,99999999999999999999999999",
        "T0",
        "T25",
        "$0",
        "$2147483648",
        "A0",
        "A8001",
        "V9",
        "V200001",
        "V-10",
        "B9",
        "B200001",
        "VL9,10,10,10",
        "VL10,10,10,200001",
        "VJ-1,0,0,0",
        "VJ0,0,0,200001",
        "XM0",
        "XM1001",
        "NX-2147483648",
        "WX0,10,1,10",
        "WX-0,10,1,10",
        "WX1,9,1,10",
        "WX1,10,0,10",
        "WX1,10,1,9",
        "SR8",
        "SW7,00",
        "SW8,F1",
        "SW0,100",
        "SW0,001",
        "O1,FF",
        "O0,0FB",
        "ER100",
        "ER005",
        "EURFD",
        "EFRFD",
        "EWFF,100",
        "EUWFD,0",
        "EUW0,000000001",
        "EUW0,100000000",
        "EFWFD,1",
        "EFW0,1E39",
        "*E129",
        "*E-1",
    };
    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_code(GVE_OUT_OF_BOUNDS, bad[i]);
    }
}

void test_wrong_syntax_is_told_whatever_else_is_out_of_bounds(void)
{
    static const char *const texts[] = {
        "V",           "V,",        "V10,",    "V10,10",      "V1 0",       "V+10",
        "V1.0",        "V--10",     "V-",      "L1,,2",       "L1,2,",      "L99999999999,x",
        "C1,2,3,4,5C", "NX",        "NQ5",     "N5",          "NX1,2",      "NXY",
        "NX,",         "W",         "WX1,2,3", "WX1,2,3,4,5", "ER",         "ERG0",
        "ER/0",        "ER:0",      "ER@0",    "N,5",         "ER0G",       "EW01",
        "EW01,",       "EW01,09,1", "EFW10,",  "EFW10,1.",    "EFW10,x",    "SW,1",
        "?1",          "PF0",       "H5",      "*S1",         "*E",         "*Ex",
        "%+,5C",       "@1",        "J0",      "SW9,G1",      "EFW1000,.5", "V1:",
        "V1/",         "V99999:",
    };
    for (unsigned i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        assert_code(GVE_WRONG_SYNTAX, texts[i]);
    }
}

void test_a_fault_has_its_place_and_its_parameter(void)
{
    assert_fault(GVE_FAULT_BOUNDS, 1, "V9");
    assert_fault(GVE_FAULT_BOUNDS, 4, "SW0,100");
    assert_fault(GVE_FAULT_NO_DECIMAL, 3, "L1,x,2147483648");
    assert_fault(GVE_FAULT_NO_DECIMAL, 14, "L1,2147483648,x");
    assert_fault(GVE_FAULT_BOUNDS, 3, "L1,2147483648,99999999999");
    assert_fault(GVE_FAULT_MISSING, 8, "WX1,10,1");
    assert_fault(GVE_FAULT_NO_DECIMAL, 9, "WX1,10,1,");
    assert_fault(GVE_FAULT_NO_AXIS, 1, "NQ5");
    assert_fault(GVE_FAULT_NO_HEX, 4, "EW0,x");
    assert_fault(GVE_FAULT_NO_SINGLE, 5, "EFW1,x");
    TEST_ASSERT_EQUAL_UINT32(3, read("WX1,10,x,10").parameter);
}

void test_a_comma_after_an_axis_may_be_left_out(void)
{
    static const char *const texts[] = {"WY-20000,1000,2000,500", "WY,-20000,1000,2000,500", "wy,-20000,1000,2000,500"};
    static const int32_t expected[GVE_NUMBERS_MAX] = {1, -20000, 1000, 2000, 500};
    for (unsigned i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        struct gve_reading reading = read(texts[i]);
        TEST_ASSERT_EQUAL_INT_MESSAGE(GVE_FAULT_NONE, reading.fault, texts[i]);
        TEST_ASSERT_EQUAL_INT32_ARRAY_MESSAGE(expected, reading.command.numbers, GVE_NUMBERS_MAX, texts[i]);
    }
    assert_number(3, 0, "NA,7");
    assert_number(7, 1, "NA7");
    assert_command(GVE_SET_POSITION, "NX0");
    assert_command(GVE_SET_POSITION, "nz0");
    assert_command(GVE_ZERO, "N");
}

void test_numbers_are_what_they_say(void)
{
    assert_number(-2147483647, 0, "L-2147483647");
    assert_number(0, 0, "L-0");
    assert_number(5, 0, "L0000000000000000000000000000000000005");
    assert_number(0x2B, 1, "SW0,2b");
    assert_number(0xFC, 0, "EURfC");
    assert_number(-1, 1, "EUW0,FFFFFFFF");
    assert_number(0x3FC00000, 1, "EFW10,1.5");
    assert_number(0x3FC00000, 1, "EFW10,15e-1");
}

void test_a_command_of_the_most_characters_is_read(void)
{
    char text[GVE_TEXT_BYTES_MAX + 1];
    memset(text, '0', sizeof text - 1);
    text[0] = 'L';
    text[GVE_TEXT_BYTES_MAX - 1] = '7';
    text[GVE_TEXT_BYTES_MAX] = '\0';
    assert_number(7, 0, text);
}

/* As the table of the contract has it: rest, work, ended, waiting, locked. */
void test_each_state_refuses_what_the_table_of_states_says(void)
{
    static const struct {
        enum gve_opcode opcode;
        uint8_t codes[GVE_STATES];
    } expected[] = {
        {GVE_LINE, {0, 1, 0, 1, 7}},       {GVE_CONTINUE, {0, 0, 0, 0, 7}},     {GVE_REFERENCE, {0, 7, 7, 7, 7}},
        {GVE_ZERO, {0, 7, 0, 7, 0}},       {GVE_SET_POSITION, {0, 7, 0, 7, 0}}, {GVE_WRITE_BYTE, {0, 7, 0, 7, 0}},
        {GVE_WRITE_WORD, {0, 7, 0, 7, 0}}, {GVE_WRITE_SINGLE, {0, 7, 0, 7, 0}}, {GVE_HALT, {0, 0, 0, 0, 0}},
        {GVE_GO, {6, 6, 6, 0, 6}},         {GVE_DELETE, {0, 7, 0, 0, 0}},       {GVE_KEEP, {0, 7, 0, 0, 0}},
        {GVE_RESTORE, {0, 7, 0, 0, 0}},    {GVE_RESET, {0, 0, 0, 0, 0}},        {GVE_SPEED, {0, 0, 0, 0, 0}},
    };
    for (unsigned i = 0; i < sizeof expected / sizeof expected[0]; i++) {
        for (unsigned state = 0; state < GVE_STATES; state++) {
            TEST_ASSERT_EQUAL_INT_MESSAGE(expected[i].codes[state],
                                          gve_refusal(expected[i].opcode, (enum gve_state)state),
                                          gve_words(expected[i].opcode)->name);
        }
    }
}

void test_each_command_is_among_those_of_its_first_character(void)
{
    for (unsigned opcode = 0; opcode < GVE_OPCODES; opcode++) {
        struct gve_opcodes some = gve_opcodes_of((uint8_t)gve_row(opcode)->text[0]);
        TEST_ASSERT_TRUE_MESSAGE(some.first <= opcode && opcode < some.past, gve_words(opcode)->name);
    }
    for (unsigned character = 0; character <= UINT8_MAX; character++) {
        struct gve_opcodes some = gve_opcodes_of((uint8_t)character);
        TEST_ASSERT_TRUE(some.past <= GVE_OPCODES);
        TEST_ASSERT_TRUE(some.first == some.past || gve_row(some.first)->text[0] == (char)character);
    }
}

void test_each_fault_and_kind_has_a_text(void)
{
    for (unsigned fault = 0; fault < GVE_FAULTS_TOTAL; fault++) {
        TEST_ASSERT_NOT_EQUAL_UINT(0, strlen(gve_fault_text((enum gve_fault)fault)));
    }
    TEST_ASSERT_EQUAL_STRING("PULSES", gve_kind_name(GVE_PARAMETER_PULSES));
}
