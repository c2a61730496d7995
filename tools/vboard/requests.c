#include "requests.h"

#include <stdbool.h>
#include <stddef.h>

static void raise(struct requests *requests, unsigned number, uint64_t cycle)
{
    requests->high |= UINT32_C(1) << number;
    requests->since[number] = cycle;
    for (unsigned i = 0; i < REQUEST_LISTENERS; i++) {
        if (requests->listener[i].note != NULL) {
            requests->listener[i].note(requests->listener[i].model, cycle);
        }
    }
}

void requests_raise(struct requests *requests, unsigned timer, unsigned source, uint64_t cycle)
{
    uint32_t line = request_line(timer, source);
    if ((requests->high & line) != 0) {
        requests->lost++;
        return;
    }
    raise(requests, timer * REQUEST_SOURCES + source, cycle);
}

void requests_raise_receiver(struct requests *requests, uint64_t cycle)
{
    raise(requests, REQUEST_USART1_RX, cycle);
}

void requests_lower(struct requests *requests, uint32_t lines)
{
    requests->high &= ~lines;
}

uint64_t requests_since(const struct requests *requests, uint32_t lines)
{
    uint64_t since = UINT64_MAX;
    for (unsigned i = 0; i < REQUEST_LINES; i++) {
        bool asks = (requests->high & lines & UINT32_C(1) << i) != 0;
        since = asks && requests->since[i] < since ? requests->since[i] : since;
    }
    return since;
}
