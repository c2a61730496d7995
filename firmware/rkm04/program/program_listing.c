#include "program_listing.h"

#include "base_text.h"

enum {
    TWO_DIGITS_FROM = 10
};

static void list_io(struct text *text, int32_t number)
{
    if (number < TWO_DIGITS_FROM) {
        text_put_byte(text, '0');
    }
    text_put_signed(text, number, 0);
}

static void list_condition(struct text *text, const struct program_instruction *instruction, uint8_t level)
{
    list_io(text, instruction->io);
    text_put_byte(text, level);
    text_put_signed(text, instruction->value, 0);
}

static void list_value(struct text *text, const struct program_instruction *instruction, enum program_form form)
{
    switch (form) {
    case PROGRAM_FORM_NUMBER:
    case PROGRAM_FORM_SIGNED:
        text_put_signed(text, instruction->value, 0);
        break;
    case PROGRAM_FORM_IO:
        list_io(text, instruction->value);
        break;
    case PROGRAM_FORM_PLUS:
        text_put_byte(text, '+');
        break;
    case PROGRAM_FORM_MINUS:
        text_put_byte(text, '-');
        break;
    case PROGRAM_FORM_HIGH:
        list_condition(text, instruction, 'H');
        break;
    case PROGRAM_FORM_LOW:
        list_condition(text, instruction, 'L');
        break;
    case PROGRAM_FORM_NONE:
    default:
        break;
    }
}

uint32_t program_list_instruction(const struct program_instruction *instruction,
                                  uint8_t text[PROGRAM_COMMAND_BYTES_MAX])
{
    const struct program_row *row = program_opcode_row(instruction->opcode);
    struct text command;
    text_init(&command, text, PROGRAM_COMMAND_BYTES_MAX);
    text_put_byte(&command, row->letter);
    list_value(&command, instruction, (enum program_form)row->form);
    return command.length;
}
