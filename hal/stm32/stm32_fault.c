#include <assert.h>

#include "hal_board.h"
#include "stm32_private.h"
#include "stm32f4.h"

enum {
    FRAME_PC = 6,
    FRAME_WORDS = 8,
    EXCEPTION_MASK = 0x1FF,
    EXCEPTIONS = 16 /* of the processor, PM0214 2.3.2 */
};

extern uint32_t stm32_stack_bottom[];
extern uint32_t stm32_stack_top[];

struct stm32_fault stm32_fault_record __attribute__((section(".noinit")));

_Noreturn static void stop(uint32_t cause, uint32_t exception, uint32_t pc)
{
    stm32_step_make_safe();
    stm32_pins_make_safe();
    stm32_pwm_make_safe();
    stm32_fault_record = (struct stm32_fault){
        .magic = STM32_FAULT_MAGIC,
        .cause = cause,
        .exception = exception,
        .status = SCB_CFSR,
        .hard = SCB_HFSR,
        .address = SCB_BFAR,
        .pc = pc,
        .count = stm32_fault_record.count + 1U,
    };
    stm32_barrier();
    SCB_AIRCR = SCB_AIRCR_RESET;
    for (;;) {
    }
}

/* `frame` is where the stack stood: below its end after an overflow, and then not to be read. */
_Noreturn void stm32_fault_stop(const uint32_t *frame, uint32_t exception)
{
    bool readable = frame >= stm32_stack_bottom && frame + FRAME_WORDS <= stm32_stack_top;
    stop(HAL_BOARD_CAUSE_FAULT, exception & EXCEPTION_MASK, readable ? frame[FRAME_PC] : 0);
}

/* Nothing of the stack may be used before it is set up anew: its end may be why this runs. */
__attribute__((naked)) void stm32_fault_entry(void)
{
    __asm__ volatile("cpsid i\n\t"
                     "mov r0, sp\n\t"
                     "mrs r1, ipsr\n\t"
                     "movw r2, #:lower16:stm32_stack_top\n\t"
                     "movt r2, #:upper16:stm32_stack_top\n\t"
                     "mov sp, r2\n\t"
                     "b stm32_fault_stop\n\t");
}

_Noreturn void stm32_fault_stop_output(void)
{
    (void)stm32_mask();
    stop(HAL_BOARD_CAUSE_FAULT, EXCEPTIONS + TIM2_IRQ, (uint32_t)(uintptr_t)__builtin_return_address(0));
}

/* Where assert ends. */
void __assert_func(const char *file, int line, const char *function, const char *expression)
{
    (void)file;
    (void)line;
    (void)function;
    (void)expression;
    (void)stm32_mask();
    stop(HAL_BOARD_CAUSE_FAULT, 0, (uint32_t)(uintptr_t)__builtin_return_address(0));
}
