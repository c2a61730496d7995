#include "gve_guards.h"
#include "unity.h"

#include <stddef.h>

enum {
    OPEN = 0x00, /* inputs as io.h has them: 1 is closed */
    ALL_CLOSED = 0xFF,
    ALL_WIRED = 0xC00F,
    INTERRUPTS = 16,
    AXES = 4,
};

/* Each interrupt with an input, and the bit of that input. */
static const struct {
    unsigned interrupt;
    unsigned input;
} wires[] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {14, 6}, {15, 7}};

#define COUNT_OF(array) (sizeof(array) / sizeof(array)[0])

static struct gve_guards guards;

void setUp(void)
{
    gve_guards_init(&guards);
}

void tearDown(void)
{
}

static void write_both(enum gve_status first, unsigned bits)
{
    gve_guards_write(&guards, first, (uint8_t)(bits & 0xFFU));
    gve_guards_write(&guards, (enum gve_status)(first + 1), (uint8_t)(bits >> 8U));
}

static void assert_causes(unsigned bits)
{
    TEST_ASSERT_EQUAL_HEX8(bits & 0xFFU, gve_guards_read(&guards, GVE_STATUS_CAUSE_1));
    TEST_ASSERT_EQUAL_HEX8(bits >> 8U, gve_guards_read(&guards, GVE_STATUS_CAUSE_2));
}

void test_after_a_reset_all_bytes_are_0(void)
{
    for (unsigned status = 0; status < GVE_STATUS_GUARDS; status++) {
        gve_guards_write(&guards, (enum gve_status)status, 0xFF);
    }
    gve_guards_init(&guards);
    for (unsigned status = 0; status < GVE_STATUS_GUARDS; status++) {
        TEST_ASSERT_EQUAL_HEX8(0, gve_guards_read(&guards, (enum gve_status)status));
    }
}

void test_a_reset_writes_no_more_than_the_guards(void)
{
    struct gve_guards many[2];
    gve_guards_init(&many[1]);
    gve_guards_write(&many[1], GVE_STATUS_ENABLED_1, 0xFF);
    gve_guards_init(&many[0]);
    TEST_ASSERT_EQUAL_HEX8(0xFF, gve_guards_read(&many[1], GVE_STATUS_ENABLED_1));
}

void test_every_bit_of_every_byte_is_kept_by_itself(void)
{
    for (unsigned status = 0; status < GVE_STATUS_GUARDS; status++) {
        for (unsigned bit = 0; bit < 8; bit++) {
            gve_guards_init(&guards);
            gve_guards_write(&guards, (enum gve_status)status, (uint8_t)(1U << bit));
            for (unsigned other = 0; other < GVE_STATUS_GUARDS; other++) {
                unsigned expected = other == status ? 1U << bit : 0U;
                TEST_ASSERT_EQUAL_HEX8(expected, gve_guards_read(&guards, (enum gve_status)other));
            }
        }
    }
}

void test_ports_read_1_where_inputs_are_open_or_are_none(void)
{
    TEST_ASSERT_EQUAL_HEX8(0xFF, gve_guards_port(OPEN, 0));
    TEST_ASSERT_EQUAL_HEX8(0xFF, gve_guards_port(OPEN, 1));
    TEST_ASSERT_EQUAL_HEX8(0xF0, gve_guards_port(ALL_CLOSED, 0));
    TEST_ASSERT_EQUAL_HEX8(0x3F, gve_guards_port(ALL_CLOSED, 1));
}

void test_each_input_has_a_bit_of_one_port(void)
{
    static const uint8_t ports[8][2] = {{0xFE, 0xFF}, {0xFD, 0xFF}, {0xFB, 0xFF}, {0xF7, 0xFF},
                                        {0xFF, 0xFF}, {0xFF, 0xFF}, {0xFF, 0xBF}, {0xFF, 0x7F}};
    for (unsigned input = 0; input < 8; input++) {
        TEST_ASSERT_EQUAL_HEX8(ports[input][0], gve_guards_port((uint8_t)(1U << input), 0));
        TEST_ASSERT_EQUAL_HEX8(ports[input][1], gve_guards_port((uint8_t)(1U << input), 1));
    }
}

void test_each_interrupt_at_active_level_0_is_active_where_its_input_alone_is_closed(void)
{
    write_both(GVE_STATUS_ENABLED_1, 0xFFFF);
    for (size_t i = 0; i < COUNT_OF(wires); i++) {
        unsigned inputs = 1U << wires[i].input;
        TEST_ASSERT_EQUAL_HEX16(1U << wires[i].interrupt, gve_guards_active(&guards, (uint8_t)inputs));
        TEST_ASSERT_EQUAL_HEX16(ALL_WIRED & ~(1U << wires[i].interrupt), gve_guards_active(&guards, (uint8_t)~inputs));
    }
}

void test_each_interrupt_at_active_level_1_is_active_where_its_input_alone_is_open(void)
{
    write_both(GVE_STATUS_ENABLED_1, 0xFFFF);
    write_both(GVE_STATUS_LEVEL_1, 0xFFFF);
    for (size_t i = 0; i < COUNT_OF(wires); i++) {
        unsigned inputs = 1U << wires[i].input;
        TEST_ASSERT_EQUAL_HEX16(1U << wires[i].interrupt, gve_guards_active(&guards, (uint8_t)~inputs));
        TEST_ASSERT_EQUAL_HEX16(ALL_WIRED & ~(1U << wires[i].interrupt), gve_guards_active(&guards, (uint8_t)inputs));
    }
}

void test_each_interrupt_has_a_level_and_an_enabling_bit_of_its_own(void)
{
    for (unsigned interrupt = 0; interrupt < INTERRUPTS; interrupt++) {
        unsigned bit = 1U << interrupt;
        write_both(GVE_STATUS_LEVEL_1, bit);
        write_both(GVE_STATUS_ENABLED_1, bit);
        TEST_ASSERT_EQUAL_HEX16(bit & ALL_WIRED, gve_guards_active(&guards, OPEN));
        TEST_ASSERT_EQUAL_HEX16(0, gve_guards_active(&guards, ALL_CLOSED));
        write_both(GVE_STATUS_ENABLED_1, ~bit & 0xFFFFU);
        TEST_ASSERT_EQUAL_HEX16(0, gve_guards_active(&guards, OPEN));
        TEST_ASSERT_EQUAL_HEX16(ALL_WIRED & ~bit, gve_guards_active(&guards, ALL_CLOSED));
    }
}

void test_interrupts_without_an_input_are_never_active(void)
{
    write_both(GVE_STATUS_ENABLED_1, 0x3FF0);
    TEST_ASSERT_EQUAL_HEX16(0, gve_guards_active(&guards, OPEN));
    TEST_ASSERT_EQUAL_HEX16(0, gve_guards_active(&guards, ALL_CLOSED));
    write_both(GVE_STATUS_LEVEL_1, 0x3FF0);
    TEST_ASSERT_EQUAL_HEX16(0, gve_guards_active(&guards, OPEN));
    TEST_ASSERT_EQUAL_HEX16(0, gve_guards_active(&guards, ALL_CLOSED));
}

void test_a_switch_is_that_of_its_axis_enabled_or_not(void)
{
    for (unsigned enabled = 0; enabled < 2; enabled++) {
        write_both(GVE_STATUS_ENABLED_1, enabled * 0xFFFFU);
        for (unsigned closed = 0; closed < AXES; closed++) {
            for (unsigned axis = 0; axis < AXES; axis++) {
                TEST_ASSERT_EQUAL(axis == closed, gve_guards_switch(&guards, (uint8_t)(1U << closed), axis));
            }
        }
    }
}

void test_a_switch_that_opens_when_it_is_hit_has_its_bit_of_the_level(void)
{
    write_both(GVE_STATUS_LEVEL_1, 0x0004);
    TEST_ASSERT_TRUE(gve_guards_switch(&guards, OPEN, 2));
    TEST_ASSERT_FALSE(gve_guards_switch(&guards, 0x04, 2));
    TEST_ASSERT_FALSE(gve_guards_switch(&guards, OPEN, 1));
}

void test_causes_add_up(void)
{
    for (unsigned interrupt = 0; interrupt < INTERRUPTS; interrupt++) {
        unsigned bit = 1U << interrupt;
        gve_guards_init(&guards);
        gve_guards_add_causes(&guards, (uint16_t)bit);
        assert_causes(bit);
        gve_guards_add_causes(&guards, 0x8001);
        assert_causes(bit | 0x8001U);
        gve_guards_add_causes(&guards, 0);
        assert_causes(bit | 0x8001U);
    }
}

void test_clearing_the_causes_leaves_the_rest(void)
{
    for (unsigned status = 0; status < GVE_STATUS_GUARDS; status++) {
        gve_guards_write(&guards, (enum gve_status)status, (uint8_t)(0xA0U + status));
    }
    gve_guards_clear_causes(&guards);
    assert_causes(0);
    TEST_ASSERT_EQUAL_HEX8(0xA0, gve_guards_read(&guards, GVE_STATUS_ENABLED_1));
    TEST_ASSERT_EQUAL_HEX8(0xA1, gve_guards_read(&guards, GVE_STATUS_ENABLED_2));
    TEST_ASSERT_EQUAL_HEX8(0xA2, gve_guards_read(&guards, GVE_STATUS_LEVEL_1));
    TEST_ASSERT_EQUAL_HEX8(0xA3, gve_guards_read(&guards, GVE_STATUS_LEVEL_2));
}
