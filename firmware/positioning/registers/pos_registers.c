#include "pos_registers.h"

#include <assert.h>

enum {
    WORD_BITS = 16,
};

uint32_t *pos_registers_at(struct pos_registers *registers, const struct pos_place *place)
{
    return place->axis == 0U ? &registers->unit[place->index] : &registers->axes[place->axis - 1U][place->index];
}

static void set_start(struct pos_registers *registers, struct pos_place place, bool settings_only)
{
    const struct pos_row *row = pos_row(&place);
    if (!settings_only || row->use == (uint8_t)POS_USE_SETTING) {
        *pos_registers_at(registers, &place) = row->start;
    }
}

static void set_all(struct pos_registers *registers, bool settings_only)
{
    for (uint8_t index = 0; index < (uint8_t)POS_UNIT_REGISTERS; index++) {
        set_start(registers, (struct pos_place){.axis = 0, .index = index}, settings_only);
    }
    for (uint8_t axis = 1; axis <= (uint8_t)POS_AXES; axis++) {
        for (uint8_t index = 0; index < (uint8_t)POS_AXIS_REGISTERS; index++) {
            set_start(registers, (struct pos_place){.axis = axis, .index = index}, settings_only);
        }
    }
}

void pos_registers_init(struct pos_registers *registers)
{
    set_all(registers, false);
}

void pos_registers_deliver(struct pos_registers *registers)
{
    set_all(registers, true);
}

/* ---- ranges ---------------------------------------------------------------------------------------------------- */

/* Of a value with two registers a range must have both; of FEED the upper one is enough. So only its ends matter: what
 * shows a register shows the two words side by side. */
static bool is_whole_at(const struct pos_place *place, bool is_first, bool is_last)
{
    const struct pos_row *row = pos_row(place);
    bool cut_before = is_first && place->low;
    bool cut_after = is_last && pos_row_is_wide(row) && !place->low && row->use != (uint8_t)POS_USE_MOTION;
    return !cut_before && !cut_after;
}

/* Whether all are there, whole; with `read_only` or `written`, whether all are so. */
static bool is_range(uint32_t first, uint32_t count, bool read_only, bool written)
{
    for (uint32_t i = 0; i < count; i++) {
        struct pos_place place;
        if (!pos_find(first + i, &place) || !is_whole_at(&place, i == 0U, i + 1U == count)) {
            return false;
        }
        bool reads = pos_row(&place)->use == (uint8_t)POS_USE_READ;
        if ((read_only && !reads) || (written && reads)) {
            return false;
        }
    }
    return true;
}

bool pos_registers_may_read(uint32_t first, uint32_t count, bool only_read)
{
    return is_range(first, count, only_read, false);
}

bool pos_registers_may_write(uint32_t first, uint32_t count)
{
    return is_range(first, count, false, true);
}

void pos_registers_read(const struct pos_registers *registers, uint32_t first, uint32_t count, uint16_t *values)
{
    for (uint32_t i = 0; i < count; i++) {
        struct pos_place place;
        bool found = pos_find(first + i, &place);
        assert(found);
        (void)found;
        uint32_t value =
            place.axis == 0U ? registers->unit[place.index] : registers->axes[place.axis - 1U][place.index];
        bool high = pos_row_is_wide(pos_row(&place)) && !place.low;
        values[i] = (uint16_t)((high ? value >> (unsigned)WORD_BITS : value) & UINT16_MAX);
    }
}
