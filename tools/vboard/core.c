#include "core.h"

enum {
    SYSTICK_DIVIDER = 8,
    SYSTICK_ENABLE = 1 << 0,
    SYSTICK_TICKINT = 1 << 1,
    SYSTICK_CLKSOURCE = 1 << 2,
    SYSTICK_COUNTFLAG = 1 << 16,
};

#define SYSTICK_MASK UINT32_C(0xFFFFFF)
#define SYSTICK_CALIBRATION UINT32_C(0x40004650) /* skewed; 18750 for 1 ms at 150 MHz / 8 (RM0090 section 12.1.2) */
#define DWT_CTRL UINT32_C(0xE0001000)
#define DWT_CYCCNT UINT32_C(0xE0001004)
#define DWT_CTRL_FIXED UINT32_C(0x40000000)
#define ACTLR UINT32_C(0xE000E008)
#define SYSTICK_CTRL UINT32_C(0xE000E010)
#define SYSTICK_LOAD UINT32_C(0xE000E014)
#define SYSTICK_VAL UINT32_C(0xE000E018)
#define SYSTICK_CALIB UINT32_C(0xE000E01C)
#define NVIC_BASE UINT32_C(0xE000E100)
#define SCB_BASE UINT32_C(0xE000ED00)
#define SCB_END UINT32_C(0xE000F000)
#define DBGMCU_IDCODE UINT32_C(0xE0042000)
#define DBGMCU_CR UINT32_C(0xE0042004)
#define DBGMCU_FREEZE UINT32_C(0xE0042008)

void core_reset(struct core *core)
{
    struct debug debug = core->debug; /* survives a reset of the system (RM0090 section 38.16.3) */
    *core = (struct core){.wires = core->wires, .debug = debug};
    clock_set(core->wires.clock, EVENT_SYSTICK, VTIME_NEVER);
}

static uint64_t divider(const struct systick *systick)
{
    return systick->undivided ? 1U : SYSTICK_DIVIDER;
}

/* The counter goes from LOAD to 0, then to LOAD again: a period of LOAD + 1. An event marks each arrival at 0. */
static void schedule(struct core *core)
{
    const struct systick *systick = &core->systick;
    uint64_t counts = systick->value == 0 ? (uint64_t)systick->load + 1U : systick->value;
    bool runs = systick->enabled && (systick->value != 0 || systick->load != 0);
    clock_set(core->wires.clock, EVENT_SYSTICK, runs ? systick->anchor_cycle + counts * divider(systick) : VTIME_NEVER);
}

static uint32_t current_value(struct core *core)
{
    const struct systick *systick = &core->systick;
    uint64_t counts = (core->wires.clock->now - systick->anchor_cycle) / divider(systick);
    if (!systick->enabled || counts == 0) {
        return systick->value;
    }
    uint64_t value = systick->value == 0 ? (uint64_t)systick->load + 1U : systick->value;
    return counts < value ? (uint32_t)(value - counts) : 0;
}

static void on_systick_event(void *model, uint64_t cycle)
{
    struct core *core = model;
    struct systick *systick = &core->systick;
    systick->value = 0;
    systick->anchor_cycle = cycle;
    systick->counted = true;
    if (systick->interrupt) {
        nvic_pend(core->wires.nvic, NVIC_SYSTICK);
    }
    schedule(core);
}

static uint32_t read_systick_control(struct core *core)
{
    struct systick *systick = &core->systick;
    uint32_t value = (systick->enabled ? SYSTICK_ENABLE : 0U) | (systick->interrupt ? SYSTICK_TICKINT : 0U) |
                     (systick->undivided ? SYSTICK_CLKSOURCE : 0U) | (systick->counted ? SYSTICK_COUNTFLAG : 0U);
    systick->counted = false;
    return value;
}

static void write_systick_control(struct core *core, uint32_t value)
{
    struct systick *systick = &core->systick;
    systick->value = current_value(core);
    systick->anchor_cycle = core->wires.clock->now;
    systick->enabled = (value & SYSTICK_ENABLE) != 0;
    systick->interrupt = (value & SYSTICK_TICKINT) != 0;
    systick->undivided = (value & SYSTICK_CLKSOURCE) != 0;
    schedule(core);
}

static void write_systick_load(struct core *core, uint32_t value)
{
    struct systick *systick = &core->systick;
    systick->value = current_value(core);
    systick->anchor_cycle = core->wires.clock->now;
    systick->load = value & SYSTICK_MASK;
    schedule(core);
}

static void clear_systick(struct core *core)
{
    struct systick *systick = &core->systick;
    systick->value = 0;
    systick->counted = false;
    systick->anchor_cycle = core->wires.clock->now;
    schedule(core);
}

static uint32_t cycle_count(const struct core *core)
{
    const struct dwt *dwt = &core->dwt;
    return dwt->value + (dwt->counting ? (uint32_t)(core->wires.clock->now - dwt->anchor_cycle) : 0U);
}

static void set_cycle_count(struct core *core, uint32_t value, bool counting)
{
    bool traced = (core->wires.scb->demcr & SCB_DEMCR_TRCENA) != 0;
    core->dwt = (struct dwt){.counting = counting && traced, .value = value, .anchor_cycle = core->wires.clock->now};
}

bool core_read(struct core *core, uint32_t address, uint32_t *value)
{
    switch (address) {
    case SYSTICK_CTRL:
        *value = read_systick_control(core);
        return true;
    case SYSTICK_LOAD:
        *value = core->systick.load;
        return true;
    case SYSTICK_VAL:
        *value = current_value(core);
        return true;
    case SYSTICK_CALIB:
        *value = SYSTICK_CALIBRATION;
        return true;
    case DWT_CTRL:
        *value = DWT_CTRL_FIXED | (core->dwt.counting ? 1U : 0U);
        return true;
    case DWT_CYCCNT:
        *value = cycle_count(core);
        return true;
    case ACTLR:
        *value = 0;
        return true;
    case DBGMCU_IDCODE:
        *value = core->wires.idcode;
        return true;
    case DBGMCU_CR:
        *value = core->debug.cr;
        return true;
    case DBGMCU_FREEZE:
    case DBGMCU_FREEZE + 4U:
        *value = core->debug.freeze[(address - DBGMCU_FREEZE) / 4U];
        return true;
    default:
        break;
    }
    if (address >= SCB_BASE && address < SCB_END) {
        return scb_read(core->wires.scb, address - SCB_BASE, value);
    }
    return address >= NVIC_BASE && address < SCB_BASE && nvic_read(core->wires.nvic, address - NVIC_BASE, value);
}

bool core_write(struct core *core, uint32_t address, uint32_t value, uint32_t mask)
{
    switch (address) {
    case SYSTICK_CTRL:
        write_systick_control(core, value);
        return true;
    case SYSTICK_LOAD:
        write_systick_load(core, value);
        return true;
    case SYSTICK_VAL:
        clear_systick(core);
        return true;
    case DWT_CTRL:
        set_cycle_count(core, cycle_count(core), (value & 1U) != 0);
        return true;
    case DWT_CYCCNT:
        set_cycle_count(core, value, core->dwt.counting);
        return true;
    case DBGMCU_CR:
        core->debug.cr = value;
        return true;
    case DBGMCU_FREEZE:
    case DBGMCU_FREEZE + 4U:
        core->debug.freeze[(address - DBGMCU_FREEZE) / 4U] = value;
        return true;
    default:
        break;
    }
    if (address >= SCB_BASE && address < SCB_END) {
        return scb_write(core->wires.scb, address - SCB_BASE, value, mask);
    }
    return address >= NVIC_BASE && address < SCB_BASE && nvic_write(core->wires.nvic, address - NVIC_BASE, value, mask);
}

void core_init(struct core *core, struct core_wires wires)
{
    core->wires = wires;
    clock_attach(wires.clock, EVENT_SYSTICK, on_systick_event, core);
}
