#include "cost.h"

#include <capstone/capstone.h>
#include <stdlib.h>
#include <string.h>

enum {
    INSTRUCTION_BYTES_MAX = 4,
    COST_ALU = 1,
    COST_MULTIPLY_ADD = 2, /* the manual says 1 for most operands: the dearer figure, for budgets */
    COST_MEMORY = 2,
    COST_STORE_IMMEDIATE = 1,
    COST_FLOAT_MULTIPLY_ADD = 3,
    COST_FLOAT_DIVIDE = 14, /* VDIV, VSQRT */
    COST_TABLE_BRANCH = 2,
    COST_DIVIDE_LEAST = 2,
};

static void fill(struct cost *entry)
{
    for (unsigned i = 0; i < COST_REGION_HALFWORDS; i++) {
        entry[i] = (struct cost){.cycles = COST_ALU, .flags = COST_SLOW, .kind = COST_UNKNOWN};
    }
}

void cost_forget(struct cost_table *table)
{
    for (unsigned i = 0; i < COST_REGIONS; i++) {
        fill(table->entry[i]);
    }
}

bool cost_init(struct cost_table *table)
{
    csh handle = 0;
    table->end_address = 1;
    table->hold_address = 1;
    for (unsigned i = 0; i < COST_REGIONS; i++) {
        table->entry[i] = malloc(COST_REGION_HALFWORDS * sizeof *table->entry[i]);
        if (table->entry[i] == NULL) {
            return false;
        }
    }
    cost_forget(table);
    if (cs_open(CS_ARCH_ARM, (cs_mode)(CS_MODE_THUMB | CS_MODE_MCLASS), &handle) != CS_ERR_OK ||
        cs_option(handle, CS_OPT_DETAIL, CS_OPT_ON) != CS_ERR_OK) {
        return false;
    }
    table->capstone = handle;
    table->instruction = cs_malloc(handle);
    return table->instruction != NULL;
}

void cost_discard(struct cost_table *table)
{
    for (unsigned i = 0; i < COST_REGIONS; i++) {
        free(table->entry[i]);
    }
    if (table->instruction != NULL) {
        cs_free(table->instruction, 1);
        csh handle = table->capstone;
        (void)cs_close(&handle);
    }
}

static const cs_insn *disassemble(struct cost_table *table, const uint8_t *code, uint32_t address)
{
    cs_insn *instruction = table->instruction;
    size_t bytes = INSTRUCTION_BYTES_MAX;
    uint64_t at = address;
    return cs_disasm_iter(table->capstone, &code, &bytes, &at, instruction) ? instruction : NULL;
}

static bool starts_with(const cs_insn *instruction, const char *prefix)
{
    return strncmp(instruction->mnemonic, prefix, strlen(prefix)) == 0;
}

static bool starts_with_any(const cs_insn *instruction, const char *const *prefixes)
{
    while (*prefixes != NULL && !starts_with(instruction, *prefixes)) {
        prefixes++;
    }
    return *prefixes != NULL;
}

/* The number of registers in a list: of all that are not the base. */
static unsigned list_length(const cs_insn *instruction)
{
    unsigned registers = 0;
    for (unsigned i = 0; i < instruction->detail->arm.op_count; i++) {
        registers += instruction->detail->arm.operands[i].type == ARM_OP_REG ? 1U : 0U;
    }
    bool has_base = !starts_with(instruction, "push") && !starts_with(instruction, "pop") &&
                    !starts_with(instruction, "vpush") && !starts_with(instruction, "vpop");
    return has_base && registers > 0 ? registers - 1U : registers;
}

static const cs_arm_op *memory_operand(const cs_insn *instruction)
{
    for (unsigned i = 0; i < instruction->detail->arm.op_count; i++) {
        if (instruction->detail->arm.operands[i].type == ARM_OP_MEM) {
            return &instruction->detail->arm.operands[i];
        }
    }
    return NULL;
}

static bool is_literal(const cs_insn *instruction)
{
    const cs_arm_op *memory = memory_operand(instruction);
    return memory != NULL && memory->mem.base == ARM_REG_PC;
}

static void price_load(struct cost *cost, const cs_insn *instruction, bool in_flash)
{
    cost->cycles = COST_MEMORY;
    cost->flags |= COST_PIPELINED | COST_LOAD;
    if (in_flash && is_literal(instruction)) {
        cost->flags |= COST_FLASH_DATA;
    }
}

/* A store with an immediate offset goes to the write buffer in one cycle; the others need their address first. */
static void price_store(struct cost *cost, const cs_insn *instruction)
{
    const cs_arm_op *memory = memory_operand(instruction);
    bool has_index = memory != NULL && memory->mem.index != ARM_REG_INVALID;
    cost->cycles = has_index ? COST_MEMORY : COST_STORE_IMMEDIATE;
    cost->flags |= has_index ? COST_PIPELINED : 0;
}

static bool price_memory(struct cost *cost, const cs_insn *instruction, bool in_flash)
{
    static const char *const multiples[] = {"ldm", "stm", "push", "pop", "vldm", "vstm", "vpush", "vpop", NULL};
    static const char *const doubles[] = {"ldrd", "strd", NULL};
    static const char *const singles[] = {"ldrex", "strex", "vldr", "vstr", NULL};
    if (starts_with_any(instruction, multiples)) {
        cost->cycles = (uint8_t)(1U + list_length(instruction));
    } else if (starts_with_any(instruction, doubles)) {
        cost->cycles = COST_MEMORY + 1;
    } else if (starts_with_any(instruction, singles)) {
        cost->cycles = COST_MEMORY;
    } else if (starts_with(instruction, "ldr")) {
        price_load(cost, instruction, in_flash);
    } else if (starts_with(instruction, "str")) {
        price_store(cost, instruction);
    } else {
        return false;
    }
    return true;
}

static void price_float(struct cost *cost, const cs_insn *instruction)
{
    if (starts_with(instruction, "vdiv") || starts_with(instruction, "vsqrt")) {
        cost->cycles = COST_FLOAT_DIVIDE;
    } else if (starts_with(instruction, "vml") || starts_with(instruction, "vfm") || starts_with(instruction, "vnml") ||
               starts_with(instruction, "vfnm")) {
        cost->cycles = COST_FLOAT_MULTIPLY_ADD;
    }
}

static uint8_t register_number(const cs_insn *instruction, unsigned operand)
{
    arm_reg reg = (arm_reg)instruction->detail->arm.operands[operand].reg;
    if (reg == ARM_REG_LR) {
        return COST_REGISTER_LR;
    }
    return reg >= ARM_REG_R0 && reg <= ARM_REG_R12 ? (uint8_t)(reg - ARM_REG_R0) : 0;
}

static void set_kind(struct cost *cost, enum cost_kind kind)
{
    cost->kind = (uint8_t)kind;
    cost->flags |= COST_SLOW;
}

static bool is_wide(const uint8_t *code)
{
    return (code[1] & 0xF8U) >= 0xE8U;
}

/* ARMv7-M manual A7.3.2: the lowest bit that is set in the mask tells how many instructions the block has. */
static void open_block(struct cost_table *table, struct cost *cost, const uint8_t *code, uint32_t address)
{
    unsigned instructions = 4;
    for (unsigned mask = code[0] & 0xFU; (mask & 1U) == 0 && instructions > 1; mask >>= 1) {
        instructions--;
    }
    uint32_t offset = 2;
    for (unsigned i = 0; i < instructions; i++) {
        cost_find(table, address + offset)->flags |= COST_IN_IT;
        offset += is_wide(code + offset) ? 4U : 2U;
    }
    cost->more = (uint8_t)(offset - 2U);
    cost->flags |= COST_OPENS_IT;
    set_kind(cost, COST_IT);
}

static void price_division(struct cost *cost, const cs_insn *instruction)
{
    unsigned last = instruction->detail->arm.op_count - 1U;
    cost->more = (uint8_t)(register_number(instruction, last - 1U) | register_number(instruction, last) << 4);
    cost->cycles = COST_DIVIDE_LEAST;
    set_kind(cost, COST_DIVIDE);
}

static void price_other(struct cost *cost, const cs_insn *instruction)
{
    static const char *const divisions[] = {"udiv", "sdiv", NULL};
    static const char *const multiplies[] = {"mla", "mls", "umlal", "smlal", "umaal", NULL};
    static const char *const tables[] = {"tbb", "tbh", NULL};
    static const struct {
        const char *name;
        enum cost_kind kind;
    } kinds[] = {{"cps", COST_MASKS},       {"msr", COST_MASKS}, {"wfi", COST_SLEEP},
                 {"wfe", COST_SLEEP_EVENT}, {"sev", COST_EVENT}, {"dsb", COST_BARRIER}};
    if (starts_with_any(instruction, divisions)) {
        price_division(cost, instruction);
    } else if (starts_with_any(instruction, multiplies)) {
        cost->cycles = COST_MULTIPLY_ADD;
    } else if (starts_with_any(instruction, tables)) {
        cost->cycles = COST_TABLE_BRANCH;
    }
    for (unsigned i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        if (starts_with(instruction, kinds[i].name)) {
            set_kind(cost, kinds[i].kind);
        }
    }
}

/* Whether the load at `previous` writes the register that this one takes its address from: then the two do not
 * overlap. */
static bool waits_for_address(struct cost_table *table, struct memory *memory, arm_reg base, uint32_t previous)
{
    const uint8_t *code = (previous & 1U) != 0 ? NULL : memory_find(memory, previous, INSTRUCTION_BYTES_MAX);
    const cs_insn *before = code == NULL ? NULL : disassemble(table, code, previous);
    return before != NULL && before->detail->arm.op_count > 0 && before->detail->arm.operands[0].type == ARM_OP_REG &&
           (arm_reg)before->detail->arm.operands[0].reg == base;
}

static void price(struct cost_table *table, struct memory *memory, struct cost *cost, const cs_insn *instruction,
                  uint32_t address, uint32_t previous)
{
    bool is_float = instruction->mnemonic[0] == 'v';
    bool is_memory = price_memory(cost, instruction, memory_is_flash(memory, address));
    if (is_float) {
        if (!is_memory) {
            price_float(cost, instruction);
        }
        set_kind(cost, COST_FLOAT);
    } else if (!is_memory) {
        price_other(cost, instruction);
    }
    const cs_arm_op *operand = memory_operand(instruction);
    if ((cost->flags & COST_PIPELINED) != 0 && operand != NULL &&
        waits_for_address(table, memory, (arm_reg)operand->mem.base, previous)) {
        cost->flags &= (uint8_t)~COST_PIPELINED;
    }
}

/* The next instruction waits while this one has the bus for its data, or, where instructions have a bus of their own,
 * at address 0, the memory: that has literals alone. */
static bool is_slowed(const struct cost_table *table, const struct memory *memory, const cs_insn *instruction,
                      uint32_t address)
{
    struct cost unused = {.cycles = 0};
    bool in_ram = !memory_is_flash(memory, address);
    bool shares = address >= MEMORY_SRAM_BASE ? price_memory(&unused, instruction, false) : is_literal(instruction);
    return table->shared_bus && in_ram && shares;
}

void cost_decode(struct cost_table *table, struct memory *memory, uint32_t address, uint32_t previous)
{
    struct cost *entry = cost_find(table, address);
    const uint8_t *code = memory_find(memory, address, INSTRUCTION_BYTES_MAX);
    struct cost cost = {.cycles = COST_ALU, .flags = entry->flags & COST_IN_IT, .kind = COST_PLAIN};
    const cs_insn *instruction = code == NULL ? NULL : disassemble(table, code, address);

    if (code != NULL && code[1] == 0xBF && (code[0] & 0xFU) != 0) {
        open_block(table, &cost, code, address);
    } else if (instruction != NULL) {
        unsigned more = is_slowed(table, memory, instruction, address) ? 1U : 0U;
        price(table, memory, &cost, instruction, address, previous);
        cost.cycles = (uint8_t)(cost.cycles + more);
    }
    if (address == table->end_address) {
        set_kind(&cost, COST_END);
    } else if (address == table->hold_address) {
        set_kind(&cost, COST_HOLD);
    }
    *entry = cost;
}
