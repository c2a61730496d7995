#include "syscfg.h"

enum {
    SYSCFG_MEMRMP = 0x00,
    SYSCFG_PMC = 0x04,
    SYSCFG_EXTICR1 = 0x08,
    SYSCFG_EXTICR4 = 0x14,
    EXTICR_BITS = 16,
    MEM_MODE_FLASH = 0,
    MEM_MODE_SRAM1 = 3,
};

/* Section 9.2.1; the system memory and the bus of external memories at address 0 are not modelled. */
static bool remap(struct syscfg *syscfg, uint32_t mode)
{
    syscfg->memrmp = mode;
    memory_put_at_0(syscfg->memory, mode == MEM_MODE_SRAM1);
    clock_poke(syscfg->clock);
    return mode == MEM_MODE_FLASH || mode == MEM_MODE_SRAM1;
}

void syscfg_reset(struct syscfg *syscfg)
{
    *syscfg = (struct syscfg){.exti = syscfg->exti, .memory = syscfg->memory, .clock = syscfg->clock};
    (void)remap(syscfg, MEM_MODE_FLASH);
}

bool syscfg_read(void *model, uint32_t offset, uint32_t *value)
{
    struct syscfg *syscfg = model;
    *value = 0;
    if (offset == SYSCFG_MEMRMP) {
        *value = syscfg->memrmp;
    } else if (offset == SYSCFG_PMC) {
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

bool syscfg_write(void *model, uint32_t offset, uint32_t value, uint32_t mask)
{
    struct syscfg *syscfg = model;
    if (offset == SYSCFG_MEMRMP) {
        return remap(syscfg, (syscfg->memrmp & ~mask) | (value & mask));
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
