#include "pos_write.h"

#include <assert.h>
#include <stddef.h>

enum {
    WORD_BITS = 16,
    CODE_MASK = 0xFF, /* of an instruction word */

    RECORD_KEPT = 0x0001, /* bits of CONTROL; what is neither kept nor left out must be 0 */
    RECORD_LEFT_OUT = 0x000E,

    STEPS_PER_MICROMETRE_MAX = 500,
    MICROMETRES_PER_STEP_MAX = 10000,
};

#define SIGN_16 UINT32_C(0x8000)
#define SIGN_32 UINT32_C(0x80000000)
#define RANGE_32 INT64_C(4294967296)

static bool is_rate(uint32_t value)
{
    static const uint16_t rates[] = {96, 192, 384, 576, 1152};
    for (uint32_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        if (value == rates[i]) {
            return true;
        }
    }
    return false;
}

#define A(name, number, type, use, form, min, max, start, unit, text)                                                  \
    static_assert(POS_TYPE_##type != POS_TYPE_I32 || POS_FORM_##form == POS_FORM_ANY, #name " has all values of I32");
#include "registers.def"
#undef A

static bool is_signed_word(const struct pos_row *row)
{
    return row->type == (uint8_t)POS_TYPE_I16;
}

static bool is_in_range(const struct pos_row *row, uint32_t value)
{
    int64_t number = (int64_t)value;
    if (is_signed_word(row) && value >= SIGN_32) {
        number -= RANGE_32;
    }
    return number >= (int64_t)row->min && number <= (int64_t)row->max;
}

static bool is_taken(const struct pos_row *row, uint32_t value)
{
    bool taken = true;
    switch ((enum pos_form)row->form) {
    case POS_FORM_ANY:
        break;
    case POS_FORM_RANGE:
    case POS_FORM_FACTOR:
        taken = is_in_range(row, value);
        break;
    case POS_FORM_ZERO_OR:
        taken = value == 0U || is_in_range(row, value);
        break;
    case POS_FORM_RATE:
        taken = is_rate(value);
        break;
    case POS_FORM_CODE:
        taken = is_in_range(row, value & (uint32_t)CODE_MASK);
        break;
    case POS_FORM_RECORD:
        taken = (value & ~(uint32_t)RECORD_KEPT) == 0U;
        break;
    }
    return taken;
}

/* The value that begins with word `i` of `count`. A lower word that was left out is 0. */
static uint32_t value_of(const struct pos_row *row, const uint16_t *values, uint32_t i, uint32_t count)
{
    uint32_t value = values[i];
    if (pos_row_is_wide(row)) {
        uint32_t low = i + 1U < count ? values[i + 1U] : 0U;
        return (value << (unsigned)WORD_BITS) | low;
    }
    if (is_signed_word(row)) {
        return (value ^ SIGN_16) - SIGN_16;
    }
    return row->form == (uint8_t)POS_FORM_RECORD ? value & ~(uint32_t)RECORD_LEFT_OUT : value;
}

/* STEPS or MICROMETRES of an axis, as it will be. A range with one of them has only registers of that axis. */
static uint32_t factor_of(const struct pos_write *write, const struct pos_registers *registers, uint32_t axis,
                          enum pos_axis_register which)
{
    for (uint32_t i = 0; i < write->count; i++) {
        if (write->written[i].place.index == (uint8_t)which) {
            return write->written[i].value;
        }
    }
    return registers->axes[axis - 1U][which];
}

static bool has_factor(const struct pos_write *write, const struct pos_registers *registers, uint32_t axis)
{
    uint64_t steps = factor_of(write, registers, axis, POS_AXIS_STEPS);
    uint64_t micrometres = factor_of(write, registers, axis, POS_AXIS_MICROMETRES);
    return steps <= micrometres * (uint64_t)STEPS_PER_MICROMETRE_MAX &&
           micrometres <= steps * (uint64_t)MICROMETRES_PER_STEP_MAX;
}

static bool have_factors(const struct pos_write *write, const struct pos_registers *registers)
{
    for (uint32_t i = 0; i < write->count; i++) {
        const struct pos_place *place = &write->written[i].place;
        if (pos_row(place)->form == (uint8_t)POS_FORM_FACTOR && !has_factor(write, registers, place->axis)) {
            return false;
        }
    }
    return true;
}

bool pos_write_init(struct pos_write *write, const struct pos_registers *registers, uint32_t first, uint32_t count,
                    const uint16_t *values)
{
    assert(count <= (uint32_t)POS_WRITE_MAX);
    write->count = 0;
    for (uint32_t i = 0; i < count; i++) {
        struct pos_written *written = &write->written[write->count];
        bool found = pos_find(first + i, &written->place);
        assert(found);
        (void)found;
        if (written->place.low) {
            continue;
        }
        const struct pos_row *row = pos_row(&written->place);
        written->value = value_of(row, values, i, count);
        if (!is_taken(row, written->value)) {
            return false;
        }
        write->count++;
    }
    return have_factors(write, registers);
}

uint32_t pos_write_axes(const struct pos_write *write)
{
    const uint32_t all = (UINT32_C(1) << (unsigned)POS_AXES) - 1U;
    uint32_t axes = 0;
    for (uint32_t i = 0; i < write->count; i++) {
        const struct pos_place *place = &write->written[i].place;
        uint8_t use = pos_row(place)->use;
        if (use == (uint8_t)POS_USE_SETTING || use == (uint8_t)POS_USE_STORE) {
            axes |= place->axis == 0U ? all : UINT32_C(1) << (place->axis - 1U);
        }
    }
    return axes;
}

const struct pos_written *pos_write_next(const struct pos_write *write, enum pos_use use, uint32_t *next)
{
    while (*next < write->count) {
        const struct pos_written *written = &write->written[*next];
        *next += 1U;
        if (pos_row(&written->place)->use == (uint8_t)use) {
            return written;
        }
    }
    return NULL;
}

void pos_write_apply(const struct pos_write *write, struct pos_registers *registers)
{
    for (uint32_t i = 0; i < write->count; i++) {
        const struct pos_written *written = &write->written[i];
        if (pos_row(&written->place)->use != (uint8_t)POS_USE_STORE) {
            *pos_registers_at(registers, &written->place) = written->value;
        }
    }
}
