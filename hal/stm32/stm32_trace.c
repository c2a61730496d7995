#include "hal_trace.h"

void hal_trace(uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    (void)tick;
    (void)motor;
    (void)event;
    (void)value;
}
