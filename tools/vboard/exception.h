/*
 * Taking exceptions and returning from them (ARMv7-M B1.5.6 to B1.5.8, PM0214 section 2.3.7): stacking, vectors,
 * EXC_RETURN, tail-chaining, late arrival, and the way of a fault to its handler.
 */
#ifndef EXCEPTION_H
#define EXCEPTION_H

#include <stdbool.h>
#include <stdint.h>

struct board;

/* What entries and returns cost without wait states. */
enum {
    EXCEPTION_ENTRY_CYCLES = 12,
    EXCEPTION_EXIT_CYCLES = 10,
    EXCEPTION_TAIL_CYCLES = 6,
};

/* Takes the exception that comes next; `return_address` is where the program goes on afterwards. Returns where the
 * processor goes on now. */
uint32_t exception_take(struct board *board, uint32_t return_address);

/* The processor has branched to an EXC_RETURN value. */
uint32_t exception_return(struct board *board, uint32_t exc_return);

/* A fault of the instruction at `return_address`, or behind it: bits of CFSR. */
uint32_t exception_fault(struct board *board, uint32_t cfsr_bits, uint32_t return_address);

/* SVC and BKPT, which are taken at once. */
uint32_t exception_call(struct board *board, unsigned exception, uint32_t return_address);

#endif
