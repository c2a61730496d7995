#include "loader.h"

#include "cpu.h"
#include "nvic.h"
#include "scb.h"

#define SYSTEM_MEMORY UINT32_C(0x1FFF0000)
#define SYSTICK_CTRL UINT32_C(0xE000E010)
#define SYSTICK_LOAD UINT32_C(0xE000E014)

void loader_leave(struct core *core, struct rcc *rcc, struct flash *flash)
{
    struct scb *scb = core->wires.scb;
    struct nvic *nvic = core->wires.nvic;
    flash_set_wait_states(flash, 3);
    rcc_run_from_pll(rcc);
    flash_leave_unlocked(flash);
    scb->vtor = SYSTEM_MEMORY;
    nvic_enable(nvic, NVIC_IRQ0 + NVIC_IRQ_USB, true);
    nvic_set_line(nvic, NVIC_IRQ_USB, true); /* and stays, as nobody serves it any more */
    cpu_write(scb->wires.cpu, UC_ARM_REG_PRIMASK, 1);
    (void)core_write(core, SYSTICK_LOAD, 60000 - 1, UINT32_MAX);
    (void)core_write(core, SYSTICK_CTRL, 7, UINT32_MAX);
}
