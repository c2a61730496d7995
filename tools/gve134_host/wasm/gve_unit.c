#include "gve_unit.h"

#include "gve_kind.h"

struct paced_line *gve_unit_begin(uint64_t real_ns)
{
    return paced_line_begin(&gve_kind_of_unit, gve_byte_ticks(GVE_BAUD), real_ns);
}
