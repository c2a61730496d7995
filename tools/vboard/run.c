/*
 * The loop around Unicorn: what happens between two stretches of emulation.
 */
#include "board.h"

enum {
    WIDE_BYTES = 4,
    NARROW_BYTES = 2
};

#define XPSR_THUMB (UINT32_C(1) << 24)
#define LR_RESET UINT32_C(0xFFFFFFFF)
#define PERIPHERALS_BASE UINT32_C(0x40000000)
#define PERIPHERALS_BYTES UINT32_C(0x20000000)
#define DEVICES_BASE UINT32_C(0xA0000000)
#define RETURNS_BASE UINT32_C(0xF0000000)  /* in a handler: EXC_RETURN */
#define FLUSH_ADDRESS UINT32_C(0xB0000000) /* nothing is there */

void cpu_reset(struct board *board)
{
    struct cpu *cpu = &board->cpu;
    uint32_t sp = 0;
    uint32_t start = 0;
    cpu_write(cpu, UC_ARM_REG_CONTROL, 0);
    cpu_write(cpu, UC_ARM_REG_PRIMASK, 0);
    cpu_write(cpu, UC_ARM_REG_FAULTMASK, 0);
    cpu_write(cpu, UC_ARM_REG_BASEPRI, 0);
    cpu_write_xpsr(cpu, XPSR_THUMB);
    if (!memory_read_word(&board->memory, 0, &sp) || !memory_read_word(&board->memory, WIDE_BYTES, &start) ||
        (start & 1U) == 0) {
        board_fail(board, "the reset vector is %08x, which is no address of code", (unsigned)start);
    }
    cpu_write(cpu, UC_ARM_REG_SP, sp & ~UINT32_C(3));
    cpu_write(cpu, UC_ARM_REG_LR, LR_RESET);
    cpu->event_register = false;
    cpu->next = start & ~UINT32_C(1);
    cpu_poke(cpu);
}

/* Unicorn keeps translations of addresses in a cache and drops them all when memory is mapped. */
static void drop_address_cache(uc_engine *engine)
{
    if (uc_mem_map(engine, FLUSH_ADDRESS, MEMORY_PAGE_BYTES, UC_PROT_NONE) == UC_ERR_OK) {
        (void)uc_mem_unmap(engine, FLUSH_ADDRESS, MEMORY_PAGE_BYTES);
    }
}

/* And the code that it has translated. Before version 2.1 the name of the call was that of the other cache. */
static void drop_translations(uc_engine *engine)
{
#ifdef uc_ctl_flush_tb
    (void)uc_ctl_flush_tb(engine);
#else
    (void)uc_ctl_flush_tlb(engine);
#endif
}

void flash_update_protection(struct board *board)
{
    struct flash *flash = &board->flash;
    uc_engine *engine = board->cpu.engine;
    if (flash->code_changed) {
        flash->code_changed = false;
        cost_forget(&board->cpu.cost);
        drop_translations(engine);
    }
    if (flash_is_busy(flash) != flash->read_protected) {
        flash->read_protected = flash_is_busy(flash);
        uint32_t rights = flash->read_protected ? UC_PROT_EXEC : UC_PROT_READ | UC_PROT_EXEC;
        (void)uc_mem_protect(engine, MEMORY_FLASH_BASE, board->memory.flash_bytes, rights);
        (void)uc_mem_protect(engine, 0, board->memory.flash_bytes, rights);
        drop_address_cache(engine);
    }
}

/* The program has gone to a place from which nothing may be executed: peripherals, devices and the system's own area
 * (ARMv7-M B3.1), or to an even address. */
static uint32_t after_no_code(struct board *board, uint32_t pc)
{
    struct cpu *cpu = &board->cpu;
    uint32_t xpsr = cpu_read(cpu, UC_ARM_REG_XPSR);
    uint32_t bits = (xpsr & XPSR_THUMB) != 0 ? SCB_CFSR_IBUSERR : SCB_CFSR_INVSTATE;
    if (pc >= DEVICES_BASE || pc - PERIPHERALS_BASE < PERIPHERALS_BYTES) {
        bits = SCB_CFSR_IACCVIOL;
    }
    cpu_write_xpsr(cpu, xpsr | XPSR_THUMB);
    return exception_fault(board, bits, pc & ~UINT32_C(1));
}

/* Unicorn takes places at the end of the address space for returns in thread mode, too, and not all of them. */
static uint32_t after_odd_place(struct board *board)
{
    struct cpu *cpu = &board->cpu;
    uint32_t pc = cpu_read(cpu, UC_ARM_REG_PC);
    bool in_handler = cpu_read(cpu, UC_ARM_REG_IPSR) != 0;
    return in_handler && pc >= RETURNS_BASE ? exception_return(board, pc | 1U) : after_no_code(board, pc);
}

static uint32_t after_trap(struct board *board)
{
    struct cpu *cpu = &board->cpu;
    switch (cpu->trap) {
    case CPU_TRAP_EXCEPTION_RETURN:
    case CPU_TRAP_NO_CODE:
        return after_odd_place(board);
    case CPU_TRAP_SVC:
        return exception_call(board, NVIC_SVC, cpu->next);
    case CPU_TRAP_BKPT:
        return exception_call(board, NVIC_DEBUG, cpu->at);
    case CPU_TRAP_NO_COPROCESSOR:
        return exception_fault(board, SCB_CFSR_NOCP, cpu->next);
    case CPU_TRAP_UNALIGNED:
        return exception_fault(board, SCB_CFSR_UNALIGNED, cpu->at);
    default:
        board_fail(board, "Unicorn reports exception %u", (unsigned)cpu->trap);
        return cpu->next;
    }
}

/* Unicorn has stopped by itself: an instruction that it does not know, or not in Thumb state. */
static uint32_t after_error(struct board *board, uc_err error)
{
    struct cpu *cpu = &board->cpu;
    bool thumb = (cpu_read(cpu, UC_ARM_REG_XPSR) & XPSR_THUMB) != 0;
    if (error == UC_ERR_INSN_INVALID || error == UC_ERR_EXCEPTION) {
        uint32_t at = thumb ? cpu->at : cpu_read(cpu, UC_ARM_REG_PC);
        cpu_write_xpsr(cpu, cpu_read(cpu, UC_ARM_REG_XPSR) | XPSR_THUMB);
        return exception_fault(board, thumb ? SCB_CFSR_UNDEFINSTR : SCB_CFSR_INVSTATE, at);
    }
    board_fail(board, "Unicorn has stopped: %s", uc_strerror(error));
    return cpu->next;
}

/* WFI and WFE: the instruction itself is done here. */
static uint32_t after_sleep(struct board *board)
{
    struct cpu *cpu = &board->cpu;
    const uint8_t *code = memory_find(&board->memory, cpu->next, NARROW_BYTES);
    bool wide = code != NULL && (code[1] & 0xF8U) >= 0xE8U;
    cpu->now++;
    cpu->instructions++;
    board->profile.row->count++;
    if (cpu->stop == CPU_STOP_SLEEP || !cpu->event_register) {
        board_sleep(board);
    }
    if (cpu->stop == CPU_STOP_SLEEP_EVENT) {
        cpu->event_register = false;
    }
    return cpu->next + (wide ? WIDE_BYTES : NARROW_BYTES);
}

static uint32_t after_stop(struct board *board, uc_err error)
{
    struct cpu *cpu = &board->cpu;
    switch (cpu->stop) {
    case CPU_STOP_BOUNDARY:
        return nvic_can_take(board) ? exception_take(board, cpu->next) : cpu->next;
    case CPU_STOP_SLEEP:
    case CPU_STOP_SLEEP_EVENT:
        return after_sleep(board);
    case CPU_STOP_HOLD:
        cpu->now = board->events.next > cpu->now ? board->events.next : cpu->now;
        events_run(board, cpu->now);
        return nvic_can_take(board) ? exception_take(board, cpu->next) : cpu->next;
    case CPU_STOP_TRAP:
        return after_trap(board);
    case CPU_STOP_FAULT:
        return exception_fault(board, cpu->fault_bits, cpu->fault_at);
    case CPU_RUNS:
        break;
    }
    return after_error(board, error);
}

/* Nothing but time passes until a reset comes. */
static void wait_for_reset(struct board *board)
{
    struct cpu *cpu = &board->cpu;
    while (board->end == BOARD_RUNS && board->wanted_reset == RESET_NONE) {
        cpu->now = board->events.next > cpu->now ? board->events.next : cpu->now;
        events_run(board, cpu->now);
    }
}

void cpu_run(struct board *board)
{
    struct cpu *cpu = &board->cpu;
    uint64_t begin_ns = tty_real_ns();
    while (board->end == BOARD_RUNS) {
        if (board->wanted_reset != RESET_NONE) {
            board_reset(board, board->wanted_reset);
        }
        if (cpu->stalled_forever) {
            wait_for_reset(board);
            continue;
        }
        faults_apply(board);
        flash_update_protection(board);
        cpu->stop = CPU_RUNS;
        cpu->counted_all = false;
        cpu->last = 0;
        uc_err error = uc_emu_start(cpu->engine, cpu->next | 1U, 0, 0, 0);
        if (board->end == BOARD_RUNS && board->wanted_reset == RESET_NONE) {
            cpu->next = after_stop(board, error);
        }
    }
    board->real_ns = tty_real_ns() - begin_ns;
}
