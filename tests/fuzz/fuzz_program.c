/*
 * Program text to instructions and back: what the parser takes, the listing tells in a way that the parser takes for
 * the same, and what it refuses it refuses at one place, with one flag.
 *
 * Input: the text. The mutator writes commands of the table into it.
 */
#include <string.h>

#include "fuzz_commands.h"
#include "fuzz_stream.h"
#include "program_listing.h"
#include "program_memory.h"
#include "program_parser.h"

enum {
    TEXT_MAX = 8190,
    LIST_MAX = TEXT_MAX * 2
};

struct bench {
    struct program_memory memory;
    struct program_memory again;
    uint8_t list[LIST_MAX];
    uint8_t list_again[LIST_MAX];
};

static bool is_same(const struct program_instruction *a, const struct program_instruction *b)
{
    return a->opcode == b->opcode && a->value == b->value && a->io == b->io;
}

static bool io_is_good(unsigned io)
{
    return (io >= 1 && io <= 8) || (io >= 80 && io <= 95);
}

/* An instruction is one of the table, its numbers in range. */
static void require_good(const struct program_instruction *instruction)
{
    FUZZ_REQUIRE(instruction->opcode < PROGRAM_OPCODES);
    const struct program_row *row = program_opcode_row(instruction->opcode);
    bool conditional = row->form == PROGRAM_FORM_HIGH || row->form == PROGRAM_FORM_LOW;
    FUZZ_REQUIRE(instruction->value >= row->min && instruction->value <= row->max);
    FUZZ_REQUIRE(conditional ? io_is_good(instruction->io) : instruction->io == 0);
}

/* The text of one instruction is read as this instruction, and as nothing else. */
static uint32_t list_one(const struct program_instruction *instruction, uint8_t *text)
{
    uint32_t length = program_list_instruction(instruction, text);
    FUZZ_REQUIRE(length >= 1 && length <= PROGRAM_COMMAND_BYTES_MAX);
    struct program_summary summary = program_check(text, length);
    FUZZ_REQUIRE(summary.status == PROGRAM_OK && summary.commands == 1);
    FUZZ_REQUIRE(is_same(&summary.first, instruction));
    return length;
}

/* Goes through the whole text, errors too. Lists what is good before the first error; the place of that in *place. */
static uint32_t list_text(const uint8_t *text, uint32_t length, uint8_t *list, enum program_status *first,
                          uint32_t *place, uint32_t *commands)
{
    struct program_parser parser;
    struct program_instruction instruction;
    uint32_t end = 0;
    uint32_t last_next = 0;
    *first = PROGRAM_OK;
    *commands = 0;
    program_parser_init(&parser, text, length);
    for (;;) {
        enum program_status status = program_parser_next(&parser, &instruction);
        FUZZ_REQUIRE(parser.next <= length && parser.place <= parser.next && parser.place >= last_next);
        if (status == PROGRAM_END) {
            return end;
        }
        FUZZ_REQUIRE(parser.next > last_next);
        last_next = parser.next;
        if (status == PROGRAM_OK) {
            require_good(&instruction);
        } else if (*first == PROGRAM_OK) {
            *first = status;
            *place = parser.place;
        }
        if (*first == PROGRAM_OK) {
            end += list_one(&instruction, list + end);
            (*commands)++;
        }
    }
}

/* What a unit keeps of a text, and lists. */
static uint32_t store_text(struct program_memory *memory, const uint8_t *text, uint32_t length, uint8_t *list)
{
    struct program_parser parser;
    struct program_instruction instruction;
    program_memory_clear(memory);
    program_parser_init(&parser, text, length);
    while (program_parser_next(&parser, &instruction) == PROGRAM_OK) {
        (void)program_memory_append(memory, &instruction, false);
        FUZZ_REQUIRE(memory->written - program_memory_oldest(memory) <= PROGRAM_COMMANDS_MAX);
    }
    return program_memory_list(memory, list, LIST_MAX);
}

/* A good text, by way of program memory, and the same once more. */
static void check_memory(struct bench *bench, const uint8_t *text, uint32_t length)
{
    uint32_t kept = store_text(&bench->memory, text, length, bench->list);
    uint32_t again = store_text(&bench->again, bench->list, kept, bench->list_again);
    FUZZ_REQUIRE(kept == again && memcmp(bench->list, bench->list_again, kept) == 0);
    uint32_t oldest = program_memory_oldest(&bench->memory);
    FUZZ_REQUIRE(bench->again.written == bench->memory.written - oldest);
    for (uint32_t i = 0; i < bench->again.written; i++) {
        struct program_instruction a = program_memory_at(&bench->memory, oldest + i);
        struct program_instruction b = program_memory_at(&bench->again, i);
        FUZZ_REQUIRE(is_same(&a, &b));
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct bench bench;
    if (size > TEXT_MAX) {
        return -1;
    }
    uint32_t length = (uint32_t)size;
    uint32_t place = 0;
    uint32_t commands = 0;
    enum program_status first = PROGRAM_OK;
    struct program_summary summary = program_check(data, length);
    uint32_t listed = list_text(data, length, bench.list, &first, &place, &commands);
    FUZZ_REQUIRE(summary.status == first && summary.commands == commands);
    FUZZ_REQUIRE(summary.character == (first == PROGRAM_OK ? 0 : data[place]));
    struct program_summary back = program_check(bench.list, listed);
    FUZZ_REQUIRE(back.status == PROGRAM_OK && back.commands == commands);
    if (first == PROGRAM_OK) {
        check_memory(&bench, data, length);
    } else {
        /* What stands before the place of the error is good. */
        struct program_summary before = program_check(data, place);
        FUZZ_REQUIRE(before.status == PROGRAM_OK && before.commands == commands);
    }
    return 0;
}

/* One time in two, puts a command of the table somewhere. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed)
{
    size = LLVMFuzzerMutate(data, size, max_size);
    return seed % 2U == 0 ? size : fuzz_insert_command(data, size, max_size, 0, seed / 2U);
}
