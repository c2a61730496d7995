#include "gve_guards.h"

enum {
    BYTE_BITS = 8,
    BYTE_MASK = 0xFF,
    REFERENCES = 0x0F, /* BI1 to BI4 */
    SENSOR = 0xC0,     /* BI7, BI8 */
};

void gve_guards_init(struct gve_guards *guards)
{
    for (unsigned status = 0; status < (unsigned)GVE_STATUS_GUARDS; status++) {
        gve_guards_write(guards, (enum gve_status)status, 0);
    }
}

uint8_t gve_guards_read(const struct gve_guards *guards, enum gve_status status)
{
    return atomic_load_explicit(&guards->status[status], memory_order_relaxed);
}

void gve_guards_write(struct gve_guards *guards, enum gve_status status, uint8_t byte)
{
    atomic_store_explicit(&guards->status[status], byte, memory_order_relaxed);
}

void gve_guards_clear_causes(struct gve_guards *guards)
{
    gve_guards_write(guards, GVE_STATUS_CAUSE_1, 0);
    gve_guards_write(guards, GVE_STATUS_CAUSE_2, 0);
}

uint8_t gve_guards_port(uint8_t inputs, unsigned port)
{
    unsigned closed = inputs & (unsigned)(port == 0 ? REFERENCES : SENSOR);
    return (uint8_t)~closed;
}

/* Both bytes of a kind as one number. */
static uint16_t both(const struct gve_guards *guards, enum gve_status first)
{
    unsigned low = gve_guards_read(guards, first);
    unsigned high = gve_guards_read(guards, (enum gve_status)((unsigned)first + 1U));
    return (uint16_t)(low | (high << (unsigned)BYTE_BITS));
}

static uint16_t at_active_level(const struct gve_guards *guards, uint8_t inputs)
{
    unsigned high = (unsigned)gve_guards_port(inputs, 1) << (unsigned)BYTE_BITS;
    unsigned levels = gve_guards_port(inputs, 0) | high;
    unsigned wired = (unsigned)REFERENCES | ((unsigned)SENSOR << (unsigned)BYTE_BITS);
    return (uint16_t)(~(levels ^ both(guards, GVE_STATUS_LEVEL_1)) & wired);
}

uint16_t gve_guards_active(const struct gve_guards *guards, uint8_t inputs)
{
    return (uint16_t)(at_active_level(guards, inputs) & both(guards, GVE_STATUS_ENABLED_1));
}

bool gve_guards_switch(const struct gve_guards *guards, uint8_t inputs, unsigned axis)
{
    return (((unsigned)at_active_level(guards, inputs) >> axis) & 1U) != 0;
}

void gve_guards_add_causes(struct gve_guards *guards, uint16_t active)
{
    unsigned high = (unsigned)active >> (unsigned)BYTE_BITS;
    (void)atomic_fetch_or_explicit(&guards->status[GVE_STATUS_CAUSE_1], (uint8_t)(active & (unsigned)BYTE_MASK),
                                   memory_order_relaxed);
    (void)atomic_fetch_or_explicit(&guards->status[GVE_STATUS_CAUSE_2], (uint8_t)high, memory_order_relaxed);
}
