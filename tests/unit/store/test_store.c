#include "unity.h"

#include <string.h>

#include "epoch.h"
#include "host_machine.h"
#include "store.h"

enum {
    RECORD_EXTRA_BYTES = 48, /* what a record takes besides its text */
    LONGEST_RECORDS = 15,    /* records of the longest text in an area */
};

static struct host_machine machine;
static struct store store;
static uint8_t longest[STORE_TEXT_BYTES_MAX];
static uint8_t loaded[STORE_TEXT_BYTES_MAX];

static enum store_error save(unsigned slot, const char *text)
{
    return store_save(&store, slot, (const uint8_t *)text, (uint32_t)strlen(text));
}

/* The longest text there is, another one each time. */
static enum store_error save_longest(unsigned slot)
{
    static uint8_t change;
    memset(longest, 'R', sizeof longest);
    longest[sizeof longest - 1] = ++change;
    return store_save(&store, slot, longest, STORE_TEXT_BYTES_MAX);
}

static void assert_text(unsigned slot, const char *text)
{
    memset(loaded, 0, sizeof loaded);
    uint32_t length = store_load(&store, slot, loaded);
    TEST_ASSERT_EQUAL_UINT32(length, store_length(&store, slot));
    TEST_ASSERT_EQUAL_UINT32(strlen(text), length);
    TEST_ASSERT_EQUAL_STRING(text, loaded);
    TEST_ASSERT_FALSE(store_is_damaged(&store, slot));
}

static void restart(void)
{
    host_machine_restart(&machine);
    store_init(&store);
}

void setUp(void)
{
    host_machine_init(&machine, epoch_random());
    host_machine_select(&machine);
    store_init(&store);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, machine.flash_rewrites);
}

void test_erased_flash_holds_nothing(void)
{
    for (unsigned slot = 0; slot < STORE_SLOTS; slot++) {
        TEST_ASSERT_EQUAL_UINT32(0, store_load(&store, slot, loaded));
        TEST_ASSERT_FALSE(store_is_damaged(&store, slot));
    }
}

void test_looking_for_images_writes_nothing(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, machine.flash_operations);
}

void test_a_text_is_there_at_once(void)
{
    TEST_ASSERT_EQUAL_INT(STORE_OK, save(2, "F1000R"));

    assert_text(2, "F1000R");
}

void test_a_text_is_there_after_a_restart(void)
{
    (void)save(2, "F1000R");

    restart();

    assert_text(2, "F1000R");
}

void test_a_text_takes_the_place_of_the_one_before(void)
{
    (void)save(0, "F1000R");
    (void)save(0, "B7R");

    restart();

    assert_text(0, "B7R");
}

void test_the_motors_have_texts_of_their_own(void)
{
    (void)save(3, "three");
    (void)save(1, "one");
    (void)save(0, "zero");
    (void)save(2, "two");

    restart();

    assert_text(0, "zero");
    assert_text(1, "one");
    assert_text(2, "two");
    assert_text(3, "three");
}

TEST_CASE(1)
TEST_CASE(3)
TEST_CASE(4)
TEST_CASE(5)
TEST_CASE(63)
TEST_CASE(64)
TEST_CASE(65)
TEST_CASE(8399)
TEST_CASE(8400)
void test_a_text_of_any_length_comes_back(int length)
{
    memset(longest, 'F', sizeof longest);
    longest[length - 1] = 'R';

    TEST_ASSERT_EQUAL_INT(STORE_OK, store_save(&store, 1, longest, (uint32_t)length));

    restart();
    TEST_ASSERT_EQUAL_UINT32(length, store_load(&store, 1, loaded));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(longest, loaded, length);
}

void test_a_text_that_is_too_long_is_refused_and_the_old_one_stays(void)
{
    static const uint8_t text[STORE_TEXT_BYTES_MAX + 1];
    (void)save(0, "old");

    TEST_ASSERT_EQUAL_INT(STORE_TOO_LONG, store_save(&store, 0, text, sizeof text));

    assert_text(0, "old");
}

void test_an_empty_text_takes_the_place_of_the_one_before(void)
{
    (void)save(0, "old");

    TEST_ASSERT_EQUAL_INT(STORE_OK, save(0, ""));

    restart();
    assert_text(0, "");
}

void test_bytes_of_any_value_come_back(void)
{
    uint8_t text[UINT8_MAX + 1];
    for (unsigned i = 0; i <= UINT8_MAX; i++) {
        text[i] = (uint8_t)(UINT8_MAX - i);
    }

    (void)store_save(&store, 3, text, sizeof text);

    restart();
    TEST_ASSERT_EQUAL_UINT32(sizeof text, store_load(&store, 3, loaded));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(text, loaded, sizeof text);
}

void test_what_is_stored_already_is_not_written_again(void)
{
    (void)save(0, "F1000R");
    uint32_t operations = machine.flash_operations;

    TEST_ASSERT_EQUAL_INT(STORE_OK, save(0, "F1000R"));

    TEST_ASSERT_EQUAL_UINT32(operations, machine.flash_operations);
}

TEST_CASE("F1000")
TEST_CASE("F1000R ")
TEST_CASE("F1000X")
TEST_CASE("")
void test_a_text_that_differs_is_written(const char *text)
{
    (void)save(0, "F1000R");

    TEST_ASSERT_EQUAL_INT(STORE_OK, save(0, text));

    assert_text(0, text);
}

void test_a_text_that_was_stored_before_the_last_one_is_written_again(void)
{
    (void)save(0, "one");
    (void)save(0, "two");
    (void)save(0, "one");

    restart();

    assert_text(0, "one");
}

void test_the_same_text_on_another_motor_is_written(void)
{
    (void)save(0, "one");
    (void)save(1, "one");

    restart();

    assert_text(1, "one");
}

void test_every_store_has_a_generation_of_its_own(void)
{
    (void)save(0, "one");
    uint32_t generation = store.generation;

    (void)save(1, "two");

    TEST_ASSERT_EQUAL_UINT32(generation + 1, store.generation);
}

void test_a_restart_finds_what_the_store_knew(void)
{
    (void)save(0, "zero");
    (void)save(3, "three");
    (void)save(0, "again");
    struct store before = store;

    restart();

    TEST_ASSERT_EQUAL_UINT32(before.generation, store.generation);
    TEST_ASSERT_EQUAL_UINT32(before.end, store.end);
    TEST_ASSERT_EQUAL_UINT32_ARRAY(before.image, store.image, STORE_SLOTS);
    TEST_ASSERT_EQUAL_UINT8(before.area, store.area);
    TEST_ASSERT_TRUE(store.usable);
}

void test_an_area_takes_fifteen_of_the_longest_texts(void)
{
    (void)save_longest(0);
    unsigned area = store.area;
    for (unsigned i = 1; i < LONGEST_RECORDS; i++) {
        TEST_ASSERT_EQUAL_INT(STORE_OK, save_longest(0));
    }
    TEST_ASSERT_EQUAL_UINT8(area, store.area);

    TEST_ASSERT_EQUAL_INT(STORE_OK, save_longest(0));

    TEST_ASSERT_NOT_EQUAL(area, store.area);
    TEST_ASSERT_EQUAL_UINT32(sizeof longest, store_load(&store, 0, loaded));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(longest, loaded, sizeof longest);
}

void test_the_rotation_takes_eleven_of_the_longest_texts_beside_four_copies(void)
{
    unsigned stores = 0;
    for (unsigned slot = 0; slot < STORE_SLOTS; slot++) {
        (void)save_longest(slot);
    }
    store.end = HAL_FLASH_AREA_BYTES;
    (void)save_longest(0);
    for (unsigned area = store.area; store.area == area; stores++) {
        TEST_ASSERT_LESS_THAN_UINT(LONGEST_RECORDS, stores);
        TEST_ASSERT_EQUAL_INT(STORE_OK, save_longest(1));
    }

    TEST_ASSERT_EQUAL_UINT(LONGEST_RECORDS - STORE_SLOTS, stores);
}

void test_all_motors_keep_their_texts_when_the_area_changes(void)
{
    (void)save(1, "one");
    (void)save(2, "");
    (void)save(3, "three");
    for (unsigned i = 0; i < 3 * LONGEST_RECORDS; i++) {
        TEST_ASSERT_EQUAL_INT(STORE_OK, save_longest(0));
    }
    (void)save(0, "zero");

    restart();

    assert_text(0, "zero");
    assert_text(1, "one");
    assert_text(2, "");
    assert_text(3, "three");
}

static void fill_all_but(uint32_t room_bytes)
{
    while (HAL_FLASH_AREA_BYTES - store.end >= RECORD_EXTRA_BYTES + sizeof longest + room_bytes) {
        uint32_t end = store.end;
        (void)save_longest(0);
        TEST_ASSERT_GREATER_THAN_UINT32_MESSAGE(end, store.end, "a text was stored and takes no room");
    }
    uint32_t length = HAL_FLASH_AREA_BYTES - store.end - room_bytes - RECORD_EXTRA_BYTES;
    (void)store_save(&store, 0, longest, length);
    TEST_ASSERT_EQUAL_UINT32(HAL_FLASH_AREA_BYTES - room_bytes, store.end);
}

void test_an_area_is_filled_to_its_last_byte(void)
{
    (void)save(1, "one");
    unsigned area = store.area;
    fill_all_but(RECORD_EXTRA_BYTES + 8);

    TEST_ASSERT_EQUAL_INT(STORE_OK, save(1, "8 bytes!"));

    TEST_ASSERT_EQUAL_UINT8(area, store.area);
    restart();
    TEST_ASSERT_EQUAL_UINT32(HAL_FLASH_AREA_BYTES, store.end);
    assert_text(1, "8 bytes!");
}

void test_a_text_one_byte_longer_than_the_room_goes_to_the_other_area(void)
{
    (void)save(1, "one");
    unsigned area = store.area;
    fill_all_but(RECORD_EXTRA_BYTES + 8);

    TEST_ASSERT_EQUAL_INT(STORE_OK, save(1, "nine byte"));

    TEST_ASSERT_NOT_EQUAL(area, store.area);
    restart();
    assert_text(1, "nine byte");
}

void test_a_rest_of_an_area_that_is_too_small_for_any_record_is_left(void)
{
    (void)save(1, "one");
    fill_all_but(RECORD_EXTRA_BYTES - 4);

    restart();

    TEST_ASSERT_EQUAL_UINT32(HAL_FLASH_AREA_BYTES - RECORD_EXTRA_BYTES + 4, store.end);
    assert_text(1, "one");
}

void test_an_area_is_erased_when_it_is_used_again_and_not_before(void)
{
    (void)save(0, "first");
    unsigned first = store.area;
    store.end = HAL_FLASH_AREA_BYTES;
    (void)save(0, "second");
    TEST_ASSERT_EQUAL_HEX8('R', machine.flash[first][0]); /* the magic of a record */
    machine.flash[first][HAL_FLASH_AREA_BYTES - 1] = 0;
    store.end = HAL_FLASH_AREA_BYTES;

    TEST_ASSERT_EQUAL_INT(STORE_OK, save(0, "third"));

    TEST_ASSERT_EQUAL_UINT8(first, store.area);
    TEST_ASSERT_EQUAL_HEX8(0xFF, machine.flash[first][HAL_FLASH_AREA_BYTES - 1]);
}
