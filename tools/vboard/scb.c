#include "scb.h"

enum {
    OFFSET_CPUID = 0x00,
    OFFSET_ICSR = 0x04,
    OFFSET_VTOR = 0x08,
    OFFSET_AIRCR = 0x0C,
    OFFSET_SCR = 0x10,
    OFFSET_CCR = 0x14,
    OFFSET_SHPR1 = 0x18,
    OFFSET_SHPR3 = 0x20,
    OFFSET_SHCSR = 0x24,
    OFFSET_CFSR = 0x28,
    OFFSET_HFSR = 0x2C,
    OFFSET_DFSR = 0x30,
    OFFSET_MMFAR = 0x34,
    OFFSET_BFAR = 0x38,
    OFFSET_AFSR = 0x3C,
    OFFSET_CPACR = 0x88,
    OFFSET_MPU_TYPE = 0x90,
    OFFSET_MPU_CTRL = 0x94,
    OFFSET_DHCSR = 0xF0,
    OFFSET_DEMCR = 0xFC,
    OFFSET_STIR = 0x200,
    OFFSET_FPCCR = 0x234,
    OFFSET_FPCAR = 0x238,
    OFFSET_FPDSCR = 0x23C,
    FIRST_WITH_PRIORITY = 4, /* exception of the lowest byte of SHPR1 */
};

#define CPUID UINT32_C(0x410FC241) /* Cortex-M4 r0p1 */
#define AIRCR_KEY UINT32_C(0x05FA)
#define AIRCR_KEY_READ UINT32_C(0xFA05)
#define AIRCR_SYSRESETREQ (UINT32_C(1) << 2)
#define VTOR_MASK UINT32_C(0x3FFFFE00)
#define CCR_RESET UINT32_C(0x200)
#define CCR_MASK UINT32_C(0x31B)
#define ICSR_NMIPENDSET (UINT32_C(1) << 31)
#define ICSR_PENDSVSET (UINT32_C(1) << 28)
#define ICSR_PENDSVCLR (UINT32_C(1) << 27)
#define ICSR_PENDSTSET (UINT32_C(1) << 26)
#define ICSR_PENDSTCLR (UINT32_C(1) << 25)
#define SHCSR_ENABLES UINT32_C(0x70000)
#define FPCCR_RESET UINT32_C(0xC0000000)
#define CPACR_FLOAT UINT32_C(0x00F00000)
#define MPU_TYPE UINT32_C(0x800) /* eight regions */

void scb_init(struct scb *scb, struct scb_wires wires)
{
    scb->wires = wires;
}

void scb_reset(struct scb *scb)
{
    *scb = (struct scb){.wires = scb->wires, .ccr = CCR_RESET, .fpccr = FPCCR_RESET};
}

bool scb_float_is_enabled(const struct scb *scb)
{
    return (scb->cpacr & CPACR_FLOAT) == CPACR_FLOAT;
}

static uint32_t read_icsr(struct scb *scb)
{
    const struct nvic *nvic = scb->wires.nvic;
    uint32_t running = cpu_read(scb->wires.cpu, UC_ARM_REG_IPSR);
    unsigned pending = nvic_next_pending(nvic);
    bool irq_pending = nvic->pending[0] >> NVIC_IRQ0 != 0 || nvic->pending[1] != 0;
    unsigned active = 0;
    for (unsigned word = 0; word < NVIC_WORDS; word++) {
        active += (unsigned)__builtin_popcountll(nvic->active[word]);
    }
    return running | (active <= 1 ? 1U << 11 : 0U) | pending << 12 | (irq_pending ? 1U << 22 : 0U) |
           ((nvic->pending[0] >> NVIC_SYSTICK & 1U) != 0 ? ICSR_PENDSTSET : 0U) |
           ((nvic->pending[0] >> NVIC_PENDSV & 1U) != 0 ? ICSR_PENDSVSET : 0U);
}

static uint32_t read_shcsr(const struct scb *scb)
{
    const struct nvic *nvic = scb->wires.nvic;
    uint32_t value = scb->shcsr_enables;
    value |= nvic_is_active(nvic, NVIC_MEM_MANAGE) ? 1U << 0 : 0U;
    value |= nvic_is_active(nvic, NVIC_BUS_FAULT) ? 1U << 1 : 0U;
    value |= nvic_is_active(nvic, NVIC_USAGE_FAULT) ? 1U << 3 : 0U;
    value |= nvic_is_active(nvic, NVIC_SVC) ? 1U << 7 : 0U;
    value |= nvic_is_active(nvic, NVIC_PENDSV) ? 1U << 10 : 0U;
    value |= nvic_is_active(nvic, NVIC_SYSTICK) ? 1U << 11 : 0U;
    return value;
}

static uint32_t read_priorities(const struct scb *scb, uint32_t offset)
{
    uint32_t value = 0;
    for (unsigned i = 0; i < 4; i++) {
        value |= (uint32_t)scb->wires.nvic->priority[FIRST_WITH_PRIORITY + (offset - OFFSET_SHPR1) + i] << 8U * i;
    }
    return value;
}

/* The registers that are no more than what was written to them. */
static uint32_t *find_plain(struct scb *scb, uint32_t offset)
{
    switch (offset) {
    case OFFSET_VTOR:
        return &scb->vtor;
    case OFFSET_SCR:
        return &scb->scr;
    case OFFSET_CCR:
        return &scb->ccr;
    case OFFSET_MMFAR:
        return &scb->mmfar;
    case OFFSET_BFAR:
        return &scb->bfar;
    case OFFSET_CPACR:
        return &scb->cpacr;
    case OFFSET_FPCCR:
        return &scb->fpccr;
    case OFFSET_FPCAR:
        return &scb->fpcar;
    case OFFSET_FPDSCR:
        return &scb->fpdscr;
    case OFFSET_DEMCR:
        return &scb->demcr;
    default:
        return NULL;
    }
}

/* The status registers of faults: writing 1 clears a bit. */
static uint32_t *find_status(struct scb *scb, uint32_t offset)
{
    switch (offset) {
    case OFFSET_CFSR:
        return &scb->cfsr;
    case OFFSET_HFSR:
        return &scb->hfsr;
    case OFFSET_DFSR:
        return &scb->dfsr;
    default:
        return NULL;
    }
}

bool scb_read(struct scb *scb, uint32_t offset, uint32_t *value)
{
    const uint32_t *known = find_plain(scb, offset);
    known = known == NULL ? find_status(scb, offset) : known;
    if (known != NULL) {
        *value = *known;
        return true;
    }
    if (offset >= OFFSET_SHPR1 && offset <= OFFSET_SHPR3) {
        *value = read_priorities(scb, offset);
        return true;
    }
    switch (offset) {
    case OFFSET_CPUID:
        *value = CPUID;
        return true;
    case OFFSET_ICSR:
        *value = read_icsr(scb);
        return true;
    case OFFSET_AIRCR:
        *value = AIRCR_KEY_READ << 16 | scb->wires.nvic->group_bits << 8;
        return true;
    case OFFSET_SHCSR:
        *value = read_shcsr(scb);
        return true;
    case OFFSET_MPU_TYPE:
        *value = MPU_TYPE;
        return true;
    case OFFSET_MPU_CTRL:
        *value = scb->mpu_ctrl;
        return true;
    case OFFSET_AFSR:
    case OFFSET_DHCSR: /* no debugger is there */
        *value = 0;
        return true;
    default:
        return false;
    }
}

static void write_icsr(struct scb *scb, uint32_t value)
{
    bool both_sv = (value & ICSR_PENDSVSET) != 0 && (value & ICSR_PENDSVCLR) != 0;
    bool both_st = (value & ICSR_PENDSTSET) != 0 && (value & ICSR_PENDSTCLR) != 0;
    if (both_sv || both_st) {
        report_fail(scb->wires.report, "SCB_ICSR: an exception is set and cleared at once (PM0214 4.4.3)");
    }
    if ((value & ICSR_NMIPENDSET) != 0) {
        nvic_pend(scb->wires.nvic, NVIC_NMI);
    }
    if ((value & ICSR_PENDSVSET) != 0) {
        nvic_pend(scb->wires.nvic, NVIC_PENDSV);
    } else if ((value & ICSR_PENDSVCLR) != 0) {
        nvic_unpend(scb->wires.nvic, NVIC_PENDSV);
    }
    if ((value & ICSR_PENDSTSET) != 0) {
        nvic_pend(scb->wires.nvic, NVIC_SYSTICK);
    } else if ((value & ICSR_PENDSTCLR) != 0) {
        nvic_unpend(scb->wires.nvic, NVIC_SYSTICK);
    }
}

static void write_aircr(struct scb *scb, uint32_t value)
{
    if (value >> 16 != AIRCR_KEY) {
        report_fail(scb->wires.report, "SCB_AIRCR: written without its key, and lost (PM0214 4.4.5)");
        return;
    }
    scb->wires.nvic->group_bits = value >> 8 & 7U;
    if ((value & AIRCR_SYSRESETREQ) != 0) {
        reset_request(scb->wires.reset, RESET_SOFTWARE);
    }
}

static void write_shcsr(struct scb *scb, uint32_t value)
{
    scb->shcsr_enables = value & SHCSR_ENABLES;
    nvic_enable(scb->wires.nvic, NVIC_MEM_MANAGE, (value >> 16 & 1U) != 0);
    nvic_enable(scb->wires.nvic, NVIC_BUS_FAULT, (value >> 17 & 1U) != 0);
    nvic_enable(scb->wires.nvic, NVIC_USAGE_FAULT, (value >> 18 & 1U) != 0);
}

static void write_priorities(struct scb *scb, uint32_t offset, uint32_t value, uint32_t mask)
{
    for (unsigned i = 0; i < 4; i++) {
        if ((mask >> 8U * i & 0xFFU) != 0) {
            scb->wires.nvic->priority[FIRST_WITH_PRIORITY + (offset - OFFSET_SHPR1) + i] =
                (uint8_t)(value >> 8U * i & 0xF0U);
        }
    }
}

static bool write_special(struct scb *scb, uint32_t offset, uint32_t value, uint32_t mask)
{
    switch (offset) {
    case OFFSET_ICSR:
        write_icsr(scb, value & mask);
        return true;
    case OFFSET_AIRCR:
        write_aircr(scb, value & mask);
        return true;
    case OFFSET_SHCSR:
        write_shcsr(scb, (scb->shcsr_enables & ~mask) | (value & mask));
        return true;
    case OFFSET_STIR:
        if ((value & mask) < NVIC_IRQS) {
            nvic_pend(scb->wires.nvic, NVIC_IRQ0 + (value & mask));
        }
        return (value & mask) < NVIC_IRQS;
    case OFFSET_MPU_CTRL: /* off */
        scb->mpu_ctrl = value & mask & ~SCB_MPU_CTRL_ENABLE;
        return (value & mask & SCB_MPU_CTRL_ENABLE) == 0;
    default:
        return false;
    }
}

bool scb_write(struct scb *scb, uint32_t offset, uint32_t value, uint32_t mask)
{
    uint32_t *plain = find_plain(scb, offset);
    uint32_t *status = find_status(scb, offset);
    clock_poke(scb->wires.clock);
    if (plain != NULL) {
        *plain = (*plain & ~mask) | (value & mask);
        scb->vtor &= VTOR_MASK;
        scb->ccr &= CCR_MASK;
        return true;
    }
    if (status != NULL) {
        *status &= ~(value & mask);
        return true;
    }
    if (offset >= OFFSET_SHPR1 && offset <= OFFSET_SHPR3) {
        write_priorities(scb, offset, value, mask);
        return true;
    }
    return write_special(scb, offset, value, mask);
}
