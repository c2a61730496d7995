/*
 * Exceptions: which are enabled, pending and active, and which is taken next (PM0214 sections 2.3 and 4.3, ARMv7-M
 * B1.5). Numbers are those of the vector table: 16 and more are interrupts.
 */
#ifndef NVIC_H
#define NVIC_H

#include <stdbool.h>
#include <stdint.h>

#include "clock.h"
#include "cpu.h"
#include "report.h"

enum nvic_exception {
    NVIC_NONE = 0,
    NVIC_RESET = 1,
    NVIC_NMI = 2,
    NVIC_HARD_FAULT = 3,
    NVIC_MEM_MANAGE = 4,
    NVIC_BUS_FAULT = 5,
    NVIC_USAGE_FAULT = 6,
    NVIC_SVC = 11,
    NVIC_DEBUG = 12,
    NVIC_PENDSV = 14,
    NVIC_SYSTICK = 15,
};

enum nvic_irq { /* RM0090 table 61 */
    NVIC_IRQ_PVD = 1,
    NVIC_IRQ_FLASH = 4,
    NVIC_IRQ_RCC = 5,
    NVIC_IRQ_EXTI0 = 6,
    NVIC_IRQ_EXTI1 = 7,
    NVIC_IRQ_EXTI2 = 8,
    NVIC_IRQ_EXTI3 = 9,
    NVIC_IRQ_EXTI4 = 10,
    NVIC_IRQ_DMA1_STREAM0 = 11,
    NVIC_IRQ_DMA1_STREAM1 = 12,
    NVIC_IRQ_DMA1_STREAM2 = 13,
    NVIC_IRQ_DMA1_STREAM3 = 14,
    NVIC_IRQ_DMA1_STREAM4 = 15,
    NVIC_IRQ_DMA1_STREAM5 = 16,
    NVIC_IRQ_DMA1_STREAM6 = 17,
    NVIC_IRQ_EXTI9_5 = 23,
    NVIC_IRQ_TIM2 = 28,
    NVIC_IRQ_TIM3 = 29,
    NVIC_IRQ_TIM4 = 30,
    NVIC_IRQ_USART1 = 37,
    NVIC_IRQ_USART2 = 38,
    NVIC_IRQ_USART3 = 39,
    NVIC_IRQ_EXTI15_10 = 40,
    NVIC_IRQ_DMA1_STREAM7 = 47,
    NVIC_IRQ_TIM5 = 50,
    NVIC_IRQ_DMA2_STREAM0 = 56,
    NVIC_IRQ_DMA2_STREAM1 = 57,
    NVIC_IRQ_DMA2_STREAM2 = 58,
    NVIC_IRQ_DMA2_STREAM3 = 59,
    NVIC_IRQ_DMA2_STREAM4 = 60,
    NVIC_IRQ_USB = 67, /* OTG_FS */
    NVIC_IRQ_DMA2_STREAM5 = 68,
    NVIC_IRQ_DMA2_STREAM6 = 69,
    NVIC_IRQ_DMA2_STREAM7 = 70,
};

enum {
    NVIC_IRQ0 = 16,
    NVIC_IRQS = 82,
    NVIC_EXCEPTIONS = NVIC_IRQ0 + NVIC_IRQS,
    NVIC_WORDS = 2,
    NVIC_PRIORITY_IDLE = 256, /* of thread mode without masks */
    NVIC_PRIORITY_HARD_FAULT = -1,
    NVIC_PRIORITY_NMI = -2,
};

struct nvic_wires {
    struct clock *clock;
    struct cpu *cpu; /* its masks */
    struct report *report;
};

struct nvic {
    struct nvic_wires wires;
    uint64_t enabled[NVIC_WORDS]; /* a bit an exception */
    uint64_t pending[NVIC_WORDS];
    uint64_t active[NVIC_WORDS];
    uint64_t level[NVIC_WORDS];             /* the line of the peripheral */
    uint64_t lost[NVIC_WORDS];              /* a fault: it is never taken */
    uint64_t pended_cycle[NVIC_EXCEPTIONS]; /* since when it is pending, for the latency */
    uint8_t priority[NVIC_EXCEPTIONS];
    unsigned group_bits; /* AIRCR.PRIGROUP */
};

void nvic_init(struct nvic *nvic, struct nvic_wires wires);
void nvic_reset(struct nvic *nvic);

/* Sets an exception pending, or takes that back. */
void nvic_pend(struct nvic *nvic, unsigned exception);
void nvic_unpend(struct nvic *nvic, unsigned exception);

/* The request line of an interrupt. */
void nvic_set_line(struct nvic *nvic, enum nvic_irq irq, bool level);

/* Whether the line of an interrupt is still seen high. */
bool nvic_line_is_high(const struct nvic *nvic, unsigned exception);

bool nvic_is_active(const struct nvic *nvic, unsigned exception);
void nvic_set_active(struct nvic *nvic, unsigned exception, bool active);
void nvic_enable(struct nvic *nvic, unsigned exception, bool enabled);
bool nvic_is_enabled(const struct nvic *nvic, unsigned exception);

/* Group priority of an exception, -3 to 255; what runs now, masks included; the active exceptions alone. */
int nvic_group_priority(const struct nvic *nvic, unsigned exception);
int nvic_running_priority(struct nvic *nvic);
int nvic_active_priority(const struct nvic *nvic);

/* A fault: whether an exception is never taken. */
void nvic_lose(struct nvic *nvic, unsigned exception, bool lost);

/* The pending and enabled exception that comes next, or NVIC_NONE. */
unsigned nvic_next_pending(const struct nvic *nvic);

/* Whether an exception can be taken now; whether one would wake a sleeping processor. */
bool nvic_can_take(struct nvic *nvic);
bool nvic_can_wake(struct nvic *nvic);

/* Registers at E000E100 on. False: there is none. */
bool nvic_read(struct nvic *nvic, uint32_t offset, uint32_t *value);
bool nvic_write(struct nvic *nvic, uint32_t offset, uint32_t value, uint32_t mask);

#endif
