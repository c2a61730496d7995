#include "unity.h"

#include "base_tick.h"
#include "gve_receiver.h"

/* What the line does not show, as it tells damage of a packet once. */

static struct gve_receiver receiver;
static uint64_t tick;

void setUp(void)
{
    gve_receiver_init(&receiver, 0, 7);
    receiver.sums = true;
    receiver.packet = true;
    tick = 0;
}

void tearDown(void)
{
}

/* How often something is received in these bytes. */
static unsigned count(enum gve_received wanted, const char *bytes)
{
    unsigned found = 0;
    for (; *bytes != '\0'; bytes++) {
        struct hal_line_byte byte = {.tick = ++tick, .value = (uint8_t)*bytes, .broken = *bytes == '?'};
        found += gve_receiver_take(&receiver, &byte) == wanted ? 1U : 0U;
    }
    return found;
}

void test_the_rest_of_a_damaged_line_is_not_damage_again(void)
{
    TEST_ASSERT_EQUAL_UINT(1, count(GVE_RECEIVED_BAD_LINE, "!0C1?00?00,FF\r"));
    TEST_ASSERT_EQUAL_UINT(1, count(GVE_RECEIVED_LINE, "!0*E1,1D\r"));
}

void test_after_a_damaged_line_stray_bytes_are_damage_of_their_own(void)
{
    TEST_ASSERT_EQUAL_UINT(2, count(GVE_RECEIVED_BAD_LINE, "!0C1?0\rx\r"));
    TEST_ASSERT_EQUAL_UINT(2, count(GVE_RECEIVED_BAD_LINE, "!0C1,00\rxyz\r"));
    TEST_ASSERT_EQUAL_UINT(2, count(GVE_RECEIVED_BAD_LINE, "xy\rz\r"));
    TEST_ASSERT_EQUAL_UINT(1, count(GVE_RECEIVED_LINE, "!0*E1,1D\r"));
}

void test_it_wakes_when_silence_means_something(void)
{
    TEST_ASSERT_EQUAL_UINT64((uint64_t)1000 * TICKS_PER_MS, gve_receiver_wake(&receiver));
    receiver.packet = false;
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, gve_receiver_wake(&receiver));
    (void)count(GVE_RECEIVED_NOTHING, "x");
    TEST_ASSERT_EQUAL_UINT64(tick + (uint64_t)100 * TICKS_PER_MS, gve_receiver_wake(&receiver));
}
