/*
 * The processor: Unicorn runs the instructions, a hook before each one counts cycles and finds the moment at which
 * something else is due. Emulation is only ever stopped from that hook, never inside an IT block.
 */
#ifndef CPU_H
#define CPU_H

#include <stdbool.h>
#include <stdint.h>
#include <unicorn/unicorn.h>

#include "cost.h"

struct board;

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

enum {
    CPU_ART_LINES = 64, /* of 128 bits, for instructions (RM0090 section 3.5.2) */
    CPU_ART_DATA_LINES = 8,
};

struct art {
    uint32_t tag[CPU_ART_LINES + CPU_ART_DATA_LINES];
    uint64_t used[CPU_ART_LINES + CPU_ART_DATA_LINES];
    uint64_t clock;
};

struct cpu {
    uint64_t now;       /* cycles; inside an instruction: at its end */
    uint64_t deadline;  /* from this cycle on the next boundary is looked at; 0: at once */
    uint32_t at;        /* the instruction that runs */
    uint32_t next;      /* the one behind it */
    uint32_t it_end;    /* end of the IT block entered last */
    uint32_t last;      /* enum cost_flag of the instruction before */
    uint32_t line_mask; /* of the line of the flash that is executed; 0 outside the flash */
    uint32_t line;
    uint64_t line_cycle; /* when it was there */
    uint32_t refill;     /* P: cycles to refill the pipeline at a taken branch */
    uint32_t wait_states;
    bool wait_states_fixed; /* by option; else they follow FLASH_ACR */
    bool art_modelled;
    bool counted_all; /* emulation has been told to stop: the hook does nothing any more */
    struct cost_table cost;
    struct art art;

    uc_engine *engine;
    enum cpu_stop stop;
    uint32_t trap;
    uint32_t fault_at;      /* address of the instruction */
    uint32_t fault_address; /* that it accessed */
    uint32_t fault_bits;    /* of CFSR */
    bool event_register;
    bool stalled_forever; /* lockup, or the clock has stopped: only a reset helps */
    uint64_t instructions;
    uint64_t asleep_cycles;
    uint64_t stalled_cycles; /* waiting for the flash */
};

bool cpu_init(struct board *board);
void cpu_discard(struct cpu *cpu);

/* Starts at the reset vector. */
void cpu_reset(struct board *board);

/* Runs until the board is done. */
void cpu_run(struct board *board);

uint32_t cpu_read(struct cpu *cpu, int reg);
void cpu_write(struct cpu *cpu, int reg, uint32_t value);

/* Writes xPSR with the exception number in it, and lets Unicorn notice the change of mode. */
void cpu_write_xpsr(struct cpu *cpu, uint32_t xpsr);

/* The extra cycles of a fetch from a place that is not the next instruction, where the program goes on. */
uint32_t cpu_fetch_wait(struct board *board, uint32_t address);

/* Waits until the flash is done, if `address` lies in it. */
void cpu_stall_on_flash(struct board *board, uint32_t address);

static inline void cpu_lower_deadline(struct cpu *cpu, uint64_t cycle)
{
    cpu->deadline = cycle < cpu->deadline ? cycle : cpu->deadline;
}

/* Something has changed that the next boundary must look at. */
static inline void cpu_poke(struct cpu *cpu)
{
    cpu->deadline = 0;
}

#endif
