#include "pos_settings.h"

#include <assert.h>
#include <string.h>

enum {
    MARK_BYTES = 4,
    VALUE_BYTES = 4,
    VALUES_MAX = POS_UNIT_REGISTERS + (POS_AXES * POS_AXIS_REGISTERS),
    TEXT_BYTES_MAX = MARK_BYTES + (VALUES_MAX * VALUE_BYTES),
    BYTE_BITS = 8,
};

static_assert((uint32_t)TEXT_BYTES_MAX <= (uint32_t)STORE_TEXT_BYTES_MAX, "all settings are one text");
static_assert((uint32_t)POS_SETTINGS_SLOT < (uint32_t)STORE_SLOTS, "there is such a slot");

/* Another unit may have left a text in the slot, or another version of this one. */
static const uint8_t mark[MARK_BYTES] = {'P', 'O', 'S', 1};

/* Bytes that are being written or read, one value after the other. */
struct settings_text {
    uint8_t bytes[TEXT_BYTES_MAX];
    uint32_t length;
};

static bool is_setting(unsigned axis, unsigned index)
{
    const struct pos_place place = {.axis = (uint8_t)axis, .index = (uint8_t)index};
    return pos_row(&place)->use == (uint8_t)POS_USE_SETTING;
}

static void put(struct settings_text *text, uint32_t value)
{
    for (unsigned i = VALUE_BYTES; i-- > 0U;) {
        text->bytes[text->length++] = (uint8_t)((value >> (i * (unsigned)BYTE_BITS)) & 0xFFU);
    }
}

static uint32_t take(struct settings_text *text)
{
    uint32_t value = 0;
    for (unsigned i = 0; i < (unsigned)VALUE_BYTES; i++) {
        value = (value << (unsigned)BYTE_BITS) | text->bytes[text->length++];
    }
    return value;
}

/* All settings, in the order of the table. */
static void write(struct settings_text *text, const struct pos_registers *registers)
{
    memcpy(text->bytes, mark, MARK_BYTES);
    text->length = MARK_BYTES;
    for (unsigned i = 0; i < (unsigned)POS_UNIT_REGISTERS; i++) {
        if (is_setting(0, i)) {
            put(text, registers->unit[i]);
        }
    }
    for (unsigned axis = 1; axis <= (unsigned)POS_AXES; axis++) {
        for (unsigned i = 0; i < (unsigned)POS_AXIS_REGISTERS; i++) {
            if (is_setting(axis, i)) {
                put(text, registers->axes[axis - 1U][i]);
            }
        }
    }
}

static void read(struct settings_text *text, struct pos_registers *registers)
{
    text->length = MARK_BYTES;
    for (unsigned i = 0; i < (unsigned)POS_UNIT_REGISTERS; i++) {
        if (is_setting(0, i)) {
            registers->unit[i] = take(text);
        }
    }
    for (unsigned axis = 1; axis <= (unsigned)POS_AXES; axis++) {
        for (unsigned i = 0; i < (unsigned)POS_AXIS_REGISTERS; i++) {
            if (is_setting(axis, i)) {
                registers->axes[axis - 1U][i] = take(text);
            }
        }
    }
}

/* The text that is stored, of the length that `text` has. False: it is another one. */
static bool load(const struct store *store, struct settings_text *text)
{
    if (store_length(store, POS_SETTINGS_SLOT) != text->length) {
        return false;
    }
    (void)store_load(store, POS_SETTINGS_SLOT, text->bytes);
    return memcmp(text->bytes, mark, MARK_BYTES) == 0;
}

void pos_settings_init(struct pos_settings *settings, struct pos_registers *registers)
{
    struct settings_text text;
    *settings = (struct pos_settings){.damaged = false};
    store_init(&settings->store);
    pos_registers_deliver(registers);
    write(&text, registers);
    if (load(&settings->store, &text)) {
        read(&text, registers);
    } else {
        bool stored = store_length(&settings->store, POS_SETTINGS_SLOT) != 0U;
        settings->damaged = stored || store_is_damaged(&settings->store, POS_SETTINGS_SLOT);
        settings->other = settings->damaged;
    }
}

bool pos_settings_store(struct pos_settings *settings, const struct pos_registers *registers)
{
    struct settings_text text;
    write(&text, registers);
    if (store_save(&settings->store, POS_SETTINGS_SLOT, text.bytes, text.length) != STORE_OK) {
        return false;
    }
    settings->damaged = false;
    settings->other = false;
    return true;
}

void pos_settings_compare(struct pos_settings *settings, const struct pos_registers *registers)
{
    struct settings_text text;
    struct settings_text stored;
    write(&text, registers);
    stored.length = text.length;
    if (!settings->damaged && !load(&settings->store, &stored)) {
        struct pos_registers delivered;
        pos_registers_init(&delivered);
        write(&stored, &delivered);
    }
    settings->other = settings->damaged || memcmp(text.bytes, stored.bytes, text.length) != 0;
}
