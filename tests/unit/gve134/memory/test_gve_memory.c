#include "unity.h"

#include <stdio.h>
#include <string.h>

#include "epoch.h"
#include "gve_memory.h"
#include "host_machine.h"

enum {
    FLASH_DONE_KINDS = HOST_FLASH_ALL + 1,
    DELIVERED_BRAKE = 0x0A,
    PLACE = 0x10,
    RECORD_BYTES = 48 + 4 + GVE_MEMORY_BYTES, /* of the store */
};

#define OLD_WORD UINT32_C(0x11223344)
#define NEW_WORD UINT32_C(0x3FC00000)

static struct host_machine machine;
static uint8_t flash[HAL_FLASH_AREAS][HAL_FLASH_AREA_BYTES];
static struct gve_memory memory;

void setUp(void)
{
    host_machine_init(&machine, epoch_random());
    host_machine_select(&machine);
    gve_memory_init(&memory);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, machine.flash_rewrites);
}

static void restart(void)
{
    host_machine_restart(&machine);
    memset(&memory, 0xA5, sizeof memory);
    gve_memory_init(&memory);
}

static void assert_as_delivered_but_at(uint32_t begin, uint32_t end)
{
    for (uint32_t i = 0; i < GVE_MEMORY_BYTES; i++) {
        if (i < begin || i >= end) {
            uint8_t delivered = i == GVE_MEMORY_BRAKE ? DELIVERED_BRAKE : 0xFF;
            TEST_ASSERT_EQUAL_HEX8(i == GVE_MEMORY_RELAY ? 0x00 : delivered, memory.bytes[i]);
        }
    }
}

void test_a_new_unit_has_the_bytes_as_delivered(void)
{
    assert_as_delivered_but_at(0, 0);
    TEST_ASSERT_FALSE(memory.damaged);
    TEST_ASSERT_EQUAL_UINT32(0, machine.flash_operations);
}

void test_a_byte_is_there_at_once_and_after_a_restart(void)
{
    TEST_ASSERT_EQUAL_INT(STORE_OK, gve_memory_write_byte(&memory, GVE_MEMORY_RELAY, 0x09));
    TEST_ASSERT_EQUAL_HEX8(0x09, memory.bytes[GVE_MEMORY_RELAY]);

    restart();

    TEST_ASSERT_EQUAL_HEX8(0x09, memory.bytes[GVE_MEMORY_RELAY]);
    assert_as_delivered_but_at(GVE_MEMORY_RELAY, GVE_MEMORY_RELAY + 1);
    TEST_ASSERT_FALSE(memory.damaged);
}

void test_a_number_has_its_low_byte_first(void)
{
    TEST_ASSERT_EQUAL_INT(STORE_OK, gve_memory_write_word(&memory, PLACE, OLD_WORD));

    restart();

    TEST_ASSERT_EQUAL_HEX8_ARRAY("\x44\x33\x22\x11", &memory.bytes[PLACE], GVE_MEMORY_WORD_BYTES);
    TEST_ASSERT_EQUAL_HEX32(OLD_WORD, gve_memory_word(&memory, PLACE));
    TEST_ASSERT_EQUAL_HEX32(0xFF112233, gve_memory_word(&memory, PLACE + 1));
    assert_as_delivered_but_at(PLACE, PLACE + GVE_MEMORY_WORD_BYTES);
}

void test_the_first_and_the_last_bytes_can_be_written(void)
{
    TEST_ASSERT_EQUAL_INT(STORE_OK, gve_memory_write_byte(&memory, 0, 1));
    TEST_ASSERT_EQUAL_INT(STORE_OK, gve_memory_write_byte(&memory, GVE_MEMORY_BYTES - 1, 2));
    restart();
    TEST_ASSERT_EQUAL_HEX8(1, memory.bytes[0]);
    TEST_ASSERT_EQUAL_HEX8(2, memory.bytes[GVE_MEMORY_BYTES - 1]);
    TEST_ASSERT_EQUAL_INT(STORE_OK, gve_memory_write_word(&memory, GVE_MEMORY_BYTES - GVE_MEMORY_WORD_BYTES, 3));
    restart();
    TEST_ASSERT_EQUAL_HEX32(3, gve_memory_word(&memory, GVE_MEMORY_BYTES - GVE_MEMORY_WORD_BYTES));
}

void test_writing_what_is_there_writes_nothing(void)
{
    TEST_ASSERT_EQUAL_INT(STORE_OK, gve_memory_write_byte(&memory, PLACE, 0xFF));
    TEST_ASSERT_EQUAL_UINT32(0, machine.flash_operations);
    TEST_ASSERT_EQUAL_INT(STORE_OK, gve_memory_write_word(&memory, PLACE, OLD_WORD));
    uint32_t operations = machine.flash_operations;
    TEST_ASSERT_EQUAL_INT(STORE_OK, gve_memory_write_word(&memory, PLACE, OLD_WORD));
    TEST_ASSERT_EQUAL_UINT32(operations, machine.flash_operations);
}

/* Cuts the write of a number over another one at every operation and in every way. Returns how many there were. */
static uint32_t cut_everywhere(void)
{
    unsigned seen[2] = {0, 0};
    memcpy(flash, machine.flash, sizeof flash);
    restart();
    TEST_ASSERT_EQUAL_INT(STORE_OK, gve_memory_write_word(&memory, PLACE, NEW_WORD));
    uint32_t operations = machine.flash_operations;
    for (uint32_t operation = 1; operation <= operations; operation++) {
        for (unsigned done = 0; done < FLASH_DONE_KINDS; done++) {
            memcpy(machine.flash, flash, sizeof flash);
            restart();
            machine.faults.flash_cut_after = operation;
            machine.faults.flash_done = (enum host_flash_done)done;
            (void)gve_memory_write_word(&memory, PLACE, NEW_WORD);
            restart();
            uint32_t word = gve_memory_word(&memory, PLACE);
            TEST_ASSERT_TRUE(word == OLD_WORD || word == NEW_WORD);
            TEST_ASSERT_FALSE(memory.damaged);
            assert_as_delivered_but_at(PLACE, PLACE + GVE_MEMORY_WORD_BYTES);
            seen[word == NEW_WORD ? 1 : 0]++;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(0, seen[0]);
    TEST_ASSERT_GREATER_THAN_UINT(0, seen[1]);
    return operations;
}

void test_a_power_cut_at_any_operation_of_a_write_leaves_all_old_or_all_new(void)
{
    (void)gve_memory_write_word(&memory, PLACE, OLD_WORD);
    (void)printf("power cuts: %u operations\n", cut_everywhere());
}

void test_a_power_cut_at_any_operation_of_a_change_of_areas_leaves_all_old_or_all_new(void)
{
    for (uint32_t word = 0; HAL_FLASH_AREA_BYTES - memory.store.end >= 2 * RECORD_BYTES; word++) {
        TEST_ASSERT_EQUAL_INT(STORE_OK, gve_memory_write_word(&memory, PLACE, word));
    }
    TEST_ASSERT_EQUAL_INT(STORE_OK, gve_memory_write_word(&memory, PLACE, OLD_WORD));
    unsigned area = memory.store.area;

    uint32_t operations = cut_everywhere();

    TEST_ASSERT_NOT_EQUAL_UINT(area, memory.store.area);
    (void)printf("power cuts: %u operations\n", operations);
}

void test_a_write_that_fails_changes_nothing_and_the_next_one_succeeds(void)
{
    (void)gve_memory_write_word(&memory, PLACE, OLD_WORD);
    machine.faults.flash_fail_at = machine.flash_operations + 3;
    machine.faults.flash_done = HOST_FLASH_FIRST_HALF;

    TEST_ASSERT_EQUAL_INT(STORE_WRITE_FAILED, gve_memory_write_word(&memory, PLACE, NEW_WORD));
    TEST_ASSERT_EQUAL_HEX32(OLD_WORD, gve_memory_word(&memory, PLACE));

    TEST_ASSERT_EQUAL_INT(STORE_OK, gve_memory_write_word(&memory, PLACE, NEW_WORD));
    restart();
    TEST_ASSERT_EQUAL_HEX32(NEW_WORD, gve_memory_word(&memory, PLACE));
}

static void assert_damaged_until_the_next_write(void)
{
    TEST_ASSERT_TRUE(memory.damaged);
    assert_as_delivered_but_at(0, 0);
    TEST_ASSERT_EQUAL_INT(STORE_OK, gve_memory_write_byte(&memory, PLACE, 0x77));
    TEST_ASSERT_FALSE(memory.damaged);
    restart();
    TEST_ASSERT_FALSE(memory.damaged);
    assert_as_delivered_but_at(PLACE, PLACE + 1);
}

void test_a_bit_that_has_changed_makes_the_bytes_those_delivered_and_is_told(void)
{
    (void)gve_memory_write_byte(&memory, PLACE, 0x55);
    machine.flash[memory.store.area][memory.store.end - 20] ^= 0x10;
    restart();
    assert_damaged_until_the_next_write();
}

void test_what_an_earlier_image_has_stored_is_read(void)
{
    static const uint8_t mark[] = {'G', 'V', 'E', 1};
    uint8_t text[sizeof mark + GVE_MEMORY_BYTES];
    memcpy(text, mark, sizeof mark);
    for (unsigned i = 0; i < GVE_MEMORY_BYTES; i++) {
        text[sizeof mark + i] = (uint8_t)(i * 7U);
    }
    TEST_ASSERT_EQUAL_INT(STORE_OK, store_save(&memory.store, GVE_MEMORY_SLOT, text, sizeof text));

    restart();

    TEST_ASSERT_EQUAL_HEX8_ARRAY(&text[sizeof mark], memory.bytes, GVE_MEMORY_BYTES);
    TEST_ASSERT_FALSE(memory.damaged);
}

void test_a_text_of_another_length_or_without_the_mark_is_damage(void)
{
    static uint8_t other[STORE_TEXT_BYTES_MAX];
    memset(other, 'R', sizeof other);
    static const uint32_t lengths[] = {1, GVE_MEMORY_BYTES, GVE_MEMORY_BYTES + 4, STORE_TEXT_BYTES_MAX};
    for (unsigned i = 0; i < sizeof lengths / sizeof lengths[0]; i++) {
        setUp();
        TEST_ASSERT_EQUAL_INT(STORE_OK, store_save(&memory.store, GVE_MEMORY_SLOT, other, lengths[i]));
        restart();
        assert_damaged_until_the_next_write();
    }
}

void test_a_part_without_the_memory_tells_damage_and_refuses_writes(void)
{
    machine.faults.no_flash = true;
    gve_memory_init(&memory);
    TEST_ASSERT_TRUE(memory.damaged);
    assert_as_delivered_but_at(0, 0);
    TEST_ASSERT_EQUAL_INT(STORE_WRITE_FAILED, gve_memory_write_byte(&memory, PLACE, 1));
    assert_as_delivered_but_at(0, 0);
}
