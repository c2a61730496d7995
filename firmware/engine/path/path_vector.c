#include "path_vector.h"

#include "path_divide.h"

static const uint32_t US_PER_S = 1000000;

static uint64_t lower(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static uint64_t square(uint32_t value)
{
    return (uint64_t)value * value;
}

/* dividend / divisor rounded down, 2^60 if it is more. */
static uint64_t divide(struct wide dividend, uint64_t divisor)
{
    uint64_t rest = 0;
    if (dividend.high >= divisor) {
        return PATH_SPEED2_ENDLESS;
    }
    const struct path_divisor ready = path_divisor_of(divisor);
    return lower(path_divide(dividend, &ready, &rest), PATH_SPEED2_ENDLESS);
}

uint64_t path_section_to_border2(const struct path_section *section, uint64_t speed2)
{
    if (section->plain) {
        return speed2;
    }
    return divide(path_wide_multiply(speed2, section->vector.extent2), square(section->length));
}

uint64_t path_section_to_border2_up(const struct path_section *section, uint64_t speed2)
{
    uint64_t border2 = path_section_to_border2(section, speed2);
    return path_section_from_border2(section, border2) < speed2 ? border2 + 1U : border2;
}

uint64_t path_section_from_border2(const struct path_section *section, uint64_t border2)
{
    if (section->plain) {
        return border2;
    }
    return divide(path_wide_multiply(border2, square(section->length)), section->vector.extent2);
}

static uint32_t longest(const struct path_section *section)
{
    uint32_t length = 0;
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        uint32_t steps = path_section_steps(section, axis);
        length = steps > length ? steps : length;
    }
    return length;
}

/* G*L / (L/E)^2 = G*E^2 / L. */
static uint64_t gain_of(const struct path_section *section)
{
    if (section->plain) {
        struct wide gain = path_wide_multiply(path_section_gain_per_step(section), section->length);
        return gain.high != 0 ? PATH_SPEED2_ENDLESS : lower(gain.low, PATH_SPEED2_ENDLESS);
    }
    return divide(path_wide_multiply(path_section_gain_per_step(section), section->vector.extent2), section->length);
}

void path_section_take(struct path_section *section, const struct path_vector *vector)
{
    *section = (struct path_section){.vector = *vector, .border2 = square(vector->border_speed)};
    section->length = longest(section);
    section->plain = vector->extent2 == square(section->length);
    section->gain2 = gain_of(section);
    path_section_set_speed(section, vector->speed);
}

void path_section_set_accel(struct path_section *section, uint32_t accel)
{
    section->vector.accel = accel;
    section->gain2 = gain_of(section);
}

static bool turns(const struct path_section *a, const struct path_section *b, unsigned axis)
{
    int32_t before = a->vector.steps[axis];
    int32_t after = b->vector.steps[axis];
    return (before < 0 && after > 0) || (before > 0 && after < 0);
}

/* The speed at which an axis that accelerates from the border on makes its first pulse after turn_us: with that speed
 * it goes L/|d| - A*t^2/2 of the path in that time. */
static uint32_t turn_speed(const struct path_section *section, unsigned axis, uint32_t turn_us)
{
    uint64_t way = (uint64_t)PATH_SPEED_UNITS * US_PER_S * section->length;
    uint64_t speed = way / ((uint64_t)turn_us * path_section_steps(section, axis));
    uint64_t gain = ((uint64_t)section->vector.accel * turn_us + US_PER_S - 1U) / US_PER_S;
    return (uint32_t)(speed > gain ? lower(speed - gain, UINT32_MAX) : 0U);
}

void path_section_mind_turns(struct path_section *section, const struct path_section *before, uint32_t turn_us)
{
    section->border2 = square(section->vector.border_speed);
    section->turning = 0;
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        if (turns(before, section, axis)) {
            uint32_t steps = path_section_steps(section, axis);
            uint64_t speed2 = square(turn_speed(section, axis, turn_us));
            section->border2 = lower(section->border2, path_section_to_border2(section, speed2));
            section->turning = section->turning == 0 || steps < section->turning ? steps : section->turning;
        }
    }
}
