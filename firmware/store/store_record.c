#include "store_record.h"

#include <assert.h>
#include <string.h>

#include "base_crc32.h"
#include "hal_flash.h"
#include "store.h"

enum {
    HEAD_FIELDS_BYTES = 12, /* of the head, what the text's CRC covers */
    HEAD_CHECKED_BYTES = 16,
    CHUNK_BYTES = 64,
    BYTE_BITS = 8,
    ERASED = 0xFF,
};

#define MAGIC UINT32_C(0x01344B52) /* "RK4", format 1 */
#define MARK_UNSET UINT32_MAX

static_assert(CHUNK_BYTES % HAL_FLASH_WORD_BYTES == 0, "chunks are whole words");
static_assert(STORE_HEAD_BYTES % HAL_FLASH_WORD_BYTES == 0, "heads are whole words");
static_assert(STORE_TEXT_BYTES_MAX <= UINT16_MAX, "the head has 16 bits for the length");

static uint32_t read_number(const uint8_t *bytes, unsigned count)
{
    uint32_t number = 0;
    for (unsigned i = count; i-- > 0;) {
        number = (number << BYTE_BITS) | bytes[i];
    }
    return number;
}

static void write_number(uint8_t *bytes, unsigned count, uint32_t number)
{
    for (unsigned i = 0; i < count; i++) {
        bytes[i] = (uint8_t)(number >> (BYTE_BITS * i));
    }
}

static uint32_t smaller(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static uint32_t text_offset(uint32_t offset)
{
    return offset + 2 * STORE_HEAD_BYTES;
}

/* ---- flash: words ---------------------------------------------------------------------------------------------- */

bool store_flash_is_blank(unsigned area, uint32_t begin, uint32_t end)
{
    uint64_t chunk[CHUNK_BYTES / sizeof(uint64_t)];
    uint64_t zeros = 0;
    uint32_t length = 0;
    memset(chunk, ERASED, sizeof chunk);
    for (; begin < end && zeros == 0; begin += length) {
        length = smaller(end - begin, CHUNK_BYTES);
        hal_flash_read(area, begin, (uint8_t *)chunk, length);
        for (unsigned i = 0; i < CHUNK_BYTES / sizeof(uint64_t); i++) {
            zeros |= ~chunk[i];
        }
    }
    return zeros == 0;
}

static bool put_word(unsigned area, uint32_t offset, const uint8_t word[HAL_FLASH_WORD_BYTES])
{
    uint8_t back[HAL_FLASH_WORD_BYTES];
    if (!hal_flash_write_word(area, offset, word)) {
        return false;
    }
    hal_flash_read(area, offset, back, HAL_FLASH_WORD_BYTES);
    return memcmp(back, word, HAL_FLASH_WORD_BYTES) == 0;
}

/* Stops at the first word that does not read back, so that a faulty head is never followed by a second one. */
static bool put_bytes(unsigned area, uint32_t offset, const uint8_t *bytes, uint32_t length)
{
    for (uint32_t i = 0; i < length; i += HAL_FLASH_WORD_BYTES) {
        uint8_t word[HAL_FLASH_WORD_BYTES] = {ERASED, ERASED, ERASED, ERASED};
        memcpy(word, &bytes[i], smaller(length - i, HAL_FLASH_WORD_BYTES));
        if (!put_word(area, offset + i, word)) {
            return false;
        }
    }
    return true;
}

/* ---- marks ----------------------------------------------------------------------------------------------------- */

static uint32_t whole_mark_offset(uint32_t offset, const struct store_record *record)
{
    return offset + record->size_bytes - 2 * STORE_MARK_BYTES;
}

static uint32_t void_mark_offset(uint32_t offset, const struct store_record *record)
{
    return offset + record->size_bytes - STORE_MARK_BYTES;
}

static uint32_t mark_read(unsigned area, uint32_t offset)
{
    uint8_t word[STORE_MARK_BYTES];
    hal_flash_read(area, offset, word, STORE_MARK_BYTES);
    return read_number(word, STORE_MARK_BYTES);
}

static bool mark_write(unsigned area, uint32_t offset)
{
    static const uint8_t set[STORE_MARK_BYTES] = {0};
    return put_word(area, offset, set);
}

static bool mark_is_set(unsigned area, uint32_t offset)
{
    unsigned ones = 0;
    for (uint32_t mark = mark_read(area, offset); mark != 0; mark &= mark - 1U) {
        ones++;
    }
    return ones <= STORE_MARK_ONES_MAX;
}

/* ---- heads ----------------------------------------------------------------------------------------------------- */

/* The fields that the CRC of the text begins with. */
static void head_begin(const struct store_record *record, uint8_t head[STORE_HEAD_BYTES])
{
    memset(head, 0, STORE_HEAD_BYTES);
    write_number(&head[0], 4, MAGIC);
    write_number(&head[4], 4, record->generation);
    write_number(&head[8], 2, record->length);
    write_number(&head[10], 1, record->slot);
}

static void head_finish(const struct store_record *record, uint8_t head[STORE_HEAD_BYTES])
{
    write_number(&head[HEAD_FIELDS_BYTES], 4, record->crc);
    write_number(&head[HEAD_CHECKED_BYTES], 4, crc32_append(0, head, HEAD_CHECKED_BYTES));
}

/* Reads one head of the record at `offset`. False if it is not what a head can be. */
static bool head_read(unsigned area, uint32_t offset, uint32_t head_offset, struct store_record *record)
{
    uint8_t head[STORE_HEAD_BYTES];
    hal_flash_read(area, head_offset, head, STORE_HEAD_BYTES);
    record->generation = read_number(&head[4], 4);
    record->length = read_number(&head[8], 2);
    record->slot = head[10];
    record->crc = read_number(&head[HEAD_FIELDS_BYTES], 4);
    record->size_bytes = store_record_size_bytes(record->length);
    return read_number(&head[0], 4) == MAGIC &&
           read_number(&head[HEAD_CHECKED_BYTES], 4) == crc32_append(0, head, HEAD_CHECKED_BYTES) &&
           record->length <= STORE_TEXT_BYTES_MAX && record->slot < STORE_SLOTS &&
           record->size_bytes <= HAL_FLASH_AREA_BYTES - offset;
}

static struct store_record without_head(unsigned area, uint32_t offset)
{
    uint32_t second = offset + STORE_HEAD_BYTES;
    if (store_flash_is_blank(area, offset, second)) {
        return (struct store_record){.state = STORE_RECORD_BLANK};
    }
    if (store_flash_is_blank(area, second, text_offset(offset))) {
        return (struct store_record){.state = STORE_RECORD_HEADLESS, .size_bytes = 2 * STORE_HEAD_BYTES};
    }
    return (struct store_record){.state = STORE_RECORD_LOST};
}

/* ---- records --------------------------------------------------------------------------------------------------- */

uint32_t store_record_size_bytes(uint32_t length)
{
    uint32_t words = (length + HAL_FLASH_WORD_BYTES - 1U) / HAL_FLASH_WORD_BYTES;
    return STORE_RECORD_EXTRA_BYTES + words * HAL_FLASH_WORD_BYTES;
}

struct store_record store_record_read(unsigned area, uint32_t offset)
{
    struct store_record record = {0};
    if (!head_read(area, offset, offset, &record) && !head_read(area, offset, offset + STORE_HEAD_BYTES, &record)) {
        return without_head(area, offset);
    }
    if (!mark_is_set(area, whole_mark_offset(offset, &record))) {
        record.state = STORE_RECORD_UNFINISHED;
    } else if (mark_is_set(area, void_mark_offset(offset, &record))) {
        record.state = STORE_RECORD_VOID;
    } else {
        record.state = STORE_RECORD_FINISHED;
    }
    return record;
}

bool store_record_is_intact(unsigned area, uint32_t offset, const struct store_record *record)
{
    uint8_t bytes[CHUNK_BYTES];
    head_begin(record, bytes);
    uint32_t crc = crc32_append(0, bytes, HEAD_FIELDS_BYTES);
    uint32_t length = 0;
    for (uint32_t i = 0; i < record->length; i += length) {
        length = smaller(record->length - i, CHUNK_BYTES);
        hal_flash_read(area, text_offset(offset) + i, bytes, length);
        crc = crc32_append(crc, bytes, length);
    }
    return crc == record->crc;
}

/* Writes all but the void-mark; `crc_error` is put over the CRC. */
static bool write_record(unsigned area, uint32_t offset, struct store_record *record, const uint8_t *text,
                         uint32_t crc_error)
{
    uint8_t head[STORE_HEAD_BYTES];
    record->size_bytes = store_record_size_bytes(record->length);
    head_begin(record, head);
    record->crc = crc32_append(crc32_append(0, head, HEAD_FIELDS_BYTES), text, record->length) ^ crc_error;
    head_finish(record, head);
    return put_bytes(area, offset, head, STORE_HEAD_BYTES) &&
           put_bytes(area, offset + STORE_HEAD_BYTES, head, STORE_HEAD_BYTES) &&
           put_bytes(area, text_offset(offset), text, record->length) &&
           mark_write(area, whole_mark_offset(offset, record));
}

bool store_record_write(unsigned area, uint32_t offset, unsigned slot, uint32_t generation, const uint8_t *text,
                        uint32_t length)
{
    struct store_record record = {.generation = generation, .length = length, .slot = (uint8_t)slot};
    return write_record(area, offset, &record, text, 0);
}

bool store_record_write_damaged(unsigned area, uint32_t offset, unsigned slot, uint32_t generation)
{
    struct store_record record = {.generation = generation, .slot = (uint8_t)slot};
    return write_record(area, offset, &record, NULL, UINT32_MAX);
}

bool store_record_copy(unsigned from_area, uint32_t from_offset, unsigned to_area, uint32_t to_offset,
                       uint32_t size_bytes)
{
    uint8_t word[HAL_FLASH_WORD_BYTES];
    for (uint32_t i = 0; i < size_bytes; i += HAL_FLASH_WORD_BYTES) {
        hal_flash_read(from_area, from_offset + i, word, HAL_FLASH_WORD_BYTES);
        if (!put_word(to_area, to_offset + i, word)) {
            return false;
        }
    }
    return true;
}

bool store_record_make_void(unsigned area, uint32_t offset, const struct store_record *record)
{
    uint32_t mark = void_mark_offset(offset, record);
    return mark_read(area, mark) != MARK_UNSET || mark_write(area, mark);
}

void store_record_read_text(unsigned area, uint32_t offset, const struct store_record *record, uint8_t *text)
{
    hal_flash_read(area, text_offset(offset), text, record->length);
}

bool store_record_has_text(unsigned area, uint32_t offset, const struct store_record *record, const uint8_t *text,
                           uint32_t length)
{
    uint8_t chunk[CHUNK_BYTES];
    if (record->length != length) {
        return false;
    }
    uint32_t part = 0;
    for (uint32_t i = 0; i < length; i += part) {
        part = smaller(length - i, CHUNK_BYTES);
        hal_flash_read(area, text_offset(offset) + i, chunk, part);
        if (memcmp(chunk, &text[i], part) != 0) {
            return false;
        }
    }
    return true;
}
