#include "syscfg.h"

enum {
    SYSCFG_MEMRMP = 0x00,
    SYSCFG_PMC = 0x04,
    SYSCFG_EXTICR1 = 0x08,
    SYSCFG_EXTICR4 = 0x14,
    EXTICR_BITS = 16,
};

void syscfg_reset(struct syscfg *syscfg)
{
    *syscfg = (struct syscfg){.exti = syscfg->exti};
}

bool syscfg_read(void *model, uint32_t offset, uint32_t *value)
{
    struct syscfg *syscfg = model;
    *value = 0;
    if (offset == SYSCFG_PMC) {
        *value = syscfg->pmc;
    } else if (offset >= SYSCFG_EXTICR1 && offset <= SYSCFG_EXTICR4) {
        *value = syscfg->exticr[(offset - SYSCFG_EXTICR1) / 4U];
    }
    return offset <= SYSCFG_EXTICR4;
}

/* Sections 9.2.3 to 9.2.6: four lines a register. */
static void route_lines(struct syscfg *syscfg)
{
    uint64_t ports = 0;
    for (unsigned i = 0; i < SYSCFG_EXTICRS; i++) {
        ports |= (uint64_t)syscfg->exticr[i] << EXTICR_BITS * i;
    }
    exti_route(syscfg->exti, ports);
}

/* Another memory at address 0 is not modelled. */
bool syscfg_write(void *model, uint32_t offset, uint32_t value, uint32_t mask)
{
    struct syscfg *syscfg = model;
    if (offset == SYSCFG_MEMRMP) {
        return (value & mask) == 0;
    }
    if (offset > SYSCFG_EXTICR4) {
        return false;
    }
    if (offset == SYSCFG_PMC) {
        syscfg->pmc = (syscfg->pmc & ~mask) | (value & mask);
        return true;
    }
    uint16_t *ports = &syscfg->exticr[(offset - SYSCFG_EXTICR1) / 4U];
    *ports = (uint16_t)((*ports & ~mask) | (value & mask));
    route_lines(syscfg);
    return true;
}
