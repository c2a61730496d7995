/*
 * Taking exceptions and returning from them (ARMv7-M B1.5.6 to B1.5.8, PM0214 section 2.3.7): stacking, vectors,
 * EXC_RETURN, tail-chaining, late arrival, and the way of a fault to its handler.
 */
#ifndef EXCEPTION_H
#define EXCEPTION_H

#include <stdbool.h>
#include <stdint.h>

#include "bus.h"
#include "clock.h"
#include "cpu.h"
#include "fetch.h"
#include "flash.h"
#include "iwdg.h"
#include "memory.h"
#include "nvic.h"
#include "profile.h"
#include "report.h"
#include "scb.h"
#include "stats.h"

/* What entries and returns cost without wait states. */
enum {
    EXCEPTION_ENTRY_CYCLES = 12,
    EXCEPTION_EXIT_CYCLES = 10,
    EXCEPTION_TAIL_CYCLES = 6,
};

struct exceptions {
    struct clock *clock;
    struct cpu *cpu;
    struct fetch *fetch;
    struct memory *memory;
    struct flash *flash; /* may be busy when a vector is read */
    struct nvic *nvic;
    struct scb *scb;
    const struct bus *bus;
    const struct iwdg *iwdg;
    struct stats *stats;
    struct profile *profile;
    struct report *report;
    unsigned lockups;
};

/* Takes the exception that comes next; `return_address` is where the program goes on afterwards. Returns where the
 * processor goes on now. */
uint32_t exception_take(struct exceptions *exceptions, uint32_t return_address);

/* The processor has branched to an EXC_RETURN value. `sleeps`: it goes on with sleep (SLEEPONEXIT). */
uint32_t exception_return(struct exceptions *exceptions, uint32_t exc_return, bool *sleeps);

/* A fault of the instruction at `return_address`, or before it: bits of CFSR. */
uint32_t exception_fault(struct exceptions *exceptions, uint32_t cfsr_bits, uint32_t return_address);

/* SVC and BKPT, which are taken at once. */
uint32_t exception_call(struct exceptions *exceptions, unsigned exception, uint32_t return_address);

#endif
