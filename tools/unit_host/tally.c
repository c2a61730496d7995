#include "tally.h"

void tally_begin_move(struct tally *tally, uint64_t tick, int64_t position)
{
    tally->moves++;
    tally->moving = true;
    tally->move_tick = tick;
    tally->move_pulses = tally->pulses;
    tally->pulse_tick = tick;
    tally->position = position;
}

uint64_t tally_count_pulse(struct tally *tally, uint64_t tick, int64_t position)
{
    bool next = position == tally->position + 1 || position == tally->position - 1;
    uint64_t interval_ticks = next ? tick - tally->pulse_tick : 0U;
    tally->pulses++;
    tally->pulse_tick = tick;
    tally->position = position;
    if (next && (tally->shortest_ticks == 0 || interval_ticks < tally->shortest_ticks)) {
        tally->shortest_ticks = interval_ticks;
    }
    return interval_ticks;
}

void tally_end_move(struct tally *tally, uint64_t tick, bool together)
{
    bool counts = !together || tally->pulses != tally->move_pulses;
    tally->moves -= counts ? 0U : 1U;
    tally->moving_ticks += counts ? tick - tally->move_tick : 0U;
    tally->moving = false;
}

uint64_t tally_moving_ticks(const struct tally *tally, uint64_t now_ticks, bool together)
{
    bool counts = !together || tally->pulses != tally->move_pulses;
    bool running = tally->moving && counts && now_ticks > tally->move_tick;
    return tally->moving_ticks + (running ? now_ticks - tally->move_tick : 0U);
}
