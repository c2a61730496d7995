#include "pos_table.h"

#include <assert.h>

enum {
    AXIS_NUMBERS = 100,
    IMAGE_MAX = 8, /* registers of an axis in an image */
};

#define ROW(number_, type_, use_, form_, min_, max_, start_)                                                           \
    {                                                                                                                  \
        .min = (min_),                                                                                                 \
        .max = (max_),                                                                                                 \
        .start = (start_),                                                                                             \
        .number = (number_),                                                                                           \
        .type = POS_TYPE_##type_,                                                                                      \
        .use = POS_USE_##use_,                                                                                         \
        .form = POS_FORM_##form_,                                                                                      \
    }

const struct pos_row pos_unit_rows[POS_UNIT_REGISTERS] = {
#define U(name, number, type, use, form, min, max, start, unit, text) ROW(number, type, use, form, min, max, start),
#include "registers.def"
#undef U
};

const struct pos_row pos_axis_rows[POS_AXIS_REGISTERS] = {
#define A(name, number, type, use, form, min, max, start, unit, text) ROW(number, type, use, form, min, max, start),
#include "registers.def"
#undef A
};

/* One more than the row that begins at a number; 0: none does. */
static const uint8_t unit_begins[] = {
#define U(name, number, type, use, form, min, max, start, unit, text) [number] = (uint8_t)POS_UNIT_##name + 1U,
#include "registers.def"
#undef U
};

static const uint8_t axis_begins[] = {
#define A(name, number, type, use, form, min, max, start, unit, text) [number] = (uint8_t)POS_AXIS_##name + 1U,
#include "registers.def"
#undef A
};

static_assert(sizeof unit_begins <= AXIS_NUMBERS && sizeof axis_begins <= AXIS_NUMBERS - 1, "numbers do not overlap");

struct image {
    uint16_t number;
    uint8_t count;
    uint8_t numbers[IMAGE_MAX]; /* of axis registers */
};

static const struct image images[] = {
#define W(name_, number_, count_, ...) {.number = (number_), .count = (count_), .numbers = {__VA_ARGS__}},
#include "registers.def"
#undef W
};

static bool find_begun(const uint8_t *begins, uint32_t size, uint32_t number, struct pos_place *place)
{
    if (number >= size || begins[number] == 0U) {
        return false;
    }
    place->index = (uint8_t)(begins[number] - 1U);
    return true;
}

/* A number at which no row begins may be the lower word of the row before; before 0 there is none, as it wraps. */
static bool find_word(const uint8_t *begins, uint32_t size, uint32_t number, struct pos_place *place)
{
    place->low = false;
    if (find_begun(begins, size, number, place)) {
        return true;
    }
    place->low = true;
    return find_begun(begins, size, number - 1U, place) && pos_row_is_wide(pos_row(place));
}

static bool find_of_axis(uint32_t axis, uint32_t number, struct pos_place *place)
{
    place->axis = (uint8_t)axis;
    return find_word(axis_begins, sizeof axis_begins, number, place);
}

static bool find_in_images(uint32_t number, struct pos_place *place)
{
    for (uint32_t i = 0; i < sizeof images / sizeof images[0]; i++) {
        const struct image *image = &images[i];
        uint32_t offset = number - image->number; /* wraps below it */
        if (offset < (uint32_t)image->count * (uint32_t)POS_AXES) {
            return find_of_axis((offset / image->count) + 1U, image->numbers[offset % image->count], place);
        }
    }
    return false;
}

bool pos_find(uint32_t number, struct pos_place *place)
{
    uint32_t axis = number / (uint32_t)AXIS_NUMBERS;
    if (axis == 0U) {
        place->axis = 0;
        return find_word(unit_begins, sizeof unit_begins, number, place);
    }
    if (axis <= (uint32_t)POS_AXES) {
        return find_of_axis(axis, number % (uint32_t)AXIS_NUMBERS, place);
    }
    return find_in_images(number, place);
}
