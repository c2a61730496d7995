#include "hook.h"

enum {
    DIVIDE_BITS_PER_10_CYCLES = 32,
    IT_BYTES_MAX = 16,
};

/* Control has not come in line: the instructions of an IT block whose condition failed, or a taken branch. */
static void count_jump(struct board *board, uint32_t address)
{
    struct clock *clock = &board->clock;
    struct cpu *cpu = &board->cpu;
    bool skipped = (cpu->last & (COST_IN_IT | COST_OPENS_IT)) != 0 && address > cpu->next && address <= cpu->it_end &&
                   address - cpu->next <= IT_BYTES_MAX;
    if (!skipped) {
        clock->now += cpu->refill + fetch_jump(&board->fetch, address);
        cpu->last = 0;
        return;
    }
    for (uint32_t at = cpu->next; at < address;) {
        const uint8_t *code = memory_find(&board->memory, at, 2);
        at += code != NULL && (code[1] & 0xF8U) >= 0xE8U ? 4U : 2U;
        clock->now++;
    }
}

static void stop(struct cpu *cpu, enum cpu_stop reason)
{
    cpu->stop = reason;
    cpu->counted_all = true;
    (void)uc_emu_stop(cpu->engine);
}

/* Between two instructions, when something may be due. True: emulation stops here. */
static bool look_around(struct board *board, uint32_t address)
{
    struct clock *clock = &board->clock;
    struct cpu *cpu = &board->cpu;
    clock_run(clock, clock->now);
    flash_stall(&board->flash, address);
    clock->deadline = flash_is_busy(&board->flash) ? 0 : clock->next;
    if (cpu->stop == CPU_RUNS && !hook_wants_stop(board) && !nvic_can_take(&board->nvic)) {
        return false;
    }
    stop(cpu, cpu->stop == CPU_RUNS ? CPU_STOP_BOUNDARY : cpu->stop);
    return true;
}

static uint32_t read_operand(struct cpu *cpu, unsigned number)
{
    return cpu_read(cpu, number == COST_REGISTER_LR ? UC_ARM_REG_LR : UC_ARM_REG_R0 + (int)number);
}

static uint32_t division_cycles(struct cpu *cpu, struct cost cost)
{
    uint32_t dividend = read_operand(cpu, cost.more & 0xFU);
    uint32_t divisor = read_operand(cpu, cost.more >> 4);
    if (dividend < divisor || divisor == 0) {
        return 0;
    }
    uint32_t bits = (uint32_t)(__builtin_clz(divisor) - __builtin_clz(dividend)) + 1U;
    return (10U * bits + (DIVIDE_BITS_PER_10_CYCLES - 1U)) / DIVIDE_BITS_PER_10_CYCLES;
}

static void stop_by_mpu(struct cpu *cpu, uint32_t address)
{
    cpu->fault_at = address;
    cpu->fault_bits = SCB_CFSR_IACCVIOL;
    stop(cpu, CPU_STOP_FAULT);
}

/* The instructions that must be looked at each time. True: emulation stops before it. */
static bool look_closer(struct board *board, uint32_t address, uint32_t previous)
{
    struct clock *clock = &board->clock;
    struct cpu *cpu = &board->cpu;
    struct cost *cost = cost_find(&cpu->cost, address);
    if (cost->kind == COST_UNKNOWN && !memory_is_flash(&board->memory, address) && scb_mpu_is_on(&board->scb)) {
        stop_by_mpu(cpu, address);
        return true;
    }
    if (cost->kind == COST_UNKNOWN) {
        cost_decode(&cpu->cost, &board->memory, address, previous);
    }
    bool stoppable = (cost->flags & COST_IN_IT) == 0;
    switch ((enum cost_kind)cost->kind) {
    case COST_IT:
        cpu->it_end = address + 2U + cost->more;
        break;
    case COST_DIVIDE:
        clock->now += division_cycles(cpu, *cost);
        break;
    case COST_BARRIER:
        clock->now = bus_idle_cycle(&board->bus) > clock->now ? bus_idle_cycle(&board->bus) : clock->now;
        break;
    case COST_MASKS:
        clock_poke(clock);
        break;
    case COST_EVENT:
        cpu->event_register = true;
        break;
    case COST_SLEEP:
    case COST_SLEEP_EVENT:
        if (stoppable) {
            stop(cpu, cost->kind == COST_SLEEP ? CPU_STOP_SLEEP : CPU_STOP_SLEEP_EVENT);
            return true;
        }
        break;
    case COST_FLOAT:
        if (!scb_float_is_enabled(&board->scb)) {
            cpu->trap = CPU_TRAP_NO_COPROCESSOR;
            stop(cpu, CPU_STOP_TRAP);
            return true;
        }
        break;
    case COST_END:
        report_finish(&board->report, REPORT_REACHED, "");
        stop(cpu, CPU_STOP_BOUNDARY);
        return true;
    case COST_HOLD:
        stop(cpu, CPU_STOP_HOLD);
        return true;
    case COST_PLAIN:
    case COST_UNKNOWN:
        break;
    }
    return false;
}

/* Where the processor stands in the code, before the instruction there. */
static inline void follow(struct board *board, uint32_t address)
{
    struct cpu *cpu = &board->cpu;
    if (__builtin_expect(address != cpu->next, 0)) {
        count_jump(board, address);
        cpu->next = address;
    }
    if (__builtin_expect(!fetch_is_same_line(&board->fetch, address), 0)) {
        fetch_enter_line(&board->fetch, address);
    }
    if (__builtin_expect(board->profile.on, 0)) {
        profile_at(&board->profile, address);
    }
}

static void on_instruction(uc_engine *engine, uint64_t address64, uint32_t size, void *user)
{
    struct board *board = user;
    struct clock *clock = &board->clock;
    struct cpu *cpu = &board->cpu;
    uint32_t address = (uint32_t)address64;
    const struct cost *entry = cost_find(&cpu->cost, address);
    (void)engine;

    if (__builtin_expect(cpu->counted_all, 0)) {
        return;
    }
    follow(board, address);
    if (__builtin_expect(clock->now >= clock->deadline, 0) && (entry->flags & COST_IN_IT) == 0 &&
        look_around(board, address)) {
        return;
    }
    if (__builtin_expect(entry->flags & COST_SLOW, 0)) {
        uint32_t previous = (cpu->last & COST_IN_LINE) != 0 ? cpu->at : 1U;
        if (look_closer(board, address, previous)) {
            return;
        }
    }
    uint32_t flags = entry->flags;
    clock->now += entry->cycles - (flags & cpu->last >> 1 & COST_PIPELINED);
    if (__builtin_expect(flags & COST_FLASH_DATA, 0)) {
        clock->now += fetch_literal_wait(&board->fetch, address);
    }
    cpu->last = flags | COST_IN_LINE;
    cpu->at = address;
    cpu->next = address + size;
    cpu->instructions++;
    board->profile.row->count++;
}

static void on_trap(uc_engine *engine, uint32_t number, void *user)
{
    struct board *board = user;
    (void)engine;
    board->cpu.trap = number;
    stop(&board->cpu, CPU_STOP_TRAP);
}

/* A memory access that leads nowhere: a store of Unicorn 2.0 runs on, so that the rest of the block may follow. */
static bool on_bad_access(uc_engine *engine, uc_mem_type type, uint64_t address, int size, int64_t value, void *user)
{
    struct board *board = user;
    struct cpu *cpu = &board->cpu;
    (void)engine;
    if (type == UC_MEM_WRITE_PROT && memory_is_flash(&board->memory, (uint32_t)address)) {
        flash_write(&board->flash, (uint32_t)address, (unsigned)size, (uint32_t)value);
        return true;
    }
    if (type == UC_MEM_READ_PROT && memory_is_flash(&board->memory, (uint32_t)address)) {
        flash_stall(&board->flash, (uint32_t)address);
        flash_check_read(&board->flash, (uint32_t)address);
        return true;
    }
    if (cpu->stop == CPU_STOP_FAULT) {
        return false;
    }
    bool is_fetch = type == UC_MEM_FETCH_UNMAPPED || type == UC_MEM_FETCH_PROT;
    cpu->fault_at = is_fetch ? (uint32_t)address & ~1U : cpu->at;
    cpu->fault_address = (uint32_t)address;
    cpu->fault_bits = is_fetch ? SCB_CFSR_IBUSERR : SCB_CFSR_PRECISERR | SCB_CFSR_BFARVALID;
    cpu->stop = CPU_STOP_FAULT;
    clock_poke(&board->clock);
    return false;
}

static bool add_hook(struct board *board, int type, void *callback)
{
    uc_hook hook = 0;
    return uc_hook_add(board->cpu.engine, &hook, type, callback, board, 1, 0) == UC_ERR_OK;
}

/* ISO C has no conversion from a function to the void * that Unicorn asks for. */
static void *callback_of(void (*function)(void))
{
    void *callback = NULL;
    _Static_assert(sizeof callback == sizeof function, "a callback fits into a pointer");
    __builtin_memcpy((void *)&callback, (const void *)&function, sizeof callback);
    return callback;
}

bool hook_add_all(struct board *board)
{
    return add_hook(board, UC_HOOK_CODE, callback_of((void (*)(void))on_instruction)) &&
           add_hook(board, UC_HOOK_INTR, callback_of((void (*)(void))on_trap)) &&
           add_hook(board, UC_HOOK_MEM_INVALID, callback_of((void (*)(void))on_bad_access));
}
