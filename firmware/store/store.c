#include "store.h"

#include <assert.h>
#include <stddef.h>

#include "hal_flash.h"
#include "store_record.h"

enum {
    LOG_BEGIN = STORE_RECORD_EXTRA_BYTES, /* after the record that says that the area is good */
    TEXT_RECORD_BYTES_MAX = STORE_RECORD_EXTRA_BYTES + STORE_TEXT_BYTES_MAX,
};

static_assert(STORE_TEXT_BYTES_MAX % HAL_FLASH_WORD_BYTES == 0, "the longest text needs no filling");
static_assert(LOG_BEGIN + (STORE_SLOTS + 1) * TEXT_RECORD_BYTES_MAX <= HAL_FLASH_AREA_BYTES,
              "an area that has just been begun has room for one more text");
static_assert(HAL_FLASH_AREAS == 2, "there is one other area");

static unsigned other_area(const struct store *store)
{
    return 1U - store->area;
}

static void note_generation(struct store *store, uint32_t generation)
{
    if (generation > store->generation) {
        store->generation = generation;
    }
}

static void lose_all(struct store *store)
{
    for (unsigned slot = 0; slot < STORE_SLOTS; slot++) {
        store->image[slot] = 0;
        store->damaged[slot] = true;
    }
}

/* Of two good areas the younger one counts: a cut came before the older one was made void. An area is erased only
 * while the other one is good; so where none is, one that has been in use tells of images that cannot be found. */
static void choose_area(struct store *store, const struct store_record mark[HAL_FLASH_AREAS])
{
    store->area = HAL_FLASH_AREAS - 1;
    for (unsigned area = 0; area < HAL_FLASH_AREAS; area++) {
        if (mark[area].state == STORE_RECORD_FINISHED &&
            (!store->usable || mark[area].generation > store->generation)) {
            store->usable = true;
            store->area = (uint8_t)area;
            store->generation = mark[area].generation;
        }
    }
    for (unsigned area = 0; area < HAL_FLASH_AREAS && !store->usable; area++) {
        if (mark[area].state >= STORE_RECORD_VOID) {
            store->area = (uint8_t)area;
            note_generation(store, mark[area].generation);
            lose_all(store);
        }
    }
}

/* Completes a move to the present area that was cut before its last step. A failure is harmless: the present area
 * stays the younger one. */
static void complete_move(const struct store *store, const struct store_record mark[HAL_FLASH_AREAS])
{
    unsigned other = other_area(store);
    if (mark[other].state == STORE_RECORD_FINISHED) {
        (void)store_record_make_void(other, 0, &mark[other]);
    }
}

static void scan_log(struct store *store)
{
    uint32_t offset = LOG_BEGIN;
    while (offset <= HAL_FLASH_AREA_BYTES - STORE_RECORD_EXTRA_BYTES) {
        struct store_record record = store_record_read(store->area, offset);
        if (record.state == STORE_RECORD_LOST) {
            lose_all(store);
        }
        if (record.size_bytes == 0) {
            break;
        }
        if (record.state == STORE_RECORD_FINISHED) {
            store->image[record.slot] = offset;
            note_generation(store, record.generation);
        }
        offset += record.size_bytes;
    }
    store->end = offset;
}

/* Finds the image of a slot, which must be what was written. False if there is none. */
static bool find_image(const struct store *store, unsigned slot, struct store_record *record)
{
    assert(slot < STORE_SLOTS);
    if (store->image[slot] == 0) {
        return false;
    }
    *record = store_record_read(store->area, store->image[slot]);
    return record->state == STORE_RECORD_FINISHED && store_record_is_intact(store->area, store->image[slot], record);
}

static void check_images(struct store *store)
{
    struct store_record record;
    for (unsigned slot = 0; slot < STORE_SLOTS; slot++) {
        if (store->image[slot] != 0 && !find_image(store, slot, &record)) {
            store->image[slot] = 0;
            store->damaged[slot] = true;
        }
    }
}

void store_init(struct store *store)
{
    struct store_record mark[HAL_FLASH_AREAS];
    *store = (struct store){0};
    if (!hal_flash_is_there()) {
        lose_all(store);
        return;
    }
    for (unsigned area = 0; area < HAL_FLASH_AREAS; area++) {
        mark[area] = store_record_read(area, 0);
    }
    choose_area(store, mark);
    if (store->usable) {
        complete_move(store, mark);
        scan_log(store);
        check_images(store);
    }
}

bool store_is_damaged(const struct store *store, unsigned slot)
{
    assert(slot < STORE_SLOTS);
    return store->damaged[slot];
}

uint32_t store_length(const struct store *store, unsigned slot)
{
    struct store_record record;
    return find_image(store, slot, &record) ? record.length : 0;
}

uint32_t store_load(const struct store *store, unsigned slot, uint8_t *text)
{
    struct store_record record;
    if (!find_image(store, slot, &record)) {
        return 0;
    }
    store_record_read_text(store->area, store->image[slot], &record, text);
    return record.length;
}

/* Copies what is known of a slot to the other area, at *end, which moves on; that it is damaged is known too. */
static bool carry_over(const struct store *store, unsigned slot, uint32_t *end)
{
    struct store_record record;
    uint32_t begin = *end;
    if (find_image(store, slot, &record)) {
        *end += record.size_bytes;
        return store_record_copy(store->area, store->image[slot], other_area(store), begin, record.size_bytes);
    }
    if (store->image[slot] == 0 && !store->damaged[slot]) {
        return true;
    }
    *end += STORE_RECORD_EXTRA_BYTES;
    return store_record_write_damaged(other_area(store), begin, slot, store->generation);
}

/* Goes over to the other area with the newest image of each slot. Until the new area's own record is whole the
 * present one counts, and from then on the new one; their images are the same. */
static bool move_to_other_area(struct store *store)
{
    unsigned target = other_area(store);
    uint32_t end = LOG_BEGIN;
    bool done = hal_flash_erase(target);
    for (unsigned slot = 0; slot < STORE_SLOTS && done; slot++) {
        done = carry_over(store, slot, &end);
    }
    done = done && store_record_write(target, 0, 0, store->generation + 1U, NULL, 0);
    if (done && store->usable) {
        struct store_record mark = store_record_read(store->area, 0);
        done = store_record_make_void(store->area, 0, &mark);
    }
    if (done) {
        store_init(store);
    }
    return done;
}

/* Where anything has been written after the last record the area is full. This is looked for here, as the start has
 * no time for it. */
static bool has_room(const struct store *store, uint32_t length)
{
    return store->usable && store_record_size_bytes(length) <= HAL_FLASH_AREA_BYTES - store->end &&
           store_flash_is_blank(store->area, store->end, HAL_FLASH_AREA_BYTES);
}

static bool make_room(struct store *store, uint32_t length)
{
    return has_room(store, length) || (move_to_other_area(store) && has_room(store, length));
}

static bool append(struct store *store, unsigned slot, const uint8_t *text, uint32_t length)
{
    if (!store_record_write(store->area, store->end, slot, store->generation + 1U, text, length)) {
        /* The memory may report an error of the last word and yet have written it. */
        struct store_record record = store_record_read(store->area, store->end);
        if (record.state == STORE_RECORD_FINISHED) {
            (void)store_record_make_void(store->area, store->end, &record);
        }
        return false;
    }
    store->generation++;
    store->damaged[slot] = false;
    store->image[slot] = store->end;
    store->end += store_record_size_bytes(length);
    return true;
}

enum store_error store_save(struct store *store, unsigned slot, const uint8_t *text, uint32_t length)
{
    struct store_record record;
    if (length > STORE_TEXT_BYTES_MAX) {
        return STORE_TOO_LONG;
    }
    if (find_image(store, slot, &record) &&
        store_record_has_text(store->area, store->image[slot], &record, text, length)) {
        return STORE_OK;
    }
    if (make_room(store, length) && append(store, slot, text, length)) {
        return STORE_OK;
    }
    /* What flash holds now is what counts. The rest of this area is not tried again: the next text goes to the other
     * area, with all the images. */
    store_init(store);
    store->end = HAL_FLASH_AREA_BYTES;
    return STORE_WRITE_FAILED;
}
