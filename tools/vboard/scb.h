/*
 * System control block, with the floating-point context registers and the debug registers that a program may look at
 * (PM0214 section 4.4; ARMv7-M C1.6 for DEMCR).
 */
#ifndef SCB_H
#define SCB_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "cpu.h"
#include "nvic.h"
#include "report.h"
#include "reset.h"

#define SCB_MPU_CTRL_ENABLE UINT32_C(1)
#define SCB_CFSR_IACCVIOL (UINT32_C(1) << 0)
#define SCB_CFSR_IBUSERR (UINT32_C(1) << 8)
#define SCB_CFSR_PRECISERR (UINT32_C(1) << 9)
#define SCB_CFSR_UNSTKERR (UINT32_C(1) << 11)
#define SCB_CFSR_STKERR (UINT32_C(1) << 12)
#define SCB_CFSR_BFARVALID (UINT32_C(1) << 15)
#define SCB_CFSR_UNDEFINSTR (UINT32_C(1) << 16)
#define SCB_CFSR_INVSTATE (UINT32_C(1) << 17)
#define SCB_CFSR_INVPC (UINT32_C(1) << 18)
#define SCB_CFSR_NOCP (UINT32_C(1) << 19)
#define SCB_CFSR_UNALIGNED (UINT32_C(1) << 24)
#define SCB_CFSR_DIVBYZERO (UINT32_C(1) << 25)
#define SCB_CFSR_MEMORY UINT32_C(0x000000FF)
#define SCB_CFSR_USAGE UINT32_C(0xFFFF0000)
#define SCB_HFSR_VECTTBL (UINT32_C(1) << 1)
#define SCB_HFSR_FORCED (UINT32_C(1) << 30)
#define SCB_HFSR_DEBUGEVT (UINT32_C(1) << 31)
#define SCB_SCR_SLEEPONEXIT (UINT32_C(1) << 1)
#define SCB_SCR_SLEEPDEEP (UINT32_C(1) << 2)
#define SCB_SCR_SEVONPEND (UINT32_C(1) << 4)
#define SCB_DEMCR_TRCENA (UINT32_C(1) << 24)

struct scb_wires {
    struct clock *clock;
    struct cpu *cpu;
    struct nvic *nvic;
    struct report *report;
    struct reset *reset;
};

struct scb {
    struct scb_wires wires;
    uint32_t vtor;
    uint32_t scr;
    uint32_t ccr;
    uint32_t shcsr_enables;
    uint32_t cfsr;
    uint32_t hfsr;
    uint32_t dfsr;
    uint32_t mmfar;
    uint32_t bfar;
    uint32_t cpacr;
    uint32_t fpccr;
    uint32_t fpcar;
    uint32_t fpdscr;
    uint32_t demcr;
    uint32_t mpu_ctrl; /* on only if a boot loader has left it so */
};

void scb_init(struct scb *scb, struct scb_wires wires);
void scb_reset(struct scb *scb);

/* Registers at E000ED00 on, and those at E000E004 and E000EF00. False: there is none. */
bool scb_read(struct scb *scb, uint32_t offset, uint32_t *value);
bool scb_write(struct scb *scb, uint32_t offset, uint32_t value, uint32_t mask);

/* Whether the MPU is on, by which nothing in SRAM may be executed. */
static inline bool scb_mpu_is_on(const struct scb *scb)
{
    return (scb->mpu_ctrl & SCB_MPU_CTRL_ENABLE) != 0;
}

/* Whether floating-point instructions may run: CPACR gives full access to both coprocessors. */
bool scb_float_is_enabled(const struct scb *scb);

#endif
