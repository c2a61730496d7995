#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "epoch.h"
#include "host_machine.h"
#include "store.h"

enum {
    SEED = 20240607,
    FLASH_DONE_KINDS = HOST_FLASH_ALL + 1,
    SWEEP_OPERATIONS = 60, /* a longer store is cut at this many of its operations at each end, and at some between;
                              RKM04_LONG=1: at all of them */
    SWEEP_STRIDE = 397,
};

struct text {
    uint32_t length;
    uint8_t bytes[STORE_TEXT_BYTES_MAX];
};

static struct host_machine machine;
static uint8_t flash_before[HAL_FLASH_AREAS][HAL_FLASH_AREA_BYTES];
static struct store store;
static struct text known[STORE_SLOTS]; /* what must be there */
static struct text fresh;              /* what is being stored */
static uint8_t loaded[STORE_TEXT_BYTES_MAX];
static uint32_t random_state;
static bool area_is_full; /* the next store changes areas */
static unsigned old_seen;
static unsigned new_seen;
static unsigned points; /* power cuts of all tests so far */

static uint32_t random_below(uint32_t limit)
{
    random_state = random_state * UINT32_C(1664525) + UINT32_C(1013904223);
    return (uint32_t)(((uint64_t)random_state * limit) >> 32U);
}

static void make_text(struct text *text, uint32_t length)
{
    text->length = length;
    for (uint32_t i = 0; i < length; i++) {
        text->bytes[i] = (uint8_t)random_below(UINT8_MAX + 1);
    }
}

static void restart(void)
{
    host_machine_restart(&machine);
    host_machine_select(&machine);
    store_init(&store);
}

static bool is_there(unsigned slot, const struct text *text)
{
    return !store_is_damaged(&store, slot) && store_load(&store, slot, loaded) == text->length &&
           memcmp(loaded, text->bytes, text->length) == 0;
}

static void assert_all_known(void)
{
    for (unsigned slot = 0; slot < STORE_SLOTS; slot++) {
        TEST_ASSERT_TRUE(is_there(slot, &known[slot]));
    }
}

/* After a cut of storing `fresh`: its slot has the old text or the new one, the others theirs. */
static void assert_old_or_new(unsigned stored_slot)
{
    points++;
    for (unsigned slot = 0; slot < STORE_SLOTS; slot++) {
        if (slot != stored_slot || is_there(slot, &known[slot])) {
            old_seen += slot == stored_slot ? 1U : 0U;
            TEST_ASSERT_TRUE(is_there(slot, &known[slot]));
        } else {
            new_seen++;
            TEST_ASSERT_TRUE(is_there(slot, &fresh));
        }
    }
}

static enum store_error save_fresh(unsigned slot)
{
    return store_save(&store, slot, fresh.bytes, fresh.length);
}

static void save_known(unsigned slot, uint32_t length)
{
    make_text(&fresh, length);
    TEST_ASSERT_EQUAL_INT(STORE_OK, save_fresh(slot));
    known[slot] = fresh;
}

static void keep_flash(void)
{
    memcpy(flash_before, machine.flash, sizeof machine.flash);
}

static void restore_flash(void)
{
    memcpy(machine.flash, flash_before, sizeof machine.flash);
    restart();
    store.end = area_is_full ? HAL_FLASH_AREA_BYTES : store.end;
}

static uint32_t count_operations(unsigned slot)
{
    restore_flash();
    TEST_ASSERT_EQUAL_INT(STORE_OK, save_fresh(slot));
    uint32_t operations = machine.flash_operations;
    restore_flash();
    return operations;
}

static void cut_at(uint32_t operation, unsigned done)
{
    machine.faults.flash_cut_after = operation;
    machine.faults.flash_done = (enum host_flash_done)done;
}

/* The power fails a second time while the store looks for its images; the third time it comes up. */
static void cut_recovery(unsigned slot, uint32_t operations)
{
    static uint8_t flash[HAL_FLASH_AREAS][HAL_FLASH_AREA_BYTES];
    memcpy(flash, machine.flash, sizeof flash);
    for (uint32_t operation = 1; operation <= operations; operation++) {
        for (unsigned done = 0; done < FLASH_DONE_KINDS; done++) {
            memcpy(machine.flash, flash, sizeof flash);
            host_machine_restart(&machine);
            cut_at(operation, done);
            store_init(&store);
            restart();
            assert_old_or_new(slot);
        }
    }
    memcpy(machine.flash, flash, sizeof flash);
}

static void cut_save(unsigned slot, uint32_t operation, unsigned done)
{
    restore_flash();
    cut_at(operation, done);
    (void)save_fresh(slot);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(operation, machine.flash_operations);
    host_machine_restart(&machine);
    static uint8_t flash[HAL_FLASH_AREAS][HAL_FLASH_AREA_BYTES];
    memcpy(flash, machine.flash, sizeof flash);
    store_init(&store);
    uint32_t operations = machine.flash_operations;
    assert_old_or_new(slot);
    if (operations > 0) {
        memcpy(machine.flash, flash, sizeof flash);
        cut_recovery(slot, operations);
        restart();
    }
}

/* Cuts the store of `fresh` at each operation and in each way, and then does it. */
static void sweep(unsigned slot, bool full)
{
    area_is_full = full;
    keep_flash();
    uint32_t operations = count_operations(slot);
    bool all = getenv("RKM04_LONG") != NULL;
    for (uint32_t operation = 1; operation <= operations; operation++) {
        bool near_an_end = operation <= SWEEP_OPERATIONS || operation + SWEEP_OPERATIONS > operations;
        if (all || near_an_end || operation % SWEEP_STRIDE == 0) {
            for (unsigned done = 0; done < FLASH_DONE_KINDS; done++) {
                cut_save(slot, operation, done);
            }
        }
    }
    restore_flash();
    TEST_ASSERT_EQUAL_INT(STORE_OK, save_fresh(slot));
    known[slot] = fresh;
    area_is_full = false;
    restart();
    assert_all_known();
}

void setUp(void)
{
    random_state = SEED;
    memset(known, 0, sizeof known);
    area_is_full = false;
    old_seen = 0;
    new_seen = 0;
    host_machine_init(&machine, epoch_random());
    host_machine_select(&machine);
    store_init(&store);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, machine.flash_rewrites);
    printf("power cuts so far: %u points, 0 mixtures\n", points);
}

void test_a_cut_of_the_first_store_leaves_nothing_or_the_text(void)
{
    make_text(&fresh, 30);

    sweep(1, false);

    TEST_ASSERT_GREATER_THAN_UINT(0, old_seen);
    TEST_ASSERT_GREATER_THAN_UINT(0, new_seen);
}

void test_a_cut_at_any_operation_of_many_stores_leaves_the_old_text_or_the_new_one(void)
{
    for (unsigned i = 0; i < 80; i++) {
        make_text(&fresh, random_below(40));

        sweep(random_below(STORE_SLOTS), i % 5 == 0);

        save_known(random_below(STORE_SLOTS), random_below(200));
    }
    TEST_ASSERT_GREATER_THAN_UINT(0, old_seen);
    TEST_ASSERT_GREATER_THAN_UINT(0, new_seen);
}

void test_a_cut_of_a_store_of_the_longest_text_leaves_the_old_text_or_the_new_one(void)
{
    save_known(2, STORE_TEXT_BYTES_MAX);
    make_text(&fresh, STORE_TEXT_BYTES_MAX);

    sweep(2, false);
}

void test_a_cut_while_the_area_changes_leaves_the_old_text_or_the_new_one(void)
{
    for (unsigned slot = 0; slot < STORE_SLOTS; slot++) {
        save_known(slot, random_below(20));
    }
    for (unsigned i = 0; i < 4; i++) {
        unsigned area = store.area;
        while (store.area == area && HAL_FLASH_AREA_BYTES - store.end > STORE_TEXT_BYTES_MAX) {
            uint32_t end = store.end;
            save_known(0, STORE_TEXT_BYTES_MAX);
            TEST_ASSERT_GREATER_THAN_UINT32_MESSAGE(end, store.end, "a text was stored and takes no room");
        }
        save_known(0, 10);
        make_text(&fresh, STORE_TEXT_BYTES_MAX);

        sweep(i, false);

        TEST_ASSERT_NOT_EQUAL(area, store.area);
        save_known(i, 11);
    }
}

void test_a_cut_while_an_area_full_of_the_longest_texts_changes_leaves_the_old_text_or_the_new_one(void)
{
    for (unsigned i = 0; i < 15; i++) {
        save_known(i % STORE_SLOTS, STORE_TEXT_BYTES_MAX);
    }
    make_text(&fresh, STORE_TEXT_BYTES_MAX);
    unsigned area = store.area;

    sweep(3, false);

    TEST_ASSERT_NOT_EQUAL(area, store.area);
}

void test_after_a_cut_the_store_works_on(void)
{
    static struct text known_before[STORE_SLOTS];
    struct text interrupted;
    save_known(0, 9);
    make_text(&interrupted, 17);
    keep_flash();
    memcpy(known_before, known, sizeof known);
    fresh = interrupted;
    uint32_t operations = count_operations(1);
    for (uint32_t operation = 1; operation <= operations; operation++) {
        memcpy(known, known_before, sizeof known);
        fresh = interrupted;
        cut_save(1, operation, operation % FLASH_DONE_KINDS);

        for (unsigned slot = 0; slot < STORE_SLOTS; slot++) {
            save_known(slot, 5 + slot);
        }

        restart();
        assert_all_known();
    }
}

/* A store is cut, and the one that follows it is cut again: at every pair of operations. */
static void sweep_pairs(unsigned slot, bool full)
{
    static uint8_t flash_at_start[HAL_FLASH_AREAS][HAL_FLASH_AREA_BYTES];
    area_is_full = full;
    make_text(&fresh, 6);
    keep_flash();
    memcpy(flash_at_start, machine.flash, sizeof flash_at_start);
    for (uint32_t first = 1;; first++) {
        memcpy(flash_before, flash_at_start, sizeof flash_before);
        restore_flash();
        cut_at(first, first % FLASH_DONE_KINDS);
        (void)save_fresh(slot);
        bool cut = machine.flash_operations >= first;
        restart();
        keep_flash();
        for (uint32_t second = 1;; second++) {
            restore_flash();
            cut_at(second, second % FLASH_DONE_KINDS);
            (void)save_fresh(slot);
            bool cut_again = machine.flash_operations >= second;
            restart();
            assert_old_or_new(slot);
            if (!cut_again) {
                break;
            }
        }
        if (!cut) {
            break;
        }
    }
}

void test_two_stores_cut_one_after_the_other_leave_the_old_text_or_the_new_one(void)
{
    save_known(0, 7);
    save_known(3, 3);

    sweep_pairs(3, false);

    TEST_ASSERT_GREATER_THAN_UINT(0, old_seen);
    TEST_ASSERT_GREATER_THAN_UINT(0, new_seen);
}

void test_two_changes_of_the_area_cut_one_after_the_other_leave_the_old_text_or_the_new_one(void)
{
    save_known(0, 7);
    save_known(3, 3);
    store.end = HAL_FLASH_AREA_BYTES;
    save_known(2, 5);

    sweep_pairs(3, true);

    TEST_ASSERT_GREATER_THAN_UINT(0, old_seen);
    TEST_ASSERT_GREATER_THAN_UINT(0, new_seen);
}

void test_a_cut_between_the_last_two_steps_of_a_change_of_areas_is_completed(void)
{
    save_known(0, 8);
    unsigned area = store.area;
    keep_flash();
    make_text(&fresh, 4);
    store.end = HAL_FLASH_AREA_BYTES;
    TEST_ASSERT_EQUAL_INT(STORE_OK, save_fresh(1));
    uint32_t void_mark = 48 - 4;
    memset(&machine.flash[area][void_mark], 0xFF, 4);

    restart();

    TEST_ASSERT_NOT_EQUAL(area, store.area);
    TEST_ASSERT_EQUAL_UINT32(1, machine.flash_operations);
    TEST_ASSERT_EACH_EQUAL_HEX8(0, &machine.flash[area][void_mark], 4);
}
