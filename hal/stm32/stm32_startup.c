#include <assert.h>

#include "stm32_line.h"
#include "stm32_private.h"
#include "stm32f4.h"

/* Of the linker script. */
extern uint32_t stm32_stack_bottom[];
extern uint32_t stm32_paint_end[]; /* above it is what this file itself needs of the stack */
extern uint32_t stm32_stack_top[];
extern uint32_t stm32_vectors[];
extern const uint32_t stm32_ram_load[];
extern uint32_t stm32_ram_begin[];
extern uint32_t stm32_ram_end[];
extern uint32_t stm32_zero_begin[];
extern uint32_t stm32_zero_end[];
extern uint32_t stm32_shared_begin[];
extern uint32_t stm32_shared_end[];

int main(void);
void stm32_reset(void);

enum {
    STACK_PATTERN = 0x5AFE57AC,

    EXCEPTIONS = 16,
    IRQS = 82, /* RM0090 12.1.3 */
    VECTORS = EXCEPTIONS + IRQS,
    EXCEPTION_PENDSV = 14,
    EXCEPTION_SYSTICK = 15,
    IRQ_WORDS = (IRQS + 31) / 32,
    LAST_IRQS = (1 << IRQS % 32) - 1, /* of the last word; the rest of it is reserved */

    SRAM1_AT_0 = 3, /* RM0090 9.2.1 */

    /* What an STM32F405 or F407 has on each bus, by its bits in the reset registers (RM0090 7.3.5 to 7.3.9). */
    ON_AHB1 = 0x226011FF,
    ON_AHB2 = 0xC1,
    ON_APB1 = 0x36FEC9FF,
    ON_APB2 = 0x75933,
};

/* Before the handlers are in RAM. */
_Noreturn static void fault_early(void)
{
    SCB_AIRCR = SCB_AIRCR_RESET;
    for (;;) {
    }
}

/* What the processor needs to start; everything else comes from the table in RAM. */
struct first_vectors {
    const uint32_t *stack;
    void (*reset)(void);
    void (*nmi)(void);
    void (*hard_fault)(void);
};
extern const struct first_vectors stm32_first_vectors;
const struct first_vectors stm32_first_vectors __attribute__((section(".first_vectors"), used)) = {
    .stack = stm32_stack_top,
    .reset = stm32_reset,
    .nmi = fault_early,
    .hard_fault = fault_early,
};

/* The copies go through volatile, as a compiler would make calls of them, to functions that are not in RAM yet. */
static void copy(volatile uint32_t *to, const uint32_t *end, const uint32_t *from)
{
    while (to < end) {
        *to++ = *from++;
    }
}

static void fill(volatile uint32_t *to, const uint32_t *end, uint32_t value)
{
    while (to < end) {
        *to++ = value;
    }
}

static void set_vector(uint32_t number, void (*handler)(void))
{
    stm32_vectors[number] = (uint32_t)(uintptr_t)handler;
}

/* A boot loader may have left interrupts on, and pending; what they would lead to is gone. The groups of priorities are
 * those of a reset again: ST's driver of USB leaves one bit of four for who interrupts whom, and with that priorities 0
 * to 3 are all the same (PM0214 4.4.5). A sleep is not a deep one. */
static void silence_core(void)
{
    SCB_AIRCR = SCB_AIRCR_NO_GROUPS;
    STK_CTRL = 0;
    SCB_ICSR = SCB_ICSR_PENDSTCLR | SCB_ICSR_PENDSVCLR;
    SCB_SCR = 0;
    for (uint32_t word = 0; word < IRQ_WORDS; word++) {
        uint32_t there = word + 1U < IRQ_WORDS ? UINT32_MAX : LAST_IRQS;
        NVIC_ICER(word) = there;
        NVIC_ICPR(word) = there;
    }
}

/* And peripherals: pins at open drain, a stream that still writes into memory, a line of another format. All are as
 * after a reset again. */
static void reset_peripherals(void)
{
    RCC_AHB1RSTR = ON_AHB1;
    RCC_AHB2RSTR = ON_AHB2;
    RCC_APB1RSTR = ON_APB1;
    RCC_APB2RSTR = ON_APB2;
    stm32_barrier();
    RCC_AHB1RSTR = 0;
    RCC_AHB2RSTR = 0;
    RCC_APB1RSTR = 0;
    RCC_APB2RSTR = 0;
}

static void start_vectors(void)
{
    for (uint32_t number = 0; number < VECTORS; number++) {
        set_vector(number, stm32_fault_entry);
    }
    set_vector(EXCEPTION_PENDSV, stm32_plan_interrupt);
    set_vector(EXCEPTION_SYSTICK, stm32_tick_interrupt);
    for (unsigned input = 0; input < UNIT_INPUTS; input++) {
        set_vector(EXCEPTIONS + stm32_edge_irq(input), stm32_edge_interrupt);
    }
    set_vector(EXCEPTIONS + TIM2_IRQ, stm32_step_interrupt);
    set_vector(EXCEPTIONS + STM32_LINE_IRQ, stm32_line_interrupt);
    /* SRAM1 at address 0, where the handlers are; the read ends when it is there. */
    SYSCFG_MEMRMP = SRAM1_AT_0;
    (void)SYSCFG_MEMRMP;
    SCB_VTOR = (uint32_t)(uintptr_t)stm32_vectors;
    stm32_barrier();
}

/* Who comes here without a reset has gone astray; the memory, and the handler in it, is still in use then. The clock
 * comes first, as all the rest then takes a tenth of the time. The stack's pattern shows afterwards how much of it was
 * used. */
_Noreturn static void __attribute__((used)) start_program(void)
{
    assert(SCB_VTOR != (uint32_t)(uintptr_t)stm32_vectors);
    silence_core();
    reset_peripherals();
    struct stm32_clock clock = stm32_clock_start();
    fill(stm32_stack_bottom, stm32_paint_end, STACK_PATTERN);
    copy(stm32_ram_begin, stm32_ram_end, stm32_ram_load);
    fill(stm32_zero_begin, stm32_zero_end, 0);
    fill(stm32_shared_begin, stm32_shared_end, 0);
    stm32_board_clock = clock;
    start_vectors();
    stm32_unmask(0);
    (void)main();
    for (;;) {
    }
}

/* A boot loader may have come here from a task of its system: on another stack, which is overwritten soon; after
 * floating-point instructions, so that each frame had 18 words more (PM0214 2.3.7); with interrupts masked by more than
 * PRIMASK. And what has the stack may be switched off, or protected. SYSCFG has its clock from here on, too (RM0090
 * 7.3.10, 7.3.14; the read-back and the barrier: ES0182, as in stm32_enable_clock). */
static_assert(RCC_BASE == 0x40023800U, "stm32_reset has addresses of RCC");
__attribute__((naked)) void stm32_reset(void)
{
    __asm__ volatile("cpsid i\n\t"
                     "movs r0, #0\n\t"
                     "msr control, r0\n\t"
                     "isb\n\t"
                     "msr basepri, r0\n\t"
                     "cpsie f\n\t"
                     "ldr r1, =0xE000ED94\n\t" /* MPU_CTRL */
                     "str r0, [r1]\n\t"
                     "ldr r1, =0x40023830\n\t" /* RCC_AHB1ENR */
                     "ldr r0, [r1, #0x14]\n\t" /* RCC_APB2ENR */
                     "orr r0, r0, #0x4000\n\t" /* SYSCFGEN */
                     "str r0, [r1, #0x14]\n\t"
                     "ldr r0, [r1]\n\t"
                     "orr r0, r0, #0x100000\n\t" /* CCMDATARAMEN */
                     "str r0, [r1]\n\t"
                     "ldr r0, [r1]\n\t"
                     "dsb\n\t"
                     "ldr r0, =stm32_stack_top\n\t"
                     "mov sp, r0\n\t"
                     "b start_program\n\t");
}
