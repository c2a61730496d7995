#include "loader.h"

#include "cpu.h"
#include "nvic.h"
#include "scb.h"

#define SYSTEM_MEMORY UINT32_C(0x1FFF0000)
#define SYSTICK_CTRL UINT32_C(0xE000E010)
#define SYSTICK_LOAD UINT32_C(0xE000E014)

/* Of its task: in memory that is the program's from now on. */
#define TASK_STACK UINT32_C(0x20004000)

enum {
    OTYPER = 0x04,
    ONE_BIT_OF_GROUP = 6, /* PRIGROUP, of four bits of priority; PM0214 4.4.5 */
    ON_PROCESS_STACK = 2, /* CONTROL, 2.1.3 */
    WITH_FLOATS = 4,
    CRITICAL = 0x10, /* BASEPRI: all but the highest priority are masked */
};

/* Its I2C: PA8 and PC9, PB6 and PB7. */
static void leave_open_drain(struct gpio *gpio)
{
    static const uint32_t pins[] = {1U << 8, 1U << 6 | 1U << 7, 1U << 9};
    for (unsigned i = 0; i < sizeof pins / sizeof *pins; i++) {
        (void)gpio_write(&gpio->port[i], OTYPER, pins[i], UINT32_MAX);
    }
}

/* In a task of its system, which has computed with floating-point numbers, and in which everything is masked. */
static void leave_task(struct cpu *cpu)
{
    cpu_write(cpu, UC_ARM_REG_PSP, TASK_STACK);
    cpu_write(cpu, UC_ARM_REG_CONTROL, ON_PROCESS_STACK | WITH_FLOATS);
    cpu_write(cpu, UC_ARM_REG_PRIMASK, 1);
    cpu_write(cpu, UC_ARM_REG_FAULTMASK, 1);
    cpu_write(cpu, UC_ARM_REG_BASEPRI, CRITICAL);
}

void loader_leave(struct core *core, struct rcc *rcc, struct flash *flash, struct gpio *gpio, struct iwdg *iwdg)
{
    struct scb *scb = core->wires.scb;
    struct nvic *nvic = core->wires.nvic;
    flash_set_wait_states(flash, 3);
    rcc_run_from_pll(rcc);
    flash_leave_unlocked(flash);
    leave_open_drain(gpio);
    iwdg_leave_slow(iwdg);
    scb->vtor = SYSTEM_MEMORY;
    nvic->group_bits = ONE_BIT_OF_GROUP;
    nvic_enable(nvic, NVIC_IRQ0 + NVIC_IRQ_USB, true);
    nvic_set_line(nvic, NVIC_IRQ_USB, true); /* and stays, as nobody serves it any more */
    scb->scr = SCB_SCR_SLEEPDEEP;
    scb->mpu_ctrl = SCB_MPU_CTRL_ENABLE;
    leave_task(scb->wires.cpu);
    (void)core_write(core, SYSTICK_LOAD, 60000 - 1, UINT32_MAX);
    (void)core_write(core, SYSTICK_CTRL, 7, UINT32_MAX);
}
