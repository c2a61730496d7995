#include "program_memory.h"

#include <assert.h>

#include "program_listing.h"

static_assert(PROGRAM_COMMANDS_MAX > 0, "the ring has a place to overwrite");

void program_memory_clear(struct program_memory *memory)
{
    memory->written = 0;
    memory->released = 0;
    for (unsigned label = 0; label <= PROGRAM_LABEL_MAX; label++) {
        memory->label_next[label] = 0;
    }
}

bool program_memory_append(struct program_memory *memory, const struct program_instruction *instruction, bool locked)
{
    bool full = memory->written >= PROGRAM_COMMANDS_MAX;
    if ((full && locked) || memory->written == UINT32_MAX) {
        return false;
    }
    memory->ring[memory->written % PROGRAM_COMMANDS_MAX] = *instruction;
    memory->written++;
    if (instruction->opcode == PROGRAM_LABEL) {
        memory->label_next[instruction->value] = memory->written;
    } else if (instruction->opcode == PROGRAM_RELEASE) {
        memory->released = memory->written;
    }
    return !full;
}

uint32_t program_memory_oldest(const struct program_memory *memory)
{
    return memory->written > PROGRAM_COMMANDS_MAX ? memory->written - PROGRAM_COMMANDS_MAX : 0;
}

const struct program_instruction *program_memory_at(const struct program_memory *memory, uint32_t ordinal)
{
    return &memory->ring[ordinal % PROGRAM_COMMANDS_MAX];
}

/* Where the youngest `@` has been overwritten, all older ones have been too. */
bool program_memory_find_label(const struct program_memory *memory, uint32_t label, uint32_t *ordinal)
{
    uint32_t next = memory->label_next[label];
    if (next <= program_memory_oldest(memory)) {
        return false;
    }
    *ordinal = next - 1U;
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
        length += program_list_instruction(program_memory_at(memory, ordinal), &text[length]);
        ordinal++;
    }
    return length;
}
