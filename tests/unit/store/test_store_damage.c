#include "unity.h"

#include <string.h>

#include "base_crc32.h"
#include "epoch.h"
#include "hal_flash.h"
#include "host_machine.h"
#include "store.h"
#include "store_record.h"

enum {
    SEED = 20240608,
    BITS = 8,
    HEADS_BYTES = 2 * STORE_HEAD_BYTES,
    LONGEST_RECORD_BYTES = STORE_RECORD_EXTRA_BYTES + STORE_TEXT_BYTES_MAX,
    LONGEST_RECORDS = (HAL_FLASH_AREA_BYTES - STORE_RECORD_EXTRA_BYTES) / LONGEST_RECORD_BYTES,
};

static const char *const texts[STORE_SLOTS] = {
    "S100V1000A2000@01F1000RW500DRW1000J01",
    "B2000R",
    "L3F500RW200DRW1000E",
    "",
};

static struct host_machine machine;
static struct store store;
static uint8_t loaded[STORE_TEXT_BYTES_MAX];
static uint32_t random_state;

static uint32_t random_below(uint32_t limit)
{
    random_state = random_state * UINT32_C(1664525) + UINT32_C(1013904223);
    return (uint32_t)(((uint64_t)random_state * limit) >> 32U);
}

static enum store_error save(unsigned slot, const char *text)
{
    return store_save(&store, slot, (const uint8_t *)text, (uint32_t)strlen(text));
}

static bool is_there(unsigned slot, const char *text)
{
    uint32_t length = store_load(&store, slot, loaded);
    return !store_is_damaged(&store, slot) && length == strlen(text) && memcmp(loaded, text, length) == 0;
}

static void restart(void)
{
    host_machine_restart(&machine);
    store_init(&store);
}

/* Old texts, then the ones that count; the other area has old texts too. */
static void save_all(void)
{
    for (unsigned slot = 0; slot < STORE_SLOTS; slot++) {
        (void)save(slot, "OLD");
    }
    store.end = HAL_FLASH_AREA_BYTES;
    for (unsigned slot = 0; slot < STORE_SLOTS; slot++) {
        (void)save(slot, "OLDER");
        (void)save(slot, texts[slot]);
    }
}

/* Motors that are damaged; all others must have their text. */
static unsigned count_damaged(void)
{
    unsigned damaged = 0;
    for (unsigned slot = 0; slot < STORE_SLOTS; slot++) {
        if (store_is_damaged(&store, slot)) {
            damaged++;
            TEST_ASSERT_EQUAL_UINT32(0, store_load(&store, slot, loaded));
        } else {
            TEST_ASSERT_TRUE(is_there(slot, texts[slot]));
        }
    }
    return damaged;
}

static void flip(unsigned area, uint32_t bit)
{
    machine.flash[area][bit / BITS] ^= (uint8_t)(1U << (bit % BITS));
}

/* Makes both heads of a record unreadable. */
static void break_heads(unsigned area, uint32_t offset)
{
    machine.flash[area][offset + 5] ^= 1U;
    machine.flash[area][offset + STORE_HEAD_BYTES + 5] ^= 1U;
}

static void break_text(unsigned slot)
{
    machine.flash[store.area][store.image[slot] + HEADS_BYTES] ^= 1U;
}

static void put_number(uint8_t *bytes, unsigned count, uint32_t number)
{
    for (unsigned i = 0; i < count; i++) {
        bytes[i] = (uint8_t)(number >> (BITS * i));
    }
}

/* A head whose CRC is right, whatever its fields. */
static void forge_head(unsigned area, uint32_t offset, uint32_t length, unsigned slot)
{
    uint8_t *head = &machine.flash[area][offset];
    memcpy(head, "RK4\1", 4);
    put_number(&head[4], 4, 1);
    put_number(&head[8], 2, length);
    put_number(&head[10], 2, slot);
    put_number(&head[12], 4, 0);
    put_number(&head[16], 4, crc32_append(0, head, 16));
    memcpy(&head[STORE_HEAD_BYTES], head, STORE_HEAD_BYTES);
}

void setUp(void)
{
    random_state = SEED;
    host_machine_init(&machine, epoch_random());
    host_machine_select(&machine);
    store_init(&store);
}

void tearDown(void)
{
}

void test_one_wrong_bit_in_the_present_area_damages_at_most_its_motor(void)
{
    unsigned damaged = 0;
    save_all();
    uint32_t bits = (store.end + STORE_RECORD_EXTRA_BYTES) * BITS;
    unsigned area = store.area;
    for (uint32_t bit = 0; bit < bits; bit++) {
        flip(area, bit);
        store_init(&store);
        unsigned count = count_damaged();
        TEST_ASSERT_LESS_OR_EQUAL_UINT(1, count);
        damaged += count;
        flip(area, bit);
    }
    TEST_ASSERT_EQUAL_UINT(BITS * (strlen(texts[0]) + strlen(texts[1]) + strlen(texts[2])), damaged);
}

void test_one_wrong_bit_in_the_other_area_changes_nothing(void)
{
    save_all();
    unsigned other = 1U - store.area;
    for (uint32_t bit = 0; bit < 8 * STORE_RECORD_EXTRA_BYTES * BITS; bit++) {
        flip(other, bit);
        store_init(&store);
        TEST_ASSERT_EQUAL_UINT(0, count_damaged());
        flip(other, bit);
    }
}

void test_a_wrong_bit_in_free_space_does_not_keep_a_text_from_being_stored(void)
{
    save_all();
    for (uint32_t bit = store.end * BITS; bit < (store.end + 64) * BITS; bit++) {
        struct host_machine before = machine;
        flip(store.area, bit);
        store_init(&store);
        TEST_ASSERT_EQUAL_INT(STORE_OK, save(1, "NEW"));
        restart();
        TEST_ASSERT_TRUE(is_there(1, "NEW"));
        machine = before;
    }
}

void test_many_wrong_bits_never_bring_a_wrong_text(void)
{
    save_all();
    static uint8_t flash[HAL_FLASH_AREAS][HAL_FLASH_AREA_BYTES];
    memcpy(flash, machine.flash, sizeof flash);
    uint32_t end = store.end;
    for (unsigned i = 0; i < 4000; i++) {
        for (uint32_t flips = 2 + random_below(6); flips > 0; flips--) {
            flip(random_below(HAL_FLASH_AREAS), random_below(end * BITS));
        }
        store_init(&store);
        (void)count_damaged();
        memcpy(machine.flash, flash, sizeof flash);
    }
}

void test_garbage_holds_no_text_and_can_be_stored_to(void)
{
    for (unsigned i = 0; i < 20; i++) {
        for (uint32_t byte = 0; byte < HAL_FLASH_AREA_BYTES; byte++) {
            machine.flash[0][byte] = (uint8_t)random_below(UINT8_MAX + 1);
            machine.flash[1][byte] = (uint8_t)random_below(UINT8_MAX + 1);
        }
        restart();
        for (unsigned slot = 0; slot < STORE_SLOTS; slot++) {
            TEST_ASSERT_EQUAL_UINT32(0, store_load(&store, slot, loaded));
        }

        for (unsigned slot = 0; slot < STORE_SLOTS; slot++) {
            TEST_ASSERT_EQUAL_INT(STORE_OK, save(slot, texts[slot]));
        }

        restart();
        TEST_ASSERT_EQUAL_UINT(0, count_damaged());
    }
}

void test_flash_full_of_zeros_holds_no_text_and_can_be_stored_to(void)
{
    memset(machine.flash, 0, sizeof machine.flash);
    restart();
    TEST_ASSERT_EQUAL_UINT32(0, store_load(&store, 0, loaded));

    TEST_ASSERT_EQUAL_INT(STORE_OK, save(0, texts[0]));

    restart();
    TEST_ASSERT_TRUE(is_there(0, texts[0]));
}

void test_an_older_text_never_takes_the_place_of_a_damaged_one(void)
{
    (void)save(2, "OLD");
    (void)save(2, "NEW");
    break_text(2);

    restart();

    TEST_ASSERT_TRUE(store_is_damaged(&store, 2));
    TEST_ASSERT_EQUAL_UINT32(0, store_load(&store, 2, loaded));
}

void test_a_damaged_text_that_has_been_replaced_does_not_matter(void)
{
    (void)save(2, "OLD");
    break_text(2);
    (void)save(2, "NEW");

    restart();

    TEST_ASSERT_TRUE(is_there(2, "NEW"));
}

void test_a_text_that_is_damaged_later_is_not_loaded(void)
{
    (void)save(2, "F1000R");

    break_text(2);

    TEST_ASSERT_EQUAL_UINT32(0, store_load(&store, 2, loaded));
}

void test_a_text_whose_heads_are_damaged_later_is_not_loaded(void)
{
    (void)save(2, "F1000R");

    break_heads(store.area, store.image[2]);

    TEST_ASSERT_EQUAL_UINT32(0, store_load(&store, 2, loaded));
}

void test_storing_a_text_over_its_damaged_copy_writes_it_again(void)
{
    (void)save(2, "F1000R");
    break_text(2);

    TEST_ASSERT_EQUAL_INT(STORE_OK, save(2, "F1000R"));

    restart();
    TEST_ASSERT_TRUE(is_there(2, "F1000R"));
}

void test_storing_ends_the_damage_of_its_motor_only(void)
{
    save_all();
    break_text(0);
    break_text(1);
    restart();

    TEST_ASSERT_EQUAL_INT(STORE_OK, save(0, texts[0]));

    TEST_ASSERT_FALSE(store_is_damaged(&store, 0));
    restart();
    TEST_ASSERT_TRUE(is_there(0, texts[0]));
    TEST_ASSERT_TRUE(store_is_damaged(&store, 1));
}

void test_damage_is_remembered_when_the_area_changes(void)
{
    save_all();
    break_text(0);
    restart();
    break_text(1);
    store.end = HAL_FLASH_AREA_BYTES;

    TEST_ASSERT_EQUAL_INT(STORE_OK, save(2, "NEW"));

    restart();
    TEST_ASSERT_TRUE(store_is_damaged(&store, 0));
    TEST_ASSERT_TRUE(store_is_damaged(&store, 1));
    TEST_ASSERT_TRUE(is_there(2, "NEW"));
    TEST_ASSERT_TRUE(is_there(3, texts[3]));
}

void test_a_record_without_readable_heads_damages_all_motors(void)
{
    save_all();
    break_heads(store.area, store.image[1]);

    restart();

    TEST_ASSERT_EQUAL_UINT(STORE_SLOTS, count_damaged());
}

void test_after_a_record_without_readable_heads_texts_can_be_stored(void)
{
    save_all();
    break_heads(store.area, store.image[1]);
    restart();

    TEST_ASSERT_EQUAL_INT(STORE_OK, save(3, "NEW"));

    restart();
    TEST_ASSERT_TRUE(is_there(3, "NEW"));
    TEST_ASSERT_TRUE(store_is_damaged(&store, 0));
    TEST_ASSERT_TRUE(store_is_damaged(&store, 1));
    TEST_ASSERT_TRUE(store_is_damaged(&store, 2));
}

void test_the_texts_of_an_area_that_is_void_are_never_taken(void)
{
    save_all();
    break_heads(store.area, 0);

    restart();

    TEST_ASSERT_EQUAL_UINT(STORE_SLOTS, count_damaged());
}

void test_an_area_that_is_void_tells_that_texts_have_been_lost(void)
{
    save_all();
    memset(machine.flash[store.area], 0xFF, HAL_FLASH_AREA_BYTES);

    restart();

    TEST_ASSERT_EQUAL_UINT(STORE_SLOTS, count_damaged());
}

void test_an_area_whose_begin_is_unreadable_damages_all_motors(void)
{
    (void)save(0, texts[0]);
    break_heads(store.area, 0);

    restart();

    TEST_ASSERT_EQUAL_UINT(STORE_SLOTS, count_damaged());
}

/* With the present area in either place. */
TEST_CASE(0)
TEST_CASE(1)
void test_a_cut_store_after_all_was_lost_brings_no_old_text_back(int moves)
{
    save_all();
    for (int i = 0; i < moves; i++) {
        store.end = HAL_FLASH_AREA_BYTES;
        (void)save(0, "MOVED");
    }
    break_heads(store.area, 0);
    static struct host_machine before;
    before = machine;
    for (uint32_t operation = 1, operations = 1; operation <= operations; operation++) {
        machine = before;
        restart();
        machine.faults.flash_cut_after = operation;
        (void)save(1, "NEW");
        operations = machine.flash_operations;
        restart();
        TEST_ASSERT_TRUE(is_there(1, "NEW") || store_is_damaged(&store, 1));
        TEST_ASSERT_TRUE(store_is_damaged(&store, 0));
        TEST_ASSERT_EQUAL_UINT32(0, store_load(&store, 0, loaded));
    }
}

/* Heads that are right in themselves but cannot be ours. */
TEST_CASE(STORE_TEXT_BYTES_MAX, 0, STORE_RECORD_UNFINISHED)
TEST_CASE(STORE_TEXT_BYTES_MAX + 1, 0, STORE_RECORD_LOST)
TEST_CASE(0, STORE_SLOTS - 1, STORE_RECORD_UNFINISHED)
TEST_CASE(0, STORE_SLOTS, STORE_RECORD_LOST)
void test_a_head_is_readable_within_its_limits(int length, int slot, int state)
{
    forge_head(0, STORE_RECORD_EXTRA_BYTES, (uint32_t)length, (unsigned)slot);

    TEST_ASSERT_EQUAL_INT(state, store_record_read(0, STORE_RECORD_EXTRA_BYTES).state);
}

TEST_CASE(0, STORE_RECORD_UNFINISHED)
TEST_CASE(4, STORE_RECORD_UNFINISHED)
TEST_CASE(5, STORE_RECORD_LOST)
void test_a_record_must_end_inside_its_area(int length, int state)
{
    uint32_t offset = HAL_FLASH_AREA_BYTES - STORE_RECORD_EXTRA_BYTES - 4;
    forge_head(1, offset, (uint32_t)length, 0);

    TEST_ASSERT_EQUAL_INT(state, store_record_read(1, offset).state);
}

void test_a_log_of_unfinished_records_ends_where_nothing_fits_any_more(void)
{
    (void)save(0, "");
    for (unsigned i = 0; i < LONGEST_RECORDS; i++) {
        forge_head(store.area, STORE_RECORD_EXTRA_BYTES + i * LONGEST_RECORD_BYTES, STORE_TEXT_BYTES_MAX, 0);
    }

    restart();

    TEST_ASSERT_EQUAL_UINT32(STORE_RECORD_EXTRA_BYTES + LONGEST_RECORDS * LONGEST_RECORD_BYTES, store.end);
    TEST_ASSERT_EQUAL_UINT32(0, store_load(&store, 0, loaded));
}

TEST_CASE(0x00000000, STORE_RECORD_FINISHED)
TEST_CASE(0x00000001, STORE_RECORD_FINISHED)
TEST_CASE(0x80200401, STORE_RECORD_FINISHED)
TEST_CASE(0x80200403, STORE_RECORD_UNFINISHED)
TEST_CASE(0x0000FFFF, STORE_RECORD_UNFINISHED)
TEST_CASE(0xFFFF0000, STORE_RECORD_UNFINISHED)
TEST_CASE(0xFFFFFFFE, STORE_RECORD_UNFINISHED)
TEST_CASE(0xFFFFFFFF, STORE_RECORD_UNFINISHED)
void test_a_mark_counts_with_four_wrong_bits_and_not_with_five(uint32_t mark, int state)
{
    (void)save(0, "");
    put_number(&machine.flash[store.area][store.image[0] + HEADS_BYTES], STORE_MARK_BYTES, mark);

    TEST_ASSERT_EQUAL_INT(state, store_record_read(store.area, store.image[0]).state);
}
