#include "run.h"

#include "complain.h"
#include "hook.h"

enum {
    WIDE_BYTES = 4,
    NARROW_BYTES = 2
};

#define XPSR_THUMB (UINT32_C(1) << 24)
#define PERIPHERALS_BASE UINT32_C(0x40000000)
#define PERIPHERALS_BYTES UINT32_C(0x20000000)
#define DEVICES_BASE UINT32_C(0xA0000000)
#define RETURNS_BASE UINT32_C(0xF0000000)  /* in a handler: EXC_RETURN */
#define FLUSH_ADDRESS UINT32_C(0xB0000000) /* nothing is there */

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

/* Makes Unicorn report reads of the flash, wherever it is. */
static void protect_flash(struct board *board)
{
    uc_engine *engine = board->cpu.engine;
    uint32_t rights = board->flash.read_protected ? UC_PROT_EXEC : UC_PROT_READ | UC_PROT_EXEC;
    (void)uc_mem_protect(engine, MEMORY_FLASH_BASE, board->memory.flash_bytes, rights);
    if (!board->memory.sram_at_0) {
        (void)uc_mem_protect(engine, 0, board->memory.flash_bytes, rights);
    }
    drop_address_cache(engine);
}

static void map_again(struct board *board)
{
    if (!memory_map_again(&board->memory, board->cpu.engine)) {
        report_fail(&board->report, "the emulator cannot map the memories again");
    }
    cost_forget(&board->cpu.cost);
    drop_translations(board->cpu.engine);
    protect_flash(board);
}

/* What an instruction has changed that Unicorn must know of. */
static void update_memory(struct board *board)
{
    struct flash *flash = &board->flash;
    if (board->memory.changed) {
        map_again(board);
    }
    if (flash->code_changed) {
        flash->code_changed = false;
        cost_forget(&board->cpu.cost);
        drop_translations(board->cpu.engine);
    }
    if (flash_watches_reads(flash) != flash->read_protected) {
        flash->read_protected = flash_watches_reads(flash);
        protect_flash(board);
    }
}

/* Lets time pass until something wakes the processor. */
static void sleep_until_woken(struct board *board)
{
    struct clock *clock = &board->clock;
    clock_run(clock, clock->now);
    while (!nvic_can_wake(&board->nvic) && !hook_wants_stop(board)) {
        uint64_t next = clock->next;
        if (next > clock->now) {
            clock->asleep_cycles += next - clock->now;
            clock->now = next;
        }
        clock_run(clock, clock->now);
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
    return exception_fault(&board->exceptions, bits, pc & ~UINT32_C(1));
}

/* Unicorn takes places at the end of the address space for returns in thread mode, too, and not all of them. */
static uint32_t after_odd_place(struct board *board)
{
    struct cpu *cpu = &board->cpu;
    uint32_t pc = cpu_read(cpu, UC_ARM_REG_PC);
    bool in_handler = cpu_read(cpu, UC_ARM_REG_IPSR) != 0;
    if (!in_handler || pc < RETURNS_BASE) {
        return after_no_code(board, pc);
    }
    bool sleeps = false;
    uint32_t address = exception_return(&board->exceptions, pc | 1U, &sleeps);
    if (sleeps) {
        sleep_until_woken(board);
    }
    return address;
}

static uint32_t after_trap(struct board *board)
{
    struct cpu *cpu = &board->cpu;
    switch (cpu->trap) {
    case CPU_TRAP_EXCEPTION_RETURN:
    case CPU_TRAP_NO_CODE:
        return after_odd_place(board);
    case CPU_TRAP_SVC:
        return exception_call(&board->exceptions, NVIC_SVC, cpu->next);
    case CPU_TRAP_BKPT:
        return exception_call(&board->exceptions, NVIC_DEBUG, cpu->at);
    case CPU_TRAP_NO_COPROCESSOR:
        return exception_fault(&board->exceptions, SCB_CFSR_NOCP, cpu->next);
    case CPU_TRAP_UNALIGNED:
        return exception_fault(&board->exceptions, SCB_CFSR_UNALIGNED, cpu->at);
    default:
        report_fail(&board->report, "Unicorn reports exception %u", (unsigned)cpu->trap);
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
        return exception_fault(&board->exceptions, thumb ? SCB_CFSR_UNDEFINSTR : SCB_CFSR_INVSTATE, at);
    }
    report_fail(&board->report, "Unicorn has stopped: %s", uc_strerror(error));
    return cpu->next;
}

/* WFI and WFE: the instruction itself is done here. */
static uint32_t after_sleep(struct board *board)
{
    struct clock *clock = &board->clock;
    struct cpu *cpu = &board->cpu;
    const uint8_t *code = memory_find(&board->memory, cpu->next, NARROW_BYTES);
    bool wide = code != NULL && (code[1] & 0xF8U) >= 0xE8U;
    if ((board->scb.scr & SCB_SCR_SLEEPDEEP) != 0) {
        report_fail(&board->report, "a deep sleep, in which all clocks stop (RM0090 5.3.4), is not modelled");
    }
    clock->now++;
    cpu->instructions++;
    board->profile.row->count++;
    if (cpu->stop == CPU_STOP_SLEEP || !cpu->event_register) {
        sleep_until_woken(board);
    }
    if (cpu->stop == CPU_STOP_SLEEP_EVENT) {
        cpu->event_register = false;
    }
    return cpu->next + (wide ? WIDE_BYTES : NARROW_BYTES);
}

static uint32_t after_stop(struct board *board, uc_err error)
{
    struct clock *clock = &board->clock;
    struct cpu *cpu = &board->cpu;
    switch (cpu->stop) {
    case CPU_STOP_BOUNDARY:
        return nvic_can_take(&board->nvic) ? exception_take(&board->exceptions, cpu->next) : cpu->next;
    case CPU_STOP_SLEEP:
    case CPU_STOP_SLEEP_EVENT:
        return after_sleep(board);
    case CPU_STOP_HOLD:
        clock->now = clock->next > clock->now ? clock->next : clock->now;
        clock_run(clock, clock->now);
        return nvic_can_take(&board->nvic) ? exception_take(&board->exceptions, cpu->next) : cpu->next;
    case CPU_STOP_TRAP:
        return after_trap(board);
    case CPU_STOP_FAULT:
        return exception_fault(&board->exceptions, cpu->fault_bits, cpu->fault_at);
    case CPU_RUNS:
        break;
    }
    return after_error(board, error);
}

/* Nothing but time passes until a reset comes. */
static void wait_for_reset(struct board *board)
{
    struct clock *clock = &board->clock;
    while (board->report.end == REPORT_RUNS && board->reset.wanted == RESET_NONE) {
        clock->now = clock->next > clock->now ? clock->next : clock->now;
        clock_run(clock, clock->now);
    }
}

static void run_stretch(struct board *board)
{
    struct cpu *cpu = &board->cpu;
    faults_apply(&board->faults);
    update_memory(board);
    cpu->stop = CPU_RUNS;
    cpu->counted_all = false;
    cpu->last = 0;
    uc_err error = uc_emu_start(cpu->engine, cpu->next | 1U, 0, 0, 0);
    if (board->report.end == REPORT_RUNS && board->reset.wanted == RESET_NONE) {
        cpu->next = after_stop(board, error);
    }
}

bool run(struct board *board)
{
    uint64_t begin_ns = tty_real_ns();
    if (!hook_add_all(board)) {
        complain("the emulator cannot be set up; is there memory enough?");
        return false;
    }
    while (board->report.end == REPORT_RUNS) {
        if (board->reset.wanted != RESET_NONE) {
            board_reset(board, board->reset.wanted);
        }
        if (board->cpu.stalled_forever) {
            wait_for_reset(board);
        } else {
            run_stretch(board);
        }
    }
    board->real_ns = tty_real_ns() - begin_ns;
    return true;
}
