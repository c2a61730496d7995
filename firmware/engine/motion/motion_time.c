#include "motion_time.h"

#include "step_scale.h"

enum {
    FRACTION_BITS = 32
};

struct motion_time motion_time_add(struct motion_time time, struct wide dividend, uint64_t divisor)
{
    uint64_t rest = 0;
    uint64_t ticks = wide_divide(dividend, divisor, &rest);
    struct wide fine = wide_shift_left((struct wide){.low = rest}, FRACTION_BITS);
    uint64_t fraction = wide_divide(fine, divisor, &rest) + time.fraction;
    return (struct motion_time){
        .ticks = time.ticks + ticks + (fraction >> FRACTION_BITS),
        .fraction = (uint32_t)(fraction & UINT32_MAX),
    };
}

uint64_t motion_time_up(struct motion_time time)
{
    return time.ticks + (time.fraction != 0 ? 1U : 0U);
}

struct wide motion_place_distance(struct motion_place a, struct motion_place b)
{
    struct wide distance = wide_multiply(b.step - a.step, STEP_QUANTA);
    return wide_subtract(wide_add(distance, (struct wide){.low = b.quanta}), (struct wide){.low = a.quanta});
}

bool motion_place_is_same(struct motion_place a, struct motion_place b)
{
    return a.step == b.step && a.quanta == b.quanta;
}

struct motion_place motion_place_add(uint64_t step, uint64_t numerator, uint64_t denominator)
{
    uint64_t quanta = wide_divide_nearest(wide_multiply(numerator % denominator, STEP_QUANTA), denominator);
    return (struct motion_place){.step = step + numerator / denominator, .quanta = quanta};
}

struct motion_place motion_place_subtract(uint64_t step, uint64_t numerator, uint64_t denominator)
{
    uint64_t whole = (numerator + denominator - 1U) / denominator;
    return motion_place_add(step - whole, whole * denominator - numerator, denominator);
}
