#include "nvic.h"

enum {
    PRIORITY_MASK = 0xF0, /* four bits are implemented (RM0090 section 12.1.1) */
    PRIORITY_BITS = 8,
    IRQ_WORDS = (NVIC_IRQS + 31) / 32,
    WORD_BITS = 64,
    OFFSET_ENABLE = 0x000,
    OFFSET_DISABLE = 0x080,
    OFFSET_PEND = 0x100,
    OFFSET_UNPEND = 0x180,
    OFFSET_ACTIVE = 0x200,
    OFFSET_PRIORITY = 0x300,
};

static bool get(const uint64_t *words, unsigned exception)
{
    return (words[exception / WORD_BITS] >> exception % WORD_BITS & 1U) != 0;
}

static void set(uint64_t *words, unsigned exception, bool value)
{
    uint64_t bit = UINT64_C(1) << exception % WORD_BITS;
    words[exception / WORD_BITS] = value ? words[exception / WORD_BITS] | bit : words[exception / WORD_BITS] & ~bit;
}

void nvic_init(struct nvic *nvic, struct nvic_wires wires)
{
    nvic->wires = wires;
}

void nvic_reset(struct nvic *nvic)
{
    *nvic = (struct nvic){.wires = nvic->wires};
    static const uint8_t always[] = {NVIC_NMI, NVIC_HARD_FAULT, NVIC_SVC, NVIC_PENDSV, NVIC_SYSTICK};
    for (unsigned i = 0; i < sizeof always; i++) {
        set(nvic->enabled, always[i], true);
    }
}

void nvic_pend(struct nvic *nvic, unsigned exception)
{
    if (!get(nvic->pending, exception)) {
        set(nvic->pending, exception, true);
        nvic->pended_cycle[exception] = nvic->wires.clock->moment;
        clock_poke(nvic->wires.clock);
    }
}

void nvic_unpend(struct nvic *nvic, unsigned exception)
{
    set(nvic->pending, exception, false);
}

void nvic_set_line(struct nvic *nvic, enum nvic_irq irq, bool level)
{
    unsigned exception = NVIC_IRQ0 + (unsigned)irq;
    if (get(nvic->level, exception) == level) {
        return;
    }
    set(nvic->level, exception, level);
    if (level) {
        nvic_pend(nvic, exception);
    }
}

bool nvic_line_is_high(const struct nvic *nvic, unsigned exception)
{
    return get(nvic->level, exception);
}

bool nvic_is_active(const struct nvic *nvic, unsigned exception)
{
    return get(nvic->active, exception);
}

void nvic_set_active(struct nvic *nvic, unsigned exception, bool active)
{
    set(nvic->active, exception, active);
}

void nvic_enable(struct nvic *nvic, unsigned exception, bool enabled)
{
    set(nvic->enabled, exception, enabled);
}

bool nvic_is_enabled(const struct nvic *nvic, unsigned exception)
{
    return get(nvic->enabled, exception);
}

/* The part of a priority that decides about pre-emption (PM0214 table 51). */
static int group_part(const struct nvic *nvic, unsigned priority)
{
    return (int)(priority >> (nvic->group_bits + 1U) << (nvic->group_bits + 1U));
}

int nvic_group_priority(const struct nvic *nvic, unsigned exception)
{
    switch (exception) {
    case NVIC_RESET:
        return -3;
    case NVIC_NMI:
        return NVIC_PRIORITY_NMI;
    case NVIC_HARD_FAULT:
        return NVIC_PRIORITY_HARD_FAULT;
    default:
        return group_part(nvic, nvic->priority[exception]);
    }
}

int nvic_active_priority(const struct nvic *nvic)
{
    int priority = NVIC_PRIORITY_IDLE;
    for (unsigned word = 0; word < NVIC_WORDS; word++) {
        for (uint64_t bits = nvic->active[word]; bits != 0; bits &= bits - 1U) {
            int other = nvic_group_priority(nvic, word * WORD_BITS + (unsigned)__builtin_ctzll(bits));
            priority = other < priority ? other : priority;
        }
    }
    return priority;
}

static int base_priority(struct nvic *nvic)
{
    uint32_t base = cpu_read(nvic->wires.cpu, UC_ARM_REG_BASEPRI);
    if ((base & ~(uint32_t)PRIORITY_MASK) != 0) {
        report_fail(nvic->wires.report,
                    "BASEPRI is %02x: four bits of a priority are implemented, the upper ones (PM0214 2.1.3)",
                    (unsigned)base);
    }
    base &= PRIORITY_MASK;
    return base == 0 ? NVIC_PRIORITY_IDLE : group_part(nvic, base);
}

static int lower(int a, int b)
{
    return a < b ? a : b;
}

int nvic_running_priority(struct nvic *nvic)
{
    int priority = lower(nvic_active_priority(nvic), base_priority(nvic));
    if ((cpu_read(nvic->wires.cpu, UC_ARM_REG_PRIMASK) & 1U) != 0) {
        priority = lower(priority, 0);
    }
    if ((cpu_read(nvic->wires.cpu, UC_ARM_REG_FAULTMASK) & 1U) != 0) {
        priority = lower(priority, NVIC_PRIORITY_HARD_FAULT);
    }
    return priority;
}

/* Order among what is pending: group priority, sub-priority, number. The whole priority gives the first two. */
static int pending_order(const struct nvic *nvic, unsigned exception)
{
    return exception < NVIC_MEM_MANAGE ? nvic_group_priority(nvic, exception) : nvic->priority[exception];
}

void nvic_lose(struct nvic *nvic, unsigned exception, bool lost)
{
    set(nvic->lost, exception, lost);
    clock_poke(nvic->wires.clock);
}

unsigned nvic_next_pending(const struct nvic *nvic)
{
    unsigned best = NVIC_NONE;
    for (unsigned word = 0; word < NVIC_WORDS; word++) {
        uint64_t bits = nvic->pending[word] & nvic->enabled[word] & ~nvic->lost[word];
        for (; bits != 0; bits &= bits - 1U) {
            unsigned exception = word * WORD_BITS + (unsigned)__builtin_ctzll(bits);
            if (best == NVIC_NONE || pending_order(nvic, exception) < pending_order(nvic, best)) {
                best = exception;
            }
        }
    }
    return best;
}

bool nvic_can_take(struct nvic *nvic)
{
    unsigned next = nvic_next_pending(nvic);
    if (next == NVIC_NONE || nvic_group_priority(nvic, next) >= nvic_active_priority(nvic)) {
        return false;
    }
    return nvic_group_priority(nvic, next) < nvic_running_priority(nvic);
}

/* PM0214 section 2.5.1: PRIMASK does not keep the processor asleep. */
bool nvic_can_wake(struct nvic *nvic)
{
    unsigned next = nvic_next_pending(nvic);
    return next != NVIC_NONE &&
           nvic_group_priority(nvic, next) < lower(nvic_active_priority(nvic), base_priority(nvic));
}

static uint32_t get_word(const uint64_t *words, unsigned word)
{
    unsigned bit = NVIC_IRQ0 + 32U * word;
    uint64_t low = words[bit / WORD_BITS] >> bit % WORD_BITS;
    uint64_t high = bit % WORD_BITS > 32 && bit / WORD_BITS + 1U < NVIC_WORDS
                        ? words[bit / WORD_BITS + 1U] << (WORD_BITS - bit % WORD_BITS)
                        : 0;
    return (uint32_t)(low | high);
}

bool nvic_read(struct nvic *nvic, uint32_t offset, uint32_t *value)
{
    unsigned word = (offset & 0x7FU) / 4U;
    if (offset >= OFFSET_PRIORITY && offset - OFFSET_PRIORITY < NVIC_IRQS) {
        *value = 0;
        for (unsigned i = 0; i < 4 && NVIC_IRQ0 + offset - OFFSET_PRIORITY + i < NVIC_EXCEPTIONS; i++) {
            *value |= (uint32_t)nvic->priority[NVIC_IRQ0 + offset - OFFSET_PRIORITY + i] << PRIORITY_BITS * i;
        }
        return true;
    }
    if (offset >= OFFSET_PRIORITY || word >= IRQ_WORDS) {
        return false;
    }
    switch (offset & ~0x7FU) {
    case OFFSET_ENABLE:
    case OFFSET_DISABLE:
        *value = get_word(nvic->enabled, word);
        return true;
    case OFFSET_PEND:
    case OFFSET_UNPEND:
        *value = get_word(nvic->pending, word);
        return true;
    case OFFSET_ACTIVE:
        *value = get_word(nvic->active, word);
        return true;
    default:
        return false;
    }
}

static void write_bit(struct nvic *nvic, uint32_t offset, unsigned exception)
{
    switch (offset & ~0x7FU) {
    case OFFSET_ENABLE:
        set(nvic->enabled, exception, true);
        break;
    case OFFSET_DISABLE:
        set(nvic->enabled, exception, false);
        break;
    case OFFSET_PEND:
        nvic_pend(nvic, exception);
        break;
    default:
        /* A line that is high pends it again at once. */
        set(nvic->pending, exception, get(nvic->level, exception));
        break;
    }
}

/* Four exceptions from the first one on. */
static void write_priorities(struct nvic *nvic, unsigned first, uint32_t value, uint32_t mask)
{
    for (unsigned i = 0; i < 4 && first + i < NVIC_EXCEPTIONS; i++) {
        if ((mask >> PRIORITY_BITS * i & 0xFFU) != 0) {
            nvic->priority[first + i] = (uint8_t)(value >> PRIORITY_BITS * i & PRIORITY_MASK);
        }
    }
}

bool nvic_write(struct nvic *nvic, uint32_t offset, uint32_t value, uint32_t mask)
{
    clock_poke(nvic->wires.clock);
    if (offset >= OFFSET_PRIORITY && offset - OFFSET_PRIORITY < NVIC_IRQS) {
        write_priorities(nvic, NVIC_IRQ0 + offset - OFFSET_PRIORITY, value, mask);
        return true;
    }
    unsigned word = (offset & 0x7FU) / 4U;
    if (offset >= OFFSET_ACTIVE || word >= IRQ_WORDS) {
        return false;
    }
    for (unsigned i = 0; i < 32 && 32U * word + i < NVIC_IRQS; i++) {
        if ((value & mask) >> i & 1U) {
            write_bit(nvic, offset, NVIC_IRQ0 + 32U * word + i);
        }
    }
    return true;
}
