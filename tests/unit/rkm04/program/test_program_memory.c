#include "program_listing.h"
#include "program_memory.h"
#include "unity.h"

#include <string.h>

enum {
    TEXT_BYTES_MAX = PROGRAM_COMMANDS_MAX * PROGRAM_COMMAND_BYTES_MAX
};

static struct program_memory memory;
static uint8_t text[TEXT_BYTES_MAX + 1];

void setUp(void)
{
    memset(&memory, 0xA5, sizeof memory);
    program_memory_clear(&memory);
}

/* What is stored is never more than the ring holds. */
void tearDown(void)
{
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(memory.written, program_memory_oldest(&memory));
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(PROGRAM_COMMANDS_MAX, memory.written - program_memory_oldest(&memory));
}

static bool append(enum program_opcode opcode, int32_t value, bool locked)
{
    struct program_instruction instruction = {.value = value, .opcode = (uint8_t)opcode};
    return program_memory_append(&memory, &instruction, locked);
}

/* `F` with the numbers from `first` on. */
static void append_steps(int32_t first, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        (void)append(PROGRAM_STEPS_FORWARD, first + (int32_t)i, false);
    }
}

static const char *list(uint32_t capacity)
{
    memset(text, 0, sizeof text);
    uint32_t length = program_memory_list(&memory, text, capacity);
    TEST_ASSERT_EQUAL_UINT32(strlen((const char *)text), length);
    return (const char *)text;
}

void test_a_cleared_memory_holds_nothing(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, memory.written);
    TEST_ASSERT_EQUAL_UINT32(0, program_memory_oldest(&memory));
    TEST_ASSERT_EQUAL_STRING("", list(TEXT_BYTES_MAX));
}

void test_a_command_is_found_by_its_ordinal(void)
{
    TEST_ASSERT_TRUE(append(PROGRAM_STEPS_FORWARD, 500, false));
    TEST_ASSERT_TRUE(append(PROGRAM_MOVE, 0, false));
    TEST_ASSERT_EQUAL_UINT32(2, memory.written);
    TEST_ASSERT_EQUAL_INT32(500, program_memory_at(&memory, 0).value);
    TEST_ASSERT_EQUAL_UINT8(PROGRAM_MOVE, program_memory_at(&memory, 1).opcode);
}

void test_the_last_place_takes_a_command_without_a_loss(void)
{
    append_steps(1, PROGRAM_COMMANDS_MAX - 1);
    TEST_ASSERT_TRUE(append(PROGRAM_MOVE, 0, false));
    TEST_ASSERT_EQUAL_UINT32(0, program_memory_oldest(&memory));
    TEST_ASSERT_EQUAL_INT32(1, program_memory_at(&memory, 0).value);
}

void test_one_command_more_overwrites_the_oldest_and_tells_it(void)
{
    append_steps(1, PROGRAM_COMMANDS_MAX);
    TEST_ASSERT_FALSE(append(PROGRAM_MOVE, 0, false));
    TEST_ASSERT_EQUAL_UINT32(1, program_memory_oldest(&memory));
    TEST_ASSERT_EQUAL_INT32(2, program_memory_at(&memory, 1).value);
    TEST_ASSERT_EQUAL_UINT8(PROGRAM_MOVE, program_memory_at(&memory, PROGRAM_COMMANDS_MAX).opcode);
}

void test_the_last_place_takes_a_command_when_locked(void)
{
    append_steps(1, PROGRAM_COMMANDS_MAX - 1);
    TEST_ASSERT_TRUE(append(PROGRAM_MOVE, 0, true));
    TEST_ASSERT_EQUAL_UINT32(PROGRAM_COMMANDS_MAX, memory.written);
}

void test_a_full_memory_that_is_locked_ignores_a_command_and_tells_it(void)
{
    append_steps(1, PROGRAM_COMMANDS_MAX);
    TEST_ASSERT_FALSE(append(PROGRAM_MOVE, 0, true));
    TEST_ASSERT_EQUAL_UINT32(PROGRAM_COMMANDS_MAX, memory.written);
    TEST_ASSERT_EQUAL_INT32(1, program_memory_at(&memory, 0).value);
    TEST_ASSERT_EQUAL_INT32(PROGRAM_COMMANDS_MAX, program_memory_at(&memory, PROGRAM_COMMANDS_MAX - 1).value);
}

void test_a_label_that_a_locked_memory_ignores_is_not_found(void)
{
    uint32_t ordinal = 0;
    append_steps(1, PROGRAM_COMMANDS_MAX);
    (void)append(PROGRAM_LABEL, 7, true);
    TEST_ASSERT_FALSE(program_memory_find_label(&memory, 7, &ordinal));
}

void test_every_command_stays_until_the_ring_comes_round_to_it(void)
{
    for (int32_t value = 1; value <= 3 * PROGRAM_COMMANDS_MAX; value++) {
        append_steps(value, 1);
        for (uint32_t at = program_memory_oldest(&memory); at < memory.written; at++) {
            TEST_ASSERT_EQUAL_INT32((int32_t)at + 1, program_memory_at(&memory, at).value);
        }
    }
}

void test_clearing_a_full_memory_empties_it(void)
{
    uint32_t ordinal = 0;
    (void)append(PROGRAM_LABEL, 1, false);
    (void)append(PROGRAM_RELEASE, 0, false);
    append_steps(1, 2 * PROGRAM_COMMANDS_MAX);
    (void)append(PROGRAM_LABEL, 80, false);
    program_memory_clear(&memory);
    TEST_ASSERT_EQUAL_STRING("", list(TEXT_BYTES_MAX));
    TEST_ASSERT_FALSE(program_memory_find_label(&memory, 80, &ordinal));
    TEST_ASSERT_FALSE(program_memory_is_released(&memory, 0));
}

void test_the_labels_of_the_language_have_a_place_each(void)
{
    TEST_ASSERT_EQUAL_INT32(PROGRAM_LABEL_MAX, program_opcode_row(PROGRAM_LABEL)->max);
}

void test_no_label_is_found_in_an_empty_memory(void)
{
    for (uint32_t label = 1; label <= PROGRAM_LABEL_MAX; label++) {
        uint32_t ordinal = 0;
        TEST_ASSERT_FALSE(program_memory_find_label(&memory, label, &ordinal));
    }
}

void test_a_label_is_found_where_it_stands(void)
{
    uint32_t ordinal = 99;
    append_steps(1, 2);
    (void)append(PROGRAM_LABEL, 80, false);
    append_steps(1, 1);
    TEST_ASSERT_TRUE(program_memory_find_label(&memory, 80, &ordinal));
    TEST_ASSERT_EQUAL_UINT32(2, ordinal);
}

void test_the_first_command_may_be_a_label(void)
{
    uint32_t ordinal = 99;
    (void)append(PROGRAM_LABEL, 1, false);
    TEST_ASSERT_TRUE(program_memory_find_label(&memory, 1, &ordinal));
    TEST_ASSERT_EQUAL_UINT32(0, ordinal);
}

void test_numbers_of_other_commands_are_not_labels(void)
{
    uint32_t ordinal = 0;
    (void)append(PROGRAM_JUMP, 5, false);
    (void)append(PROGRAM_CALL, 5, false);
    TEST_ASSERT_FALSE(program_memory_find_label(&memory, 5, &ordinal));
}

void test_the_youngest_label_counts(void)
{
    uint32_t ordinal = 99;
    (void)append(PROGRAM_LABEL, 4, false);
    append_steps(1, 1);
    (void)append(PROGRAM_LABEL, 4, false);
    TEST_ASSERT_TRUE(program_memory_find_label(&memory, 4, &ordinal));
    TEST_ASSERT_EQUAL_UINT32(2, ordinal);
}

void test_a_label_is_found_until_it_is_overwritten(void)
{
    uint32_t ordinal = 99;
    (void)append(PROGRAM_LABEL, 4, false);
    append_steps(1, PROGRAM_COMMANDS_MAX - 1);
    TEST_ASSERT_TRUE(program_memory_find_label(&memory, 4, &ordinal));
    append_steps(1, 1);
    TEST_ASSERT_FALSE(program_memory_find_label(&memory, 4, &ordinal));
}

TEST_CASE(PROGRAM_JUMP, 4)
TEST_CASE(PROGRAM_LABEL, 5)
void test_what_has_overwritten_a_label_is_not_taken_for_it(int opcode, int value)
{
    uint32_t ordinal = 99;
    (void)append(PROGRAM_LABEL, 4, false);
    append_steps(1, PROGRAM_COMMANDS_MAX - 1);
    (void)append((enum program_opcode)opcode, value, false);
    TEST_ASSERT_FALSE(program_memory_find_label(&memory, 4, &ordinal));
}

void test_a_label_is_found_at_every_place_of_the_ring_until_it_is_overwritten(void)
{
    for (uint32_t at = 0; at < 2 * PROGRAM_COMMANDS_MAX + 2; at++) {
        uint32_t ordinal = 0;
        program_memory_clear(&memory);
        append_steps(1, at);
        (void)append(PROGRAM_LABEL, 80, false);
        TEST_ASSERT_TRUE(program_memory_find_label(&memory, 80, &ordinal));
        TEST_ASSERT_EQUAL_UINT32(at, ordinal);
        append_steps(1, PROGRAM_COMMANDS_MAX - 1);
        TEST_ASSERT_TRUE(program_memory_find_label(&memory, 80, &ordinal));
        TEST_ASSERT_EQUAL_UINT32(at, ordinal);
    }
}

void test_an_overwritten_label_may_be_stored_again(void)
{
    uint32_t ordinal = 99;
    (void)append(PROGRAM_LABEL, 4, false);
    append_steps(1, PROGRAM_COMMANDS_MAX);
    (void)append(PROGRAM_LABEL, 4, false);
    TEST_ASSERT_TRUE(program_memory_find_label(&memory, 4, &ordinal));
    TEST_ASSERT_EQUAL_UINT32(PROGRAM_COMMANDS_MAX + 1, ordinal);
}

void test_nothing_is_released_in_an_empty_memory(void)
{
    TEST_ASSERT_FALSE(program_memory_is_released(&memory, 0));
}

void test_a_hold_waits_until_a_release_is_written(void)
{
    (void)append(PROGRAM_HOLD, 0, false);
    (void)append(PROGRAM_MOVE, 0, false);
    TEST_ASSERT_FALSE(program_memory_is_released(&memory, 0));
    (void)append(PROGRAM_RELEASE, 0, false);
    TEST_ASSERT_TRUE(program_memory_is_released(&memory, 0));
}

void test_a_release_directly_after_its_hold_releases_it(void)
{
    (void)append(PROGRAM_HOLD, 0, false);
    (void)append(PROGRAM_RELEASE, 0, false);
    TEST_ASSERT_TRUE(program_memory_is_released(&memory, 0));
}

void test_a_release_does_not_reach_a_hold_after_it(void)
{
    (void)append(PROGRAM_RELEASE, 0, false);
    (void)append(PROGRAM_HOLD, 0, false);
    TEST_ASSERT_FALSE(program_memory_is_released(&memory, 0));
    TEST_ASSERT_FALSE(program_memory_is_released(&memory, 1));
}

void test_one_release_reaches_all_holds_before_it(void)
{
    (void)append(PROGRAM_HOLD, 0, false);
    (void)append(PROGRAM_HOLD, 0, false);
    (void)append(PROGRAM_RELEASE, 0, false);
    TEST_ASSERT_TRUE(program_memory_is_released(&memory, 0));
    TEST_ASSERT_TRUE(program_memory_is_released(&memory, 1));
}

void test_a_release_that_a_locked_memory_ignores_releases_nothing(void)
{
    (void)append(PROGRAM_HOLD, 0, false);
    append_steps(1, PROGRAM_COMMANDS_MAX - 1);
    (void)append(PROGRAM_RELEASE, 0, true);
    TEST_ASSERT_FALSE(program_memory_is_released(&memory, 0));
}

void test_the_list_is_the_commands_in_the_order_of_writing(void)
{
    (void)append(PROGRAM_ZERO_POSITION, 100, false);
    append_steps(5000, 1);
    (void)append(PROGRAM_MOVE, 0, false);
    (void)append(PROGRAM_GUARD_HIGH, 3, false);
    TEST_ASSERT_EQUAL_STRING("C100F5000RM03", list(TEXT_BYTES_MAX));
}

void test_the_list_of_a_ring_begins_with_the_oldest_command_left(void)
{
    append_steps(1, PROGRAM_COMMANDS_MAX + 2);
    TEST_ASSERT_EQUAL_STRING_LEN("F3F4F5", list(TEXT_BYTES_MAX), 6);
}

void test_the_longest_list_fills_its_capacity(void)
{
    for (unsigned i = 0; i < PROGRAM_COMMANDS_MAX; i++) {
        (void)append(PROGRAM_SET_POSITION, -2000000000, false);
    }
    TEST_ASSERT_EQUAL_UINT32(TEXT_BYTES_MAX, program_memory_list(&memory, text, TEXT_BYTES_MAX));
}

void test_the_list_ends_where_a_longest_command_might_not_fit(void)
{
    append_steps(1, 4);
    TEST_ASSERT_EQUAL_STRING("", list(PROGRAM_COMMAND_BYTES_MAX - 1));
    TEST_ASSERT_EQUAL_STRING("F1", list(PROGRAM_COMMAND_BYTES_MAX));
    TEST_ASSERT_EQUAL_STRING("F1F2", list(PROGRAM_COMMAND_BYTES_MAX + 2));
}

void test_after_the_last_ordinal_all_commands_are_ignored(void)
{
    memory.written = UINT32_MAX - 1U;
    TEST_ASSERT_FALSE(append(PROGRAM_STEPS_FORWARD, 8, false));
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, memory.written);
    TEST_ASSERT_FALSE(append(PROGRAM_STEPS_FORWARD, 9, false));
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, memory.written);
    TEST_ASSERT_EQUAL_INT32(8, program_memory_at(&memory, UINT32_MAX - 1U).value);
}
