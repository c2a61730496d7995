#include "cpu.h"

#define XPSR_THUMB (UINT32_C(1) << 24)
#define LR_RESET UINT32_C(0xFFFFFFFF)

bool cpu_open(struct cpu *cpu)
{
    return cost_init(&cpu->cost) &&
           uc_open(UC_ARCH_ARM, (uc_mode)(UC_MODE_THUMB | UC_MODE_MCLASS), &cpu->engine) == UC_ERR_OK &&
           uc_ctl_set_cpu_model(cpu->engine, UC_CPU_ARM_CORTEX_M4) == UC_ERR_OK;
}

void cpu_discard(struct cpu *cpu)
{
    cost_discard(&cpu->cost);
    if (cpu->engine != NULL) {
        (void)uc_close(cpu->engine);
    }
}

uint32_t cpu_read(struct cpu *cpu, int reg)
{
    uint32_t value = 0;
    (void)uc_reg_read(cpu->engine, reg, &value);
    return value;
}

void cpu_write(struct cpu *cpu, int reg, uint32_t value)
{
    (void)uc_reg_write(cpu->engine, reg, &value);
}

/* Unicorn 2.0 forgets to refresh its notion of the mode here; the second write, of the same flags, makes it. */
void cpu_write_xpsr(struct cpu *cpu, uint32_t xpsr)
{
    cpu_write(cpu, UC_ARM_REG_XPSR_NZCVQG, xpsr);
    cpu_write(cpu, UC_ARM_REG_APSR_NZCV, xpsr);
}

void cpu_clear(struct cpu *cpu)
{
    cpu_write(cpu, UC_ARM_REG_CONTROL, 0);
    cpu_write(cpu, UC_ARM_REG_PRIMASK, 0);
    cpu_write(cpu, UC_ARM_REG_FAULTMASK, 0);
    cpu_write(cpu, UC_ARM_REG_BASEPRI, 0);
    cpu_write_xpsr(cpu, XPSR_THUMB);
}

void cpu_start(struct cpu *cpu, uint32_t sp, uint32_t address)
{
    cpu_write(cpu, UC_ARM_REG_SP, sp);
    cpu_write(cpu, UC_ARM_REG_LR, LR_RESET);
    cpu->event_register = false;
    cpu->next = address;
}
