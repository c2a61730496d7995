#include "base_tick.h"

#include "base_wide.h"

int32_t tick_difference(uint32_t a, uint32_t b)
{
    uint32_t way = a - b;
    return way <= (uint32_t)INT32_MAX ? (int32_t)way : -(int32_t)(UINT32_MAX - way) - 1;
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
