#include "pos_unit.h"

#include "pos_kind.h"

/* Main has a pass after each byte: else bytes that come on the same tick overrun it. */
enum {
    BYTE_TICKS = 1
};

struct paced_line *pos_unit_begin(uint64_t real_ns)
{
    return paced_line_begin(&pos_kind_of_unit, BYTE_TICKS, real_ns);
}
