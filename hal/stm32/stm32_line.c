#include "base_tick.h"
#include "hal_time.h"
#include "stm32_line_private.h"

struct stm32_line stm32_line;

bool stm32_line_take(struct hal_line_byte *byte)
{
    if (stm32_line.received_out == stm32_line.received_in) {
        return false;
    }
    const struct stm32_received *received = &stm32_line.received[stm32_line.received_out % RECEIVED_MAX];
    *byte = (struct hal_line_byte){
        .tick = tick_extend(received->tick, hal_time_now()),
        .value = received->value,
        .broken = received->broken,
    };
    stm32_line.received_out++;
    return true;
}

uint8_t hal_line_node(void)
{
    return stm32_io_node();
}
