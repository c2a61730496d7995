#include "unity.h"

#include <string.h>

#include "epoch.h"
#include "host_machine.h"
#include "store.h"

enum {
    FLASH_DONE_KINDS = HOST_FLASH_ALL + 1
};

static struct host_machine machine;
static struct host_machine machine_before;
static struct store store;
static struct store store_before;
static uint8_t loaded[STORE_TEXT_BYTES_MAX];

static enum store_error save(unsigned slot, const char *text)
{
    return store_save(&store, slot, (const uint8_t *)text, (uint32_t)strlen(text));
}

static void assert_text(unsigned slot, const char *text)
{
    uint32_t length = store_load(&store, slot, loaded);
    TEST_ASSERT_FALSE(store_is_damaged(&store, slot));
    TEST_ASSERT_EQUAL_UINT32(strlen(text), length);
    TEST_ASSERT_EQUAL_INT(0, memcmp(loaded, text, length));
}

static void assert_texts(const char *zero, const char *one)
{
    assert_text(0, zero);
    assert_text(1, one);
    assert_text(2, "");
    assert_text(3, "");
}

static void restart(void)
{
    host_machine_restart(&machine);
    store_init(&store);
}

static void keep(void)
{
    machine_before = machine;
    store_before = store;
}

static void take_back(void)
{
    machine = machine_before;
    machine.flash_operations = 0;
    store = store_before;
}

/* Lets each operation of storing "NEW TEXT" for slot 1 fail, in each way. */
static void fail_everywhere(const char *zero, const char *one)
{
    keep();
    take_back();
    TEST_ASSERT_EQUAL_INT(STORE_OK, save(1, "NEW TEXT"));
    uint32_t operations = machine.flash_operations;
    for (uint32_t operation = 1; operation <= operations; operation++) {
        for (unsigned done = 0; done < FLASH_DONE_KINDS; done++) {
            take_back();
            machine.faults.flash_fail_at = operation;
            machine.faults.flash_done = (enum host_flash_done)done;

            TEST_ASSERT_EQUAL_INT(STORE_WRITE_FAILED, save(1, "NEW TEXT"));

            assert_texts(zero, one);
            machine.faults = (struct host_faults){0};
            restart();
            assert_texts(zero, one);
        }
    }
}

void setUp(void)
{
    host_machine_init(&machine, epoch_random());
    host_machine_select(&machine);
    store_init(&store);
}

void tearDown(void)
{
}

void test_a_failure_leaves_the_old_text(void)
{
    (void)save(0, "F1000R");
    (void)save(1, "B500R");

    fail_everywhere("F1000R", "B500R");
}

void test_a_failure_leaves_nothing_where_there_was_nothing(void)
{
    (void)save(0, "F1000R");

    fail_everywhere("F1000R", "");
}

void test_a_failure_while_the_area_changes_leaves_the_old_text(void)
{
    (void)save(0, "F1000R");
    (void)save(1, "B500R");
    store.end = HAL_FLASH_AREA_BYTES;

    fail_everywhere("F1000R", "B500R");
}

void test_a_failure_of_the_first_store_leaves_no_motor_damaged(void)
{
    fail_everywhere("", "");
}

void test_after_a_failure_the_next_text_goes_to_the_other_area(void)
{
    (void)save(0, "F1000R");
    unsigned area = store.area;
    machine.faults.flash_fail_at = machine.flash_operations + 3;
    (void)save(1, "NEW TEXT");

    TEST_ASSERT_EQUAL_INT(STORE_OK, save(1, "NEW TEXT"));

    TEST_ASSERT_NOT_EQUAL(area, store.area);
    restart();
    assert_texts("F1000R", "NEW TEXT");
}

void test_after_a_failure_and_a_restart_the_present_area_goes_on(void)
{
    (void)save(0, "F1000R");
    unsigned area = store.area;
    machine.faults.flash_fail_at = machine.flash_operations + 3;
    (void)save(1, "NEW TEXT");
    restart();

    TEST_ASSERT_EQUAL_INT(STORE_OK, save(1, "NEW TEXT"));

    TEST_ASSERT_EQUAL_UINT(area, store.area);
    restart();
    assert_texts("F1000R", "NEW TEXT");
}

void test_a_failed_store_can_be_cut_when_it_has_been_made_void(void)
{
    (void)save(0, "F1000R");
    keep();
    take_back();
    (void)save(1, "NEW TEXT");
    uint32_t operations = machine.flash_operations;
    take_back();
    machine.faults.flash_fail_at = operations;
    machine.faults.flash_cut_after = operations + 1;
    machine.faults.flash_done = HOST_FLASH_ALL;

    (void)save(1, "NEW TEXT");

    TEST_ASSERT_EQUAL_UINT32(operations + 1, machine.flash_operations);
    restart();
    assert_texts("F1000R", "");
}

/* In a head, in the text or far after them a byte has worn out: it reads 0. */
TEST_CASE(0)
TEST_CASE(20)
TEST_CASE(40)
TEST_CASE(5000)
void test_a_byte_that_is_not_blank_sends_the_text_to_the_other_area(int byte)
{
    (void)save(0, "F1000R");
    (void)save(1, "B500R");
    unsigned area = store.area;
    machine.flash[area][store.end + (uint32_t)byte] = 0;

    TEST_ASSERT_EQUAL_INT(STORE_OK, save(1, "NEW TEXT"));

    TEST_ASSERT_NOT_EQUAL(area, store.area);
    assert_texts("F1000R", "NEW TEXT");
    restart();
    assert_texts("F1000R", "NEW TEXT");
}

/* Each operation of storing "NEW TEXT" goes wrong without a report, in each way: the text is there or it is said. */
static void go_wrong_everywhere(void)
{
    keep();
    take_back();
    TEST_ASSERT_EQUAL_INT(STORE_OK, save(1, "NEW TEXT"));
    uint32_t operations = machine.flash_operations;
    for (uint32_t operation = 1; operation <= operations; operation++) {
        for (unsigned done = 0; done < FLASH_DONE_KINDS; done++) {
            take_back();
            machine.faults.flash_silent_at = operation;
            machine.faults.flash_done = (enum host_flash_done)done;

            const char *there = save(1, "NEW TEXT") == STORE_OK ? "NEW TEXT" : "B500R";

            assert_texts("F1000R", there);
            restart();
            assert_texts("F1000R", there);
        }
    }
}

/* Nothing of it is read, which the machine would not let pass. */
void test_a_part_without_the_memory_keeps_nothing_and_says_so(void)
{
    (void)save(0, "F1000R");
    machine.faults.no_flash = true;
    store_init(&store);
    for (unsigned slot = 0; slot < STORE_SLOTS; slot++) {
        TEST_ASSERT_TRUE(store_is_damaged(&store, slot));
        TEST_ASSERT_EQUAL_UINT32(0, store_load(&store, slot, loaded));
        TEST_ASSERT_EQUAL_INT(STORE_WRITE_FAILED, save(slot, "B500R"));
        TEST_ASSERT_TRUE(store_is_damaged(&store, slot));
    }
    uint8_t word[HAL_FLASH_WORD_BYTES] = {0};
    TEST_ASSERT_FALSE(hal_flash_write_word(0, 0, word));
    machine.faults.no_flash = false;
    store_init(&store);
    assert_texts("F1000R", "");
}

void test_a_silent_failure_is_noticed(void)
{
    (void)save(0, "F1000R");
    (void)save(1, "B500R");

    go_wrong_everywhere();
}

/* What is left of old records lies in the way of the copies, or after them. */
TEST_CASE(0)
TEST_CASE(HAL_FLASH_AREA_BYTES - 4)
void test_a_silent_failure_while_the_area_changes_is_noticed(uint32_t left)
{
    (void)save(0, "F1000R");
    (void)save(1, "B500R");
    store.end = HAL_FLASH_AREA_BYTES;
    memset(&machine.flash[1U - store.area][left], 0, HAL_FLASH_AREA_BYTES - left);

    go_wrong_everywhere();
}
