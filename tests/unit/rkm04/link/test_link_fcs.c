#include "unity.h"

#include "frame_vectors.h"
#include "link_fcs.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static uint16_t register_after(const char *bytes, uint32_t length)
{
    uint16_t fcs = LINK_FCS_START;
    for (uint32_t i = 0; i < length; i++) {
        fcs = link_fcs_append(fcs, (uint8_t)bytes[i]);
    }
    return fcs;
}

void test_the_check_value_is_that_of_x_25(void)
{
    TEST_ASSERT_EQUAL_HEX16(0x906E, register_after("123456789", 9) ^ 0xFFFF);
}

void test_the_shared_vectors_hold(void)
{
    for (unsigned i = 0; i < sizeof fcs_vectors / sizeof fcs_vectors[0]; i++) {
        uint16_t fcs = register_after(fcs_vectors[i].bytes, fcs_vectors[i].length) ^ 0xFFFF;
        TEST_ASSERT_EQUAL_HEX16(fcs_vectors[i].fcs, fcs);
    }
}

/* The shift register of RFC 1662, bit by bit. */
static uint16_t slow_append(uint16_t fcs, uint8_t byte)
{
    fcs ^= byte;
    for (int bit = 0; bit < 8; bit++) {
        fcs = (uint16_t)((fcs & 1U) != 0 ? fcs >> 1U ^ 0x8408U : fcs >> 1U);
    }
    return fcs;
}

void test_every_step_is_that_of_the_shift_register(void)
{
    for (unsigned fcs = 0; fcs <= 0xFFFF; fcs++) {
        for (unsigned byte = 0; byte <= 0xFF; byte += 15) {
            TEST_ASSERT_EQUAL_HEX16(slow_append((uint16_t)fcs, (uint8_t)byte),
                                    link_fcs_append((uint16_t)fcs, (uint8_t)byte));
        }
    }
}

void test_the_fcs_low_byte_first_leaves_the_residue(void)
{
    uint16_t fcs = register_after("123456789", 9);
    fcs = link_fcs_append(fcs, 0x6E);
    TEST_ASSERT_EQUAL_HEX16(LINK_FCS_GOOD, link_fcs_append(fcs, 0x90));
}
