#include "vtime.h"

__extension__ typedef unsigned __int128 wide;

uint64_t vtime_scale(uint64_t a, uint64_t b, uint64_t c)
{
    return (uint64_t)((wide)a * b / c);
}

uint64_t vtime_ps_of_cycle(const struct vtime *time, uint64_t cycle)
{
    return time->anchor_ps + vtime_scale(cycle - time->anchor_cycle, VTIME_PS_PER_SECOND, time->hclk_hz);
}

uint64_t vtime_cycle_of_ps(const struct vtime *time, uint64_t ps)
{
    if (ps == VTIME_NEVER) {
        return VTIME_NEVER;
    }
    if (ps <= time->anchor_ps) {
        return time->anchor_cycle;
    }
    wide product = (wide)(ps - time->anchor_ps) * time->hclk_hz + (VTIME_PS_PER_SECOND - 1U);
    return time->anchor_cycle + (uint64_t)(product / VTIME_PS_PER_SECOND);
}

void vtime_set_hclk(struct vtime *time, uint64_t cycle, uint64_t hz)
{
    if (time->hclk_hz != 0) {
        time->anchor_ps = vtime_ps_of_cycle(time, cycle);
    }
    time->anchor_cycle = cycle;
    time->hclk_hz = hz;
}
