#include "hal_time.h"

#include "host_private.h"

uint64_t hal_time_now(void)
{
    return host_unit_time(host_current());
}
