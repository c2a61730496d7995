#include "unity.h"

#include <string.h>

#include "gve_answer.h"

static struct gve_answer answer;

void setUp(void)
{
    memset(&answer, 0xA5, sizeof answer);
    gve_answer_init(&answer);
}

void tearDown(void)
{
}

void test_at_first_there_is_nothing_to_send_and_nothing_to_send_again(void)
{
    TEST_ASSERT_FALSE(gve_answer_is_sending(&answer));
    TEST_ASSERT_FALSE(gve_answer_again(&answer));
    TEST_ASSERT_FALSE(gve_answer_is_sending(&answer));
}
