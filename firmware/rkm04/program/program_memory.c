#include "program_memory.h"

#include <assert.h>

#include "program_listing.h"

/* What the number of an input or variable counts in the value of a conditional jump. */
#define IO_UNIT 256

static_assert(PROGRAM_COMMANDS_MAX > 0, "the ring has a place to overwrite");
static_assert(PROGRAM_COMMANDS_MAX <= UINT16_MAX, "a place and one more fit in 16 bits");
static_assert(PROGRAM_LABEL_MAX < IO_UNIT, "a label must leave the number of an input alone");

void program_memory_clear(struct program_memory *memory)
{
    memory->written = 0;
    memory->released = 0;
    for (unsigned label = 0; label <= PROGRAM_LABEL_MAX; label++) {
        memory->label_place[label] = 0;
    }
}

bool program_memory_append(struct program_memory *memory, const struct program_instruction *instruction, bool locked)
{
    bool full = memory->written >= PROGRAM_COMMANDS_MAX;
    if ((full && locked) || memory->written == UINT32_MAX) {
        return false;
    }
    uint32_t place = memory->written % PROGRAM_COMMANDS_MAX;
    memory->opcode[place] = instruction->opcode;
    memory->value[place] = instruction->value + instruction->io * IO_UNIT;
    memory->written++;
    if (instruction->opcode == PROGRAM_LABEL) {
        memory->label_place[instruction->value] = (uint16_t)(place + 1U);
    } else if (instruction->opcode == PROGRAM_RELEASE) {
        memory->released = memory->written;
    }
    return !full;
}

uint32_t program_memory_oldest(const struct program_memory *memory)
{
    return memory->written > PROGRAM_COMMANDS_MAX ? memory->written - PROGRAM_COMMANDS_MAX : 0;
}

struct program_instruction program_memory_at(const struct program_memory *memory, uint32_t ordinal)
{
    uint32_t place = ordinal % PROGRAM_COMMANDS_MAX;
    struct program_instruction instruction = {.value = memory->value[place], .opcode = memory->opcode[place]};
    if (instruction.opcode == PROGRAM_JUMP_IF_HIGH || instruction.opcode == PROGRAM_JUMP_IF_LOW) {
        instruction.io = (uint8_t)(instruction.value / IO_UNIT);
        instruction.value %= IO_UNIT;
    }
    return instruction;
}

/* Where the youngest `@` has been overwritten, and so something else stands there, all older ones have been too. */
bool program_memory_find_label(const struct program_memory *memory, uint32_t label, uint32_t *ordinal)
{
    uint32_t next = memory->label_place[label];
    if (next == 0 || memory->opcode[next - 1U] != PROGRAM_LABEL || memory->value[next - 1U] != (int32_t)label) {
        return false;
    }
    uint32_t behind = (memory->written - next) % PROGRAM_COMMANDS_MAX; /* commands since then */
    *ordinal = memory->written - 1U - behind;
    return true;
}

bool program_memory_is_released(const struct program_memory *memory, uint32_t ordinal)
{
    return memory->released > ordinal + 1U;
}

uint32_t program_memory_list(const struct program_memory *memory, uint8_t *text, uint32_t capacity)
{
    uint32_t length = 0;
    uint32_t ordinal = program_memory_oldest(memory);
    while (ordinal < memory->written && capacity - length >= PROGRAM_COMMAND_BYTES_MAX) {
        struct program_instruction instruction = program_memory_at(memory, ordinal);
        length += program_list_instruction(&instruction, &text[length]);
        ordinal++;
    }
    return length;
}
