#include "requests.h"

#include <stdbool.h>
#include <stddef.h>

void requests_raise(struct requests *requests, unsigned timer, unsigned source, uint64_t cycle)
{
    uint32_t line = request_line(timer, source);
    if ((requests->high & line) != 0) {
        requests->lost++;
        return;
    }
    requests->high |= line;
    requests->since[timer * REQUEST_SOURCES + source] = cycle;
    if (requests->listener.note != NULL) {
        requests->listener.note(requests->listener.model, cycle);
    }
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
