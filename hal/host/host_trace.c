#include "hal_trace.h"

#include "host_private.h"

void hal_trace(uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value)
{
    struct host_machine *machine = host_current();
    assert(motor <= UNIT_MOTORS);
    if (machine->listener.trace != NULL) {
        machine->listener.trace(machine->listener.context, tick - machine->epoch, motor, event, value);
    }
}
