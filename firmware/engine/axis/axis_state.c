#include "axis_state.h"

#include <stdint.h>

enum axis_state axis_state_next(enum axis_state state, enum axis_event event)
{
    static const uint8_t next[AXIS_STATES][AXIS_EVENTS] = {
        [AXIS_STANDING] = {[AXIS_BEGIN] = AXIS_MOVING, [AXIS_REFUSE] = AXIS_ENDED},
        [AXIS_MOVING] = {[AXIS_STOP] = AXIS_BRAKING, [AXIS_HALT] = AXIS_STOPPING, [AXIS_LAST] = AXIS_ENDED},
        [AXIS_BRAKING] = {[AXIS_PLANNED] = AXIS_STOPPING, [AXIS_RESUME] = AXIS_MOVING, [AXIS_LAST] = AXIS_ENDED},
        [AXIS_STOPPING] = {[AXIS_RESUME] = AXIS_MOVING, [AXIS_LAST] = AXIS_ENDED},
        [AXIS_ENDED] = {[AXIS_TAKE] = AXIS_STANDING},
    };
    return (enum axis_state)next[state][event];
}

bool axis_state_enter(_Atomic unsigned *state, enum axis_event event)
{
    unsigned before = atomic_load_explicit(state, memory_order_acquire);
    enum axis_state next = axis_state_next((enum axis_state)before, event);
    if (next == AXIS_SAME) {
        return false;
    }
    return atomic_compare_exchange_strong_explicit(state, &before, next, memory_order_acq_rel, memory_order_relaxed);
}
