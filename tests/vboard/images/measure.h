/*
 * Sequences of instructions between two reads of the cycle counter.
 */
#ifndef MEASURE_H
#define MEASURE_H

#include <stdint.h>

#define HUNDRED(text) ".rept 100\n" text "\n.endr\n"

typedef uint32_t measure(volatile uint32_t *counter, uint32_t *memory);

/* uint32_t NAME(counter, memory): reads the counter in r0 on both sides of the sequence; r4 points to memory. */
#define MEASURE(name, section, text)                                                                                   \
    extern measure name;                                                                                               \
    __asm__(".pushsection " section "\n .balign 16\n .thumb_func\n" #name ":\n"                                        \
            "push {r4, r5, r6, r7, lr}\n mov r4, r1\n movs r5, #100\n movs r6, #7\n ldr r2, [r0]\n nop\n" text         \
            "\n nop\n ldr r3, [r0]\n subs r0, r3, r2\n pop {r4, r5, r6, r7, pc}\n .popsection\n");

#endif
