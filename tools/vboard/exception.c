#include "exception.h"

enum {
    FRAME_WORDS = 8,
    FRAME_WORDS_FLOAT = 26,
    FRAME_FLOATS = 16,
    FRAME_FPSCR = 24,
    WORD_BYTES = 4,
    XPSR_EXCEPTION = 0x1FF,
    CONTROL_SPSEL = 1 << 1,
    CONTROL_FPCA = 1 << 2,
    RETURN_TO_THREAD = 1 << 3,
    RETURN_TO_PSP = 1 << 2,
    RETURN_NO_FLOAT = 1 << 4,
};

#define XPSR_THUMB (UINT32_C(1) << 24)
#define XPSR_IT UINT32_C(0x0600FC00)
#define XPSR_ALIGNED (UINT32_C(1) << 9) /* of a stacked xPSR: a word of padding lies above the frame */
#define EXC_RETURN_BASE UINT32_C(0xFFFFFFE1)
#define EXC_RETURN_MAGIC UINT32_C(0xFFFFFFE0)

/* A word of a frame, by its number. */
static void put_word(uint8_t *frame, uint32_t number, uint32_t word)
{
    uint8_t *at = frame + (size_t)number * WORD_BYTES;
    for (unsigned i = 0; i < WORD_BYTES; i++) {
        at[i] = (uint8_t)(word >> 8U * i);
    }
}

static uint32_t get_word(const uint8_t *frame, uint32_t number)
{
    const uint8_t *at = frame + (size_t)number * WORD_BYTES;
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

/* R0 to R3, R12, LR as the frame holds them. */
static const int frame_registers[] = {UC_ARM_REG_R0, UC_ARM_REG_R1,  UC_ARM_REG_R2,
                                      UC_ARM_REG_R3, UC_ARM_REG_R12, UC_ARM_REG_LR};

enum {
    FRAME_REGISTERS = sizeof frame_registers / sizeof *frame_registers
};

static void save_floats(struct cpu *cpu, uint8_t *frame)
{
    for (unsigned i = 0; i < FRAME_FLOATS; i++) {
        put_word(frame, FRAME_WORDS + i, cpu_read(cpu, UC_ARM_REG_S0 + (int)i));
    }
    put_word(frame, FRAME_FPSCR, cpu_read(cpu, UC_ARM_REG_FPSCR));
}

static void restore_floats(struct cpu *cpu, const uint8_t *frame)
{
    for (unsigned i = 0; i < FRAME_FLOATS; i++) {
        cpu_write(cpu, UC_ARM_REG_S0 + (int)i, get_word(frame, FRAME_WORDS + i));
    }
    cpu_write(cpu, UC_ARM_REG_FPSCR, get_word(frame, FRAME_FPSCR));
}

/* Pushes the frame onto the stack in use and gives the EXC_RETURN for it. False: there is no memory there. */
static bool push_frame(struct exceptions *exceptions, uint32_t return_address, uint32_t *exc_return)
{
    struct cpu *cpu = exceptions->cpu;
    uint32_t xpsr = cpu_read(cpu, UC_ARM_REG_XPSR);
    uint32_t control = cpu_read(cpu, UC_ARM_REG_CONTROL);
    uint32_t sp = cpu_read(cpu, UC_ARM_REG_SP);
    bool in_thread = (xpsr & XPSR_EXCEPTION) == 0;
    bool has_floats = (control & CONTROL_FPCA) != 0;
    uint32_t words = has_floats ? FRAME_WORDS_FLOAT : FRAME_WORDS;
    uint32_t frame_sp = (sp - words * WORD_BYTES) & ~UINT32_C(7);

    *exc_return = EXC_RETURN_BASE | (has_floats ? 0 : RETURN_NO_FLOAT) | (in_thread ? RETURN_TO_THREAD : 0) |
                  (in_thread && (control & CONTROL_SPSEL) != 0 ? RETURN_TO_PSP : 0);
    uint8_t *frame = memory_find(exceptions->memory, frame_sp, words * WORD_BYTES);
    cpu_write(cpu, UC_ARM_REG_SP, frame_sp);
    if (frame == NULL || memory_is_flash(exceptions->memory, frame_sp)) {
        return false;
    }
    for (unsigned i = 0; i < FRAME_REGISTERS; i++) {
        put_word(frame, i, cpu_read(cpu, frame_registers[i]));
    }
    put_word(frame, FRAME_REGISTERS, return_address & ~UINT32_C(1));
    put_word(frame, FRAME_REGISTERS + 1U, (xpsr & ~XPSR_ALIGNED) | XPSR_THUMB | ((sp & 4U) << 7));
    if (has_floats) {
        save_floats(cpu, frame);
        cpu_write(cpu, UC_ARM_REG_CONTROL, control & ~(uint32_t)CONTROL_FPCA);
    }
    return true;
}

/* Makes the exception that comes next the running one. */
static uint32_t enter_handler(struct exceptions *exceptions, unsigned exception, uint32_t exc_return)
{
    struct cpu *cpu = exceptions->cpu;
    uint32_t vector_at = exceptions->scb->vtor + WORD_BYTES * exception;
    uint32_t vector = 0;

    flash_stall(exceptions->flash, vector_at);
    stats_enter(exceptions->stats, exception);
    nvic_unpend(exceptions->nvic, exception);
    nvic_set_active(exceptions->nvic, exception, true);
    cpu_write_xpsr(cpu, (cpu_read(cpu, UC_ARM_REG_XPSR) & ~(XPSR_IT | XPSR_EXCEPTION)) | XPSR_THUMB | exception);
    cpu_write(cpu, UC_ARM_REG_LR, exc_return);
    cpu->event_register = true;
    if (!memory_read_word(exceptions->memory, vector_at, &vector) || (vector & 1U) == 0) {
        report_fail(exceptions->report, "the vector of exception %u at %08x is %08x, which is no address of code",
                    exception, vector_at, vector);
    }
    exceptions->clock->now += fetch_jump(exceptions->fetch, vector & ~1U);
    return vector & ~UINT32_C(1);
}

/* The processor cannot go on without a reset. */
static void lock_up(struct exceptions *exceptions)
{
    exceptions->lockups++;
    exceptions->cpu->stalled_forever = true;
    if (!exceptions->iwdg->started) {
        report_fail(exceptions->report,
                    "lockup: a fault inside HardFault, and no watchdog that would reset; CFSR %08x, HFSR %08x",
                    (unsigned)exceptions->scb->cfsr, (unsigned)exceptions->scb->hfsr);
    }
}

/* Asks for HardFault; in vain from inside HardFault or NMI: that is lockup. */
static bool escalate(struct exceptions *exceptions, uint32_t hfsr)
{
    struct nvic *nvic = exceptions->nvic;
    exceptions->scb->hfsr |= hfsr;
    if (nvic_active_priority(nvic) <= NVIC_PRIORITY_HARD_FAULT ||
        (cpu_read(exceptions->cpu, UC_ARM_REG_FAULTMASK) & 1U) != 0) {
        lock_up(exceptions);
        return false;
    }
    nvic_pend(exceptions->nvic, NVIC_HARD_FAULT);
    return true;
}

static void note_stacking_fault(struct exceptions *exceptions, uint32_t bits)
{
    exceptions->scb->cfsr |= bits;
    stats_note_fault(exceptions->stats, bits, cpu_read(exceptions->cpu, UC_ARM_REG_SP));
    if (nvic_is_enabled(exceptions->nvic, NVIC_BUS_FAULT) &&
        nvic_group_priority(exceptions->nvic, NVIC_BUS_FAULT) < nvic_running_priority(exceptions->nvic)) {
        nvic_pend(exceptions->nvic, NVIC_BUS_FAULT);
    } else {
        (void)escalate(exceptions, SCB_HFSR_FORCED);
    }
}

uint32_t exception_take(struct exceptions *exceptions, uint32_t return_address)
{
    struct cpu *cpu = exceptions->cpu;
    uint32_t exc_return = 0;
    uint64_t begin = exceptions->clock->now;
    profile_pause(exceptions->profile);
    if (!push_frame(exceptions, return_address, &exc_return)) {
        note_stacking_fault(exceptions, SCB_CFSR_STKERR);
    }
    if (cpu->stalled_forever) {
        return return_address;
    }
    exceptions->clock->now += EXCEPTION_ENTRY_CYCLES;
    clock_run(exceptions->clock,
              exceptions->clock->now); /* what comes now and is more urgent takes the place: late arrival */
    stats_begin(exceptions->stats, begin);
    uint32_t handler = enter_handler(exceptions, nvic_next_pending(exceptions->nvic), exc_return);
    profile_place(exceptions->profile, PROFILE_ENTRY);
    return handler;
}

static uint32_t pop_frame(struct exceptions *exceptions, uint32_t exc_return)
{
    struct cpu *cpu = exceptions->cpu;
    bool to_thread = (exc_return & RETURN_TO_THREAD) != 0;
    bool has_floats = (exc_return & RETURN_NO_FLOAT) == 0;
    uint32_t sp = cpu_read(cpu, (exc_return & RETURN_TO_PSP) != 0 ? UC_ARM_REG_PSP : UC_ARM_REG_MSP);
    uint32_t words = has_floats ? FRAME_WORDS_FLOAT : FRAME_WORDS;
    const uint8_t *frame = memory_find(exceptions->memory, sp, words * WORD_BYTES);
    if (frame == NULL) {
        note_stacking_fault(exceptions, SCB_CFSR_UNSTKERR);
        return exception_take(exceptions, 0);
    }
    uint32_t xpsr = get_word(frame, FRAME_REGISTERS + 1U);
    if (((xpsr & XPSR_EXCEPTION) == 0) != to_thread) {
        return exception_fault(exceptions, SCB_CFSR_INVPC, get_word(frame, FRAME_REGISTERS));
    }
    cpu_write_xpsr(cpu, (xpsr & ~XPSR_ALIGNED) | XPSR_THUMB);
    if (to_thread) {
        uint32_t control = cpu_read(cpu, UC_ARM_REG_CONTROL) & ~(uint32_t)(CONTROL_SPSEL | CONTROL_FPCA);
        control |= (exc_return & RETURN_TO_PSP) != 0 ? CONTROL_SPSEL : 0U;
        cpu_write(cpu, UC_ARM_REG_CONTROL, control);
    }
    if (has_floats) {
        restore_floats(cpu, frame);
        cpu_write(cpu, UC_ARM_REG_CONTROL, cpu_read(cpu, UC_ARM_REG_CONTROL) | CONTROL_FPCA);
    }
    for (unsigned i = 0; i < FRAME_REGISTERS; i++) {
        cpu_write(cpu, frame_registers[i], get_word(frame, i));
    }
    cpu_write(cpu, UC_ARM_REG_SP, sp + words * WORD_BYTES + ((xpsr & XPSR_ALIGNED) != 0 ? WORD_BYTES : 0));
    return get_word(frame, FRAME_REGISTERS) & ~UINT32_C(1);
}

/* Lets the next pending exception follow the one that ends: the frame stays where it is. */
static uint32_t chain(struct exceptions *exceptions, unsigned ending, uint32_t exc_return)
{
    stats_leave(exceptions->stats, ending);
    exceptions->stats->tail_chains++;
    stats_begin(exceptions->stats, exceptions->clock->now);
    exceptions->clock->now += EXCEPTION_TAIL_CYCLES;
    clock_run(exceptions->clock, exceptions->clock->now);
    uint32_t handler = enter_handler(exceptions, nvic_next_pending(exceptions->nvic), exc_return);
    profile_place(exceptions->profile, PROFILE_ENTRY);
    return handler;
}

/* Asks for an exception that cannot wait. False: that is lockup. */
static bool pend_fault(struct exceptions *exceptions, unsigned exception)
{
    struct nvic *nvic = exceptions->nvic;
    exceptions->clock->moment = exceptions->clock->now;
    if (nvic_is_enabled(nvic, exception) &&
        nvic_group_priority(nvic, exception) < nvic_running_priority(exceptions->nvic)) {
        nvic_pend(exceptions->nvic, exception);
        return true;
    }
    return escalate(exceptions, exception == NVIC_DEBUG ? SCB_HFSR_DEBUGEVT : SCB_HFSR_FORCED);
}

/* To a handler, or to the main program on one of two stacks. */
static bool is_return(uint32_t exc_return)
{
    uint32_t to = exc_return & ~EXC_RETURN_MAGIC & ~(uint32_t)RETURN_NO_FLOAT;
    return (exc_return & EXC_RETURN_MAGIC) == EXC_RETURN_MAGIC &&
           (to == 1U || to == (1U | RETURN_TO_THREAD) || to == (1U | RETURN_TO_THREAD | RETURN_TO_PSP));
}

/* An EXC_RETURN that is none ends the exception all the same, and the fault follows (ARMv7-M B1.5.8). */
static uint32_t refuse_return(struct exceptions *exceptions, unsigned exception, uint32_t exc_return)
{
    exceptions->scb->cfsr |= SCB_CFSR_INVPC;
    stats_note_fault(exceptions->stats, SCB_CFSR_INVPC, exc_return);
    nvic_set_active(exceptions->nvic, exception, false);
    return pend_fault(exceptions, NVIC_USAGE_FAULT) ? chain(exceptions, exception, exc_return) : exc_return;
}

/* Erratum 838869 of the core (its revisions r0p0 and r0p1): where a handler ends with BX while its last store still
 * waits for the bus, the processor may take the wrong vector. A DSB between the two helps, and so does a return by POP,
 * whose load comes after the store. */
static void look_for_store(struct exceptions *exceptions)
{
    enum {
        BX_MASK = 0xFF87,
        BX = 0x4700
    };
    const uint8_t *code = memory_find(exceptions->memory, exceptions->cpu->at, 2);
    bool is_bx = code != NULL && ((code[0] | (unsigned)code[1] << 8) & BX_MASK) == BX;
    if (is_bx && bus_idle_cycle(exceptions->bus) > exceptions->clock->now) {
        report_warn(exceptions->report,
                    "a handler returns by BX while its last write is on its way: put a DSB between the two "
                    "(core erratum 838869)");
    }
}

uint32_t exception_return(struct exceptions *exceptions, uint32_t exc_return, bool *sleeps)
{
    struct cpu *cpu = exceptions->cpu;
    unsigned exception = cpu_read(cpu, UC_ARM_REG_IPSR) & XPSR_EXCEPTION;

    *sleeps = false;
    look_for_store(exceptions);
    clock_run(exceptions->clock, exceptions->clock->now);
    profile_pause(exceptions->profile);
    if (!is_return(exc_return) || !nvic_is_active(exceptions->nvic, exception)) {
        return refuse_return(exceptions, exception, exc_return);
    }
    nvic_set_active(exceptions->nvic, exception, false);
    if (exception != NVIC_NMI) {
        cpu_write(cpu, UC_ARM_REG_FAULTMASK, 0);
    }
    if (exception >= NVIC_IRQ0 && nvic_line_is_high(exceptions->nvic, exception)) {
        nvic_pend(exceptions->nvic, exception);
    }
    if (nvic_can_take(exceptions->nvic)) {
        return chain(exceptions, exception, exc_return);
    }
    exceptions->clock->now += EXCEPTION_EXIT_CYCLES;
    profile_place(exceptions->profile, PROFILE_EXIT);
    stats_leave(exceptions->stats, exception);
    profile_pause(exceptions->profile);
    uint32_t address = pop_frame(exceptions, exc_return);
    exceptions->clock->now += fetch_jump(exceptions->fetch, address);
    bool to_thread = (exc_return & RETURN_TO_THREAD) != 0;
    *sleeps = to_thread && (exceptions->scb->scr & SCB_SCR_SLEEPONEXIT) != 0;
    return address;
}

uint32_t exception_fault(struct exceptions *exceptions, uint32_t cfsr_bits, uint32_t return_address)
{
    unsigned exception = NVIC_BUS_FAULT;
    if ((cfsr_bits & SCB_CFSR_USAGE) != 0) {
        exception = NVIC_USAGE_FAULT;
    } else if ((cfsr_bits & SCB_CFSR_MEMORY) != 0) {
        exception = NVIC_MEM_MANAGE;
    }
    exceptions->scb->cfsr |= cfsr_bits;
    if ((cfsr_bits & SCB_CFSR_BFARVALID) != 0) {
        exceptions->scb->bfar = exceptions->cpu->fault_address;
    }
    stats_note_fault(exceptions->stats, cfsr_bits, return_address);
    return exception_call(exceptions, exception, return_address);
}

uint32_t exception_call(struct exceptions *exceptions, unsigned exception, uint32_t return_address)
{
    return pend_fault(exceptions, exception) ? exception_take(exceptions, return_address) : return_address;
}
