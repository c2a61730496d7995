/*
 * Stored programs of a whole unit, damaged and cut off at every place: after the next power-on each motor runs its old
 * program or its new one, or shows that it is damaged; none runs anything else, and the unit answers.
 *
 * RKM04_LONG=1 also cuts the power a second time, at every operation of the store that follows the first cut.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"
#include "unity.h"

enum {
    BITS = 8,
    ERASED = 0xFF,
    DONE_KINDS = HOST_FLASH_ALL + 1,
    RUN_MS = 5
};

static struct bench bench;
static uint8_t flash[HAL_FLASH_AREAS][HAL_FLASH_AREA_BYTES];
static unsigned points;
static bool area_is_full; /* the next store changes areas */

/* What each motor does when it runs, told by outputs: motor m sets output m, the new program of motor 2 output 8. */
static const char *const old_texts[UNIT_MOTORS + 1] = {"", "T01", "T02", "T03W1", "T04S200F1"};
static const char new_text[] = "T08W2";

enum {
    OLD_OUTPUT = 1U << 1U,
    NEW_OUTPUT = 1U << 7U,
    OTHERS = 0x0D
};

void setUp(void)
{
    bench_init(&bench);
    points = 0;
    area_is_full = false;
}

void tearDown(void)
{
    bench_check(&bench);
    TEST_ASSERT_EQUAL_UINT32(0, bench.machine.flash_rewrites);
}

static void store_program(unsigned motor)
{
    (void)bench_ask(&bench, MESSAGES_STORE_FLASH, motor);
    TEST_ASSERT_EQUAL_UINT32(3, bench.answer_length);
}

static void send_program(unsigned motor, const char *text)
{
    bench_send(&bench, motor, "\\");
    bench_do(&bench, motor, text);
}

static void store_old(void)
{
    for (unsigned motor = 1; motor <= UNIT_MOTORS; motor++) {
        send_program(motor, old_texts[motor]);
        store_program(motor);
    }
}

static void keep_flash(void)
{
    memcpy(flash, bench.machine.flash, sizeof flash);
}

/* Power off and on with the flash as it is; all that was recorded is forgotten. */
static void restart(void)
{
    bench.event_count = 0;
    bench.edge_count = 0;
    bench.pulse_count = 0;
    memset(bench.made, 0, sizeof bench.made);
    bench_restart(&bench);
    bench_run_ms(&bench, RUN_MS);
}

static void restart_with_kept_flash(void)
{
    memcpy(bench.machine.flash, flash, sizeof flash);
    restart();
}

/* A motor runs its own program and shows nothing; or it is damaged, shows it and does nothing. Tells whether it is. */
static bool is_damaged(unsigned motor)
{
    bool damaged = bench_count(&bench, motor, HAL_TRACE_ERROR) != 0;
    TEST_ASSERT_EQUAL_UINT(damaged ? 0 : 1, bench_output(&bench, motor));
    TEST_ASSERT_EQUAL_STRING(damaged ? "" : old_texts[motor], bench_ask(&bench, MESSAGES_GET_COMMAND, motor));
    if (damaged) {
        const struct bench_event *error = bench_event(&bench, motor, HAL_TRACE_ERROR, 0);
        TEST_ASSERT_EQUAL_INT64(INTERPRETER_ERROR_STORED_PROGRAM, error->value);
    }
    return damaged;
}

static void flip(unsigned area, uint32_t bit)
{
    bench.machine.flash[area][bit / BITS] ^= (uint8_t)(1U << bit % BITS);
}

static uint32_t used_bytes(unsigned area)
{
    uint32_t used = HAL_FLASH_AREA_BYTES;
    while (used > 0 && flash[area][used - 1] == ERASED) {
        used--;
    }
    return used;
}

void test_one_wrong_bit_anywhere_damages_one_program_at_most_and_runs_no_other(void)
{
    unsigned damaged = 0;
    store_old();
    keep_flash();
    for (unsigned area = 0; area < HAL_FLASH_AREAS; area++) {
        for (uint32_t bit = 0; bit < used_bytes(area) * BITS; bit++) {
            memcpy(bench.machine.flash, flash, sizeof flash);
            flip(area, bit);
            restart();
            unsigned of_this_bit = 0;
            for (unsigned motor = 1; motor <= UNIT_MOTORS; motor++) {
                of_this_bit += is_damaged(motor) ? 1U : 0U;
            }
            TEST_ASSERT_LESS_OR_EQUAL_UINT(1, of_this_bit);
            damaged += of_this_bit;
            points++;
        }
    }
    printf("wrong bits: %u, programs damaged: %u, wrong programs run: 0\n", points, damaged);
    TEST_ASSERT_GREATER_THAN_UINT(0, damaged);
}

/* The old program of motor 2 or its new one, and those of the others. */
static void assert_old_or_new(void)
{
    unsigned outputs = bench.machine.outputs;
    points++;
    TEST_ASSERT_EQUAL_HEX8(OTHERS, outputs & OTHERS);
    outputs &= ~(unsigned)OTHERS;
    TEST_ASSERT_TRUE_MESSAGE(outputs == OLD_OUTPUT || outputs == NEW_OUTPUT, "neither the old program nor the new one");
    TEST_ASSERT_EQUAL_STRING(outputs == OLD_OUTPUT ? old_texts[2] : new_text,
                             bench_ask(&bench, MESSAGES_GET_COMMAND, 2));
    for (unsigned motor = 1; motor <= UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_UINT32(0, bench_count(&bench, motor, HAL_TRACE_ERROR));
    }
}

/* Stores the new program, with a power cut at an operation. Returns whether it came so far. */
static bool store_new_cut_at(uint32_t operation, unsigned done)
{
    restart_with_kept_flash();
    send_program(2, new_text);
    bench.unit.store.end = area_is_full ? HAL_FLASH_AREA_BYTES : bench.unit.store.end;
    uint32_t before = bench.machine.flash_operations;
    bench.machine.faults.flash_cut_after = before + operation;
    bench.machine.faults.flash_done = (enum host_flash_done)done;
    store_program(2);
    bool cut = bench.machine.flash_operations >= before + operation;
    restart();
    return cut;
}

static void cut_again(uint32_t first)
{
    static uint8_t at_start[HAL_FLASH_AREAS][HAL_FLASH_AREA_BYTES];
    memcpy(at_start, flash, sizeof at_start);
    store_new_cut_at(first, first % DONE_KINDS);
    keep_flash();
    for (uint32_t second = 1; store_new_cut_at(second, second % DONE_KINDS); second++) {
        assert_old_or_new();
    }
    memcpy(flash, at_start, sizeof flash);
}

static void sweep_cuts(void)
{
    keep_flash();
    for (unsigned done = 0; done < DONE_KINDS; done++) {
        for (uint32_t operation = 1; store_new_cut_at(operation, done); operation++) {
            assert_old_or_new();
            if (getenv("RKM04_LONG") != NULL && done == 0) {
                cut_again(operation);
            }
        }
    }
}

void test_a_cut_at_every_operation_of_store_flash_leaves_the_old_program_or_the_new_one(void)
{
    store_old();
    sweep_cuts();
    printf("power cuts of Store Flash: %u points, 0 mixtures\n", points);
}

void test_a_cut_while_the_area_changes_leaves_the_old_program_or_the_new_one(void)
{
    store_old();
    area_is_full = true;
    sweep_cuts();
    printf("power cuts of Store Flash with a change of areas: %u points, 0 mixtures\n", points);
}
