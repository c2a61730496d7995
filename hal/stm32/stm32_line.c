#include "base_tick.h"
#include "hal_time.h"
#include "stm32_line_private.h"

enum {
    TOGETHER_TICKS = TICKS_PER_MS, /* of bytes of one run */
};

struct stm32_line stm32_line;

/* The last tick of the unit of time at which a byte came, but not one to come. */
static uint32_t tick_of(uint32_t number, uint64_t now)
{
    const uint32_t rest = (UINT32_C(1) << (uint32_t)TIME_PLACE) - 1U;
    uint32_t tick = ((uint32_t)stm32_line.received_time[number % RECEIVED_MAX] << (uint32_t)TIME_PLACE) + rest;
    return tick - (uint32_t)now <= rest ? (uint32_t)now : tick;
}

bool stm32_line_take(struct hal_line_byte *byte)
{
    if (stm32_line.received_out == stm32_line.received_in) {
        return false;
    }
    uint64_t now = hal_time_now();
    uint32_t place = stm32_line.received_out % RECEIVED_MAX;
    *byte = (struct hal_line_byte){
        .tick = tick_extend(tick_of(stm32_line.received_out, now), now),
        .value = (uint8_t)stm32_line.received[place],
        .broken = (stm32_line.received[place] & (unsigned)RECEIVED_BROKEN) != 0,
    };
    stm32_line.received_out++;
    return true;
}

/* The tick of a run is that of its last byte. */
bool stm32_line_take_run(struct hal_line_run *run, uint8_t last)
{
    uint64_t now = hal_time_now();
    uint32_t next = stm32_line.received_out;
    uint32_t there = stm32_line.received_in - next;
    uint32_t most = there < (uint32_t)HAL_LINE_RUN_MAX ? there : (uint32_t)HAL_LINE_RUN_MAX;
    uint32_t first_tick = tick_of(next, now);
    uint32_t tick = first_tick;
    uint32_t received = 0;
    uint32_t count = 0;
    while (count < most) {
        uint32_t next_tick = tick_of(next, now);
        received = stm32_line.received[next % RECEIVED_MAX];
        bool apart = received >= (uint32_t)RECEIVED_BROKEN || next_tick - first_tick > (uint32_t)TOGETHER_TICKS;
        if (apart && count != 0) {
            break;
        }
        tick = next_tick;
        run->bytes[count++] = (uint8_t)received;
        next++;
        most = received >= (uint32_t)RECEIVED_BROKEN || received == last ? count : most;
    }
    stm32_line.received_out = next;
    run->tick = tick_extend(tick, now);
    run->count = count;
    run->broken = count == 1U && received >= (uint32_t)RECEIVED_BROKEN;
    return count != 0;
}

uint8_t hal_line_node(void)
{
    return stm32_io_node();
}
