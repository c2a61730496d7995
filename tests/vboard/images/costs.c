/* Cycles of sequences of instructions, in RAM and in flash; 100 of each, less an empty sequence. */
#include "measure.h"
#include "part.h"

#define BOTH(name, text)                                                                                               \
    MEASURE(name##_ram, ".ramcode, \"ax\"", text)                                                                      \
    MEASURE(name##_flash, ".text.measured, \"ax\"", text)

BOTH(empty, "")
BOTH(alu, HUNDRED("adds r3, r3, #1"))
BOTH(wide_alu, HUNDRED("add.w r3, r3, #1"))
BOTH(multiply, HUNDRED("umull r3, r7, r5, r6"))
BOTH(loads, HUNDRED("ldr r3, [r4]"))
BOTH(lone_loads, HUNDRED("ldr r3, [r4]\n nop"))
BOTH(chained_loads, HUNDRED("ldr r4, [r4]"))
BOTH(stores, HUNDRED("str r3, [r4]"))
BOTH(multiple, HUNDRED("ldmia r4, {r3, r6, r7}"))
BOTH(doubles, HUNDRED("ldrd r6, r7, [r4]"))
BOTH(branches, HUNDRED("b 1f\n nop\n1:"))
BOTH(not_taken, "cmp r5, r5\n" HUNDRED("bne 1f\n1:"))
BOTH(skipped, "cmp r5, r5\n" HUNDRED("it ne\n addne r3, r3, #1"))
BOTH(skipped_wide, "cmp r5, r5\n" HUNDRED("itt ne\n addne.w r3, r3, #1\n addne r3, r3, #1"))
BOTH(divide_small, HUNDRED("udiv r3, r6, r5"))
BOTH(divide_large, "mov r12, lr\n mvns r7, r6\n mov lr, #1\n" HUNDRED("udiv r3, r7, lr") "mov lr, r12\n")

static uint32_t memory[4] = {(uint32_t)(uintptr_t)memory, 1, 2, 3};

#define PAIR(index, name)                                                                                              \
    result[2 * (index)] = name##_ram(counter, memory) - empty_ram(counter, memory);                                    \
    result[2 * (index) + 1] = name##_flash(counter, memory) - empty_flash(counter, memory)

int main(void)
{
    run_at_168_mhz();
    volatile uint32_t *counter = &DWT_CYCCNT;
    PAIR(0, alu);
    PAIR(1, wide_alu);
    PAIR(2, multiply);
    PAIR(3, loads);
    PAIR(4, lone_loads);
    PAIR(5, chained_loads);
    memory[0] = (uint32_t)(uintptr_t)memory;
    PAIR(7, multiple);
    PAIR(8, doubles);
    PAIR(6, stores);
    PAIR(9, branches);
    PAIR(10, not_taken);
    PAIR(11, skipped);
    PAIR(12, skipped_wide);
    PAIR(13, divide_small);
    PAIR(14, divide_large);
    return 0;
}
