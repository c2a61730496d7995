/*
 * The processor: its registers, which Unicorn holds, where it stands in the program, and what each instruction costs.
 */
#ifndef CPU_H
#define CPU_H

#include <stdbool.h>
#include <stdint.h>
#include <unicorn/unicorn.h>

#include "cost.h"

/* Why emulation has been stopped. */
enum cpu_stop {
    CPU_RUNS,
    CPU_STOP_BOUNDARY, /* an exception can be taken, or the board wants something */
    CPU_STOP_SLEEP,
    CPU_STOP_SLEEP_EVENT,
    CPU_STOP_HOLD,  /* a fault: the instruction is never done */
    CPU_STOP_TRAP,  /* Unicorn saw an exception: `trap` */
    CPU_STOP_FAULT, /* a memory access failed: `fault_bits`, `fault_address` */
};

enum {
    CPU_TRAP_UNDEFINED = 1,
    CPU_TRAP_SVC = 2,
    CPU_TRAP_NO_CODE = 3, /* nothing may be executed there */
    CPU_TRAP_BKPT = 7,
    CPU_TRAP_EXCEPTION_RETURN = 8,
    CPU_TRAP_NO_COPROCESSOR = 17,
    CPU_TRAP_STATE = 18,
    CPU_TRAP_UNALIGNED = 22,
};

struct cpu {
    uint32_t at;      /* the instruction that runs */
    uint32_t next;    /* the one after it */
    uint32_t it_end;  /* end of the IT block entered last */
    uint32_t last;    /* enum cost_flag of the instruction before */
    uint32_t refill;  /* P: cycles to refill the pipeline at a taken branch */
    bool counted_all; /* emulation has been told to stop: the hook does nothing any more */
    struct cost_table cost;

    uc_engine *engine;
    enum cpu_stop stop;
    uint32_t trap;
    uint32_t fault_at;      /* address of the instruction */
    uint32_t fault_address; /* that it accessed */
    uint32_t fault_bits;    /* of CFSR */
    bool event_register;
    bool stalled_forever; /* lockup, or the clock has stopped: only a reset helps */
    uint64_t instructions;
};

/* Makes an engine with the registers of a Cortex-M4. False: there is not memory enough. */
bool cpu_open(struct cpu *cpu);
void cpu_discard(struct cpu *cpu);

/* Registers and masks after a reset; then where it begins. */
void cpu_clear(struct cpu *cpu);
void cpu_start(struct cpu *cpu, uint32_t sp, uint32_t address);

/* A register, by its number in Unicorn. */
uint32_t cpu_read(struct cpu *cpu, int reg);
void cpu_write(struct cpu *cpu, int reg, uint32_t value);

/* Writes xPSR with the exception number in it, and lets Unicorn notice the change of mode. */
void cpu_write_xpsr(struct cpu *cpu, uint32_t xpsr);

#endif
