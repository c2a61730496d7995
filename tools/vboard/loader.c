#include "loader.h"

#include "cpu.h"
#include "nvic.h"
#include "scb.h"

#define SYSTEM_MEMORY UINT32_C(0x1FFF0000)
#define SYSTICK_CTRL UINT32_C(0xE000E010)
#define SYSTICK_LOAD UINT32_C(0xE000E014)

enum {
    OTYPER = 0x04,
    ONE_BIT_OF_GROUP = 6, /* PRIGROUP, of four bits of priority; PM0214 4.4.5 */
};

/* Its I2C: PA8 and PC9, PB6 and PB7. */
static void leave_open_drain(struct gpio *gpio)
{
    static const uint32_t pins[] = {1U << 8, 1U << 6 | 1U << 7, 1U << 9};
    for (unsigned i = 0; i < sizeof pins / sizeof *pins; i++) {
        (void)gpio_write(&gpio->port[i], OTYPER, pins[i], UINT32_MAX);
    }
}

void loader_leave(struct core *core, struct rcc *rcc, struct flash *flash, struct gpio *gpio)
{
    struct scb *scb = core->wires.scb;
    struct nvic *nvic = core->wires.nvic;
    flash_set_wait_states(flash, 3);
    rcc_run_from_pll(rcc);
    flash_leave_unlocked(flash);
    leave_open_drain(gpio);
    scb->vtor = SYSTEM_MEMORY;
    nvic->group_bits = ONE_BIT_OF_GROUP;
    nvic_enable(nvic, NVIC_IRQ0 + NVIC_IRQ_USB, true);
    nvic_set_line(nvic, NVIC_IRQ_USB, true); /* and stays, as nobody serves it any more */
    cpu_write(scb->wires.cpu, UC_ARM_REG_PRIMASK, 1);
    (void)core_write(core, SYSTICK_LOAD, 60000 - 1, UINT32_MAX);
    (void)core_write(core, SYSTICK_CTRL, 7, UINT32_MAX);
}
