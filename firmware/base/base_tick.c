#include "base_tick.h"

#include "base_wide.h"

int32_t tick_difference(uint32_t a, uint32_t b)
{
    return wide_to_signed_32(a - b);
}

bool tick_is_before(uint32_t a, uint32_t b)
{
    return tick_difference(a, b) < 0;
}

uint64_t tick_extend(uint32_t tick, uint64_t near_ticks)
{
    int64_t way = tick_difference(tick, (uint32_t)near_ticks);
    return near_ticks + wide_from_signed(way);
}
