/*
 * Settings that are written over the line and stored, with the power cut, a write that fails, or a wrong bit at every
 * place: after the next start all of them are the old ones or all are the new ones; what is damaged is never used.
 *
 * RKM04_LONG=1 also cuts the power a second time, at every operation of the store that follows the first cut.
 */
#include "pos_wire.h"

enum {
    DONE_KINDS = HOST_FLASH_ALL + 1,
    STORE = 40,
    UNIT_SETTINGS = 30,
    AXIS_SETTINGS = 30,
    AXIS_WORDS = 26,
    BITS = 8,
    ERASED = 0xFF,
    DAMAGED = 2,
    OTHER = 4,
};

/* All settings as they are read. */
struct settings {
    uint16_t words[3 + 4 * AXIS_WORDS];
};

static uint8_t flash[HAL_FLASH_AREAS][HAL_FLASH_AREA_BYTES];
static bool area_is_full; /* the next store changes areas */
static unsigned points;

static void restart(void)
{
    host_machine_restart(&machine);
    rig_begin();
    rig_run_ms(20);
}

void setUp(void)
{
    rig_set_up();
    rig_run_ms(20);
    area_is_full = false;
    points = 0;
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, machine.flash_rewrites);
}

static void read_words(uint32_t first, uint32_t count, uint16_t *words)
{
    TEST_ASSERT_EQUAL_UINT(0, wire_read(MODBUS_READ, first, count));
    for (unsigned i = 0; i < count; i++) {
        words[i] = (uint16_t)rig_word(i);
    }
}

static struct settings read_settings(void)
{
    struct settings settings;
    read_words(UNIT_SETTINGS, 3, settings.words);
    for (uint32_t axis = 0; axis < (uint32_t)POS_AXES; axis++) {
        read_words(100U * (axis + 1U) + AXIS_SETTINGS, AXIS_WORDS, &settings.words[3 + axis * AXIS_WORDS]);
    }
    return settings;
}

static unsigned condition(void)
{
    TEST_ASSERT_EQUAL_UINT(0, wire_read(MODBUS_READ_INPUTS, 4, 1));
    return rig_word(0);
}

/* Settings of the unit and of every axis that tell one set of them from another, each in a request. */
static void write_settings(unsigned which)
{
    TEST_ASSERT_EQUAL_UINT(0, wire_write(MODBUS_WRITE_ONE, UNIT_SETTINGS, 1000U + which, false));
    for (unsigned axis = 1; axis <= (unsigned)POS_AXES; axis++) {
        struct wire_frame frame = {.bytes = {1, MODBUS_WRITE}, .length = 2};
        const uint32_t values[] = {0, 7U * axis + which, 0, 11U * axis + which, which % 2U, 100U * axis + which};
        wire_word(&frame, 100U * axis + AXIS_SETTINGS);
        wire_word(&frame, 6);
        frame.bytes[frame.length++] = 12;
        for (unsigned i = 0; i < 6; i++) {
            wire_word(&frame, values[i]);
        }
        TEST_ASSERT_EQUAL_UINT(0, wire_ask(&frame));
        TEST_ASSERT_EQUAL_UINT(0, wire_write(MODBUS_WRITE, 100U * axis + 54U, 77777U * axis + which, true));
    }
}

static unsigned store(void)
{
    return wire_write(MODBUS_WRITE_ONE, STORE, 1, false);
}

static void begin_with_stored(struct settings *old, struct settings *next)
{
    write_settings(20);
    *next = read_settings();
    write_settings(1);
    *old = read_settings();
    TEST_ASSERT_EQUAL_UINT(0, store());
    memcpy(flash, machine.flash, sizeof flash);
}

/* With the flash as it was kept, stores the next settings. True: it came as far as the operation. */
static bool store_next(uint32_t operation, unsigned done, bool cut, unsigned *exception)
{
    memcpy(machine.flash, flash, sizeof flash);
    restart();
    write_settings(20);
    unit.settings.store.end = area_is_full ? HAL_FLASH_AREA_BYTES : unit.settings.store.end;
    uint32_t at = machine.flash_operations + operation;
    *(cut ? &machine.faults.flash_cut_after : &machine.faults.flash_fail_at) = at;
    machine.faults.flash_done = (enum host_flash_done)done;
    *exception = store();
    return machine.flash_operations >= at;
}

static void assert_old_or_next(const struct settings *old, const struct settings *next)
{
    struct settings settings = read_settings();
    bool is_old = memcmp(&settings, old, sizeof settings) == 0;
    points++;
    TEST_ASSERT_TRUE_MESSAGE(is_old || memcmp(&settings, next, sizeof settings) == 0, "neither the old nor the new");
    TEST_ASSERT_EQUAL_HEX(0, condition());
}

static void cut_again(uint32_t first, const struct settings *old, const struct settings *next)
{
    static uint8_t at_start[HAL_FLASH_AREAS][HAL_FLASH_AREA_BYTES];
    unsigned exception = 0;
    memcpy(at_start, flash, sizeof at_start);
    store_next(first, first % (unsigned)DONE_KINDS, true, &exception);
    memcpy(flash, machine.flash, sizeof flash);
    for (uint32_t second = 1; store_next(second, second % (unsigned)DONE_KINDS, true, &exception); second++) {
        restart();
        assert_old_or_next(old, next);
    }
    memcpy(flash, at_start, sizeof flash);
}

static void sweep_cuts(void)
{
    struct settings old;
    struct settings next;
    unsigned exception = 0;
    begin_with_stored(&old, &next);
    for (unsigned done = 0; done < (unsigned)DONE_KINDS; done++) {
        for (uint32_t operation = 1; store_next(operation, done, true, &exception); operation++) {
            restart();
            assert_old_or_next(&old, &next);
            if (getenv("RKM04_LONG") != NULL && done == 0) {
                cut_again(operation, &old, &next);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(100, points);
}

void test_a_cut_at_every_operation_of_a_store_leaves_all_old_settings_or_all_new_ones(void)
{
    sweep_cuts();
    printf("power cuts of STORE: %u points\n", points);
}

void test_a_cut_while_the_area_changes_leaves_all_old_settings_or_all_new_ones(void)
{
    area_is_full = true;
    sweep_cuts();
    printf("power cuts of STORE with a change of areas: %u points\n", points);
}

/* The settings in force stay, too: only what is stored is the old. */
void test_a_write_that_fails_at_any_operation_is_exception_4_and_leaves_the_old_settings(void)
{
    struct settings old;
    struct settings next;
    unsigned exception = 0;
    begin_with_stored(&old, &next);
    for (unsigned done = 0; done < (unsigned)DONE_KINDS; done++) {
        for (uint32_t operation = 1; store_next(operation, done, false, &exception); operation++) {
            struct settings settings = read_settings();
            TEST_ASSERT_EQUAL_UINT(4, exception);
            TEST_ASSERT_EQUAL_MEMORY(&next, &settings, sizeof settings);
            TEST_ASSERT_EQUAL_HEX(OTHER, condition());
            restart();
            settings = read_settings();
            TEST_ASSERT_EQUAL_MEMORY(&old, &settings, sizeof settings);
            TEST_ASSERT_EQUAL_HEX(0, condition());
            write_settings(20);
            TEST_ASSERT_EQUAL_UINT(0, store());
            points++;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(100, points);
}

static uint32_t used_bytes(unsigned area)
{
    uint32_t used = HAL_FLASH_AREA_BYTES;
    while (used > 0 && flash[area][used - 1U] == (uint8_t)ERASED) {
        used--;
    }
    return used;
}

/* The delivered settings are in force then, and no axis moves before STORE. */
static void assert_damage_is_told(const struct settings *delivered)
{
    struct settings settings = read_settings();
    TEST_ASSERT_EQUAL_MEMORY(delivered, &settings, sizeof settings);
    TEST_ASSERT_EQUAL_HEX(DAMAGED | OTHER, condition());
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 10 00 64 00 05 0A 01 01 00 00 00 00 27 10 01 F4"));
    TEST_ASSERT_EQUAL_UINT(0, rig_ask("01 10 00 64 00 08 10 02 02 00 00 00 00 27 10 01 F4 00 01 03 E8 00 00"));
    TEST_ASSERT_EQUAL_UINT(POS_ERROR_SETTINGS, rig_values(1).error);
    TEST_ASSERT_EQUAL_UINT(0, rig_pulses[0]);
}

void test_a_wrong_bit_anywhere_in_what_is_stored_is_told_and_never_used(void)
{
    struct settings old;
    struct settings next;
    struct settings delivered = read_settings();
    unsigned damaged = 0;
    begin_with_stored(&old, &next);
    for (unsigned area = 0; area < (unsigned)HAL_FLASH_AREAS; area++) {
        for (uint32_t bit = 0; bit < used_bytes(area) * (uint32_t)BITS; bit++) {
            memcpy(machine.flash, flash, sizeof flash);
            machine.flash[area][bit / (uint32_t)BITS] ^= (uint8_t)(1U << (bit % (uint32_t)BITS));
            restart();
            if (unit.settings.damaged) {
                assert_damage_is_told(&delivered);
                damaged++;
            } else {
                struct settings settings = read_settings();
                TEST_ASSERT_EQUAL_MEMORY(&old, &settings, sizeof settings);
            }
        }
    }
    printf("wrong bits that are told: %u\n", damaged);
    TEST_ASSERT_GREATER_THAN_UINT(1000, damaged);
}
