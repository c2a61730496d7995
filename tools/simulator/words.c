#include "words.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "program_instruction.h"

static const char *const meanings[PROGRAM_OPCODES] = {
    [PROGRAM_RESET] = "reset",
    [PROGRAM_LABEL] = "label",
    [PROGRAM_ACCELERATION] = "acceleration",
    [PROGRAM_STEPS_BACKWARD] = "steps backward",
    [PROGRAM_CLEAR_OUTPUT] = "clear an output",
    [PROGRAM_FUNCTION_OFF] = "switch a function off",
    [PROGRAM_RESUME] = "resume",
    [PROGRAM_CLEAR_VARIABLE] = "clear a variable",
    [PROGRAM_ZERO_POSITION] = "zero the position",
    [PROGRAM_REVERSE] = "reverse the direction",
    [PROGRAM_LOOP_END] = "end of a loop",
    [PROGRAM_STEPS_FORWARD] = "steps forward",
    [PROGRAM_GO_TO] = "go to a position",
    [PROGRAM_RUN_FORWARD] = "run forward without end",
    [PROGRAM_RUN_BACKWARD] = "run backward without end",
    [PROGRAM_GO_HOME] = "go to position 0",
    [PROGRAM_JUMP_IF_HIGH] = "jump if an input or variable is 1",
    [PROGRAM_JUMP_IF_LOW] = "jump if an input or variable is 0",
    [PROGRAM_JUMP] = "jump to a label",
    [PROGRAM_HALT] = "stop the program",
    [PROGRAM_LOOP] = "start of a loop",
    [PROGRAM_GUARD_HIGH] = "guard the moves by an input that is 1",
    [PROGRAM_GUARD_LOW] = "guard the moves by an input that is 0",
    [PROGRAM_WAIT_INPUT_HIGH] = "wait until an input is 1",
    [PROGRAM_WAIT_VARIABLE_HIGH] = "wait until a variable is 1",
    [PROGRAM_MOVE] = "do the move",
    [PROGRAM_START_SPEED] = "start/stop speed",
    [PROGRAM_SET_OUTPUT] = "set an output",
    [PROGRAM_FUNCTION_ON] = "switch a function on",
    [PROGRAM_SET_VARIABLE] = "set a variable",
    [PROGRAM_GUARDS_OFF] = "cancel the guards",
    [PROGRAM_SPEED] = "maximum speed",
    [PROGRAM_WAIT] = "wait for milliseconds",
    [PROGRAM_APPEND_SECTION] = "append a section to the compound move",
    [PROGRAM_TOTAL_STOP] = "total stop by an input",
    [PROGRAM_WAIT_INPUT_LOW] = "wait until an input is 0",
    [PROGRAM_WAIT_VARIABLE_LOW] = "wait until a variable is 0",
    [PROGRAM_LIMIT_FORWARD] = "run forward to a limit",
    [PROGRAM_LIMIT_BACKWARD] = "run backward to a limit",
    [PROGRAM_SET_POSITION] = "write the position",
    [PROGRAM_CALL] = "call a subroutine",
    [PROGRAM_RETURN] = "end of a subroutine",
    [PROGRAM_HOLD] = "hold the program",
    [PROGRAM_RELEASE] = "release the program",
};

const char *words_meaning(unsigned opcode)
{
    return meanings[opcode];
}

unsigned words_commands_of(uint8_t letter)
{
    unsigned count = 0;
    for (unsigned i = program_opcode_find(0, letter); i < PROGRAM_OPCODES; i = program_opcode_find(i + 1U, letter)) {
        count++;
    }
    return count;
}

/* One of several things that a letter takes. */
static void put_choice(unsigned opcode, char *text, size_t room)
{
    const struct program_row *row = program_opcode_row(opcode);
    if (row->form == PROGRAM_FORM_PLUS || row->form == PROGRAM_FORM_MINUS) {
        (void)snprintf(text, room, "%c (%s)", row->form == PROGRAM_FORM_PLUS ? '+' : '-', meanings[opcode]);
    } else if (row->min == row->max) {
        (void)snprintf(text, room, "%" PRId32 " (%s)", row->min, meanings[opcode]);
    } else {
        (void)snprintf(text, room, "%" PRId32 " to %" PRId32 " (%s)", row->min, row->max, meanings[opcode]);
    }
}

static void put_choices(uint8_t letter, unsigned count, char *text, size_t room)
{
    unsigned opcode = program_opcode_find(0, letter);
    for (unsigned i = 0; i < count; i++) {
        const char *before = i + 1U == count ? " or " : ", ";
        before = i == 0 ? "" : before;
        (void)snprintf(text, room, "%s", before);
        put_choice(opcode, text + strlen(before), room - strlen(before));
        room -= strlen(text);
        text += strlen(text);
        opcode = program_opcode_find(opcode + 1U, letter);
    }
}

void words_put_wanted(uint8_t letter, char *text, size_t room)
{
    const struct program_row *row = program_opcode_row(program_opcode_find(0, letter));
    unsigned count = words_commands_of(letter);
    if (row->form == PROGRAM_FORM_HIGH || row->form == PROGRAM_FORM_LOW) {
        (void)snprintf(text, room,
                       "the number of an input (1 to 8) or variable (80 to 95), H or L, and a label from %" PRId32
                       " to %" PRId32 ", as in I05H10",
                       row->min, row->max);
    } else if (count == 1) {
        (void)snprintf(text, room, "a number from %" PRId32 " to %" PRId32, row->min, row->max);
    } else {
        put_choices(letter, count, text, room);
    }
}
