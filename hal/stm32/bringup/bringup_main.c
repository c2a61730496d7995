/*
 * The start, and the commands.
 */
#include <stddef.h>

#include "base_tick.h"
#include "bringup.h"
#include "hal_board.h"
#include "hal_line.h"
#include "hal_time.h"

enum {
    VERSION = 4, /* of the commands and answers; bringup/talk.py knows it */
    COMMAND_BYTES_MAX = 8,
    WATCH_MS = 100,
};

/* A command as it comes in. */
struct command {
    uint8_t bytes[COMMAND_BYTES_MAX];
    uint32_t length;
    bool broken; /* a byte of it was, or there are too many */
};

static void say_ready(void)
{
    say_name("ready");
    say_word("bringup-" BRINGUP_BOARD);
    say_decimal(VERSION);
    say_word(BRINGUP_HEADER);
    say_line_end();
}

_Noreturn void bringup_hang(void)
{
    for (;;) {
        __asm__ volatile("wfi");
    }
}

/* Below the stack there is no memory: the processor must notice, and the handler of faults reset the part. */
__attribute__((naked)) _Noreturn void bringup_overflow(void)
{
    __asm__ volatile("1: push {r0-r7}\n\t"
                     "b 1b\n\t");
}

static bool read_number(const struct command *command, uint32_t *number)
{
    *number = 0;
    for (uint32_t i = 1; i < command->length; i++) {
        uint32_t digit = (uint32_t)command->bytes[i] - '0';
        if (digit > 9U) {
            return false;
        }
        *number = *number * 10U + digit;
    }
    return true;
}

static void end_with(void (*last)(void))
{
    say_wait();
    last();
}

/* False: there is no such command. */
static bool tell(char letter)
{
    switch (letter) {
    case 'h':
        say_ready();
        return true;
    case 'p':
        bringup_part_tell();
        return true;
    case 'c':
        bringup_clock_tell();
        bringup_measure_tell_oscillator();
        return true;
    case 'k':
        bringup_clock_tell_now();
        return true;
    case 'v':
        bringup_measure_tell_supply();
        return true;
    case 'i':
        bringup_inputs_tell();
        return true;
    case 'n':
        bringup_inputs_forget();
        return true;
    case 't':
        bringup_cycles_tell();
        return true;
    case 'w':
    case 'g':
        return true;
    default:
        return false;
    }
}

static void finish(char letter)
{
    say_end(letter);
    if (letter == 'w') {
        end_with(bringup_hang);
    } else if (letter == 'g') {
        end_with(bringup_overflow);
    }
}

static void finish_or_refuse(char letter, const char *why)
{
    if (why == NULL) {
        say_end(letter);
    } else {
        say_error(letter, why);
    }
}

static void set(char letter, const struct command *command)
{
    uint32_t number = 0;
    const char *why = "number";
    if (command->length > 1U && read_number(command, &number)) {
        why = letter == 's' ? bringup_capture_tell(number) : bringup_outputs_set(letter, number);
    }
    finish_or_refuse(letter, why);
}

/* The letters of commands that have a number. */
static bool has_number(char letter)
{
    return letter == 'o' || letter == 'e' || letter == 'd' || letter == 'a' || letter == 's';
}

static void obey(const struct command *command)
{
    char letter = (char)command->bytes[0];
    say_begin();
    if (command->broken) {
        say_error('?', "broken");
    } else if (has_number(letter)) {
        set(letter, command);
    } else if (command->length == 1U && letter == 'm') {
        finish_or_refuse(letter, bringup_together_tell());
    } else if (command->length == 1U && tell(letter)) {
        finish(letter);
    } else {
        say_error('?', "command");
    }
}

static void take(struct command *command, const struct hal_line_byte *byte)
{
    bool ends = byte->value == '\n' || byte->value == '\r';
    command->broken = command->broken || byte->broken;
    if (!ends && command->length < (uint32_t)COMMAND_BYTES_MAX) {
        command->bytes[command->length++] = byte->value;
    } else if (!ends) {
        command->broken = true;
    }
    if (ends) {
        if (command->length != 0) {
            obey(command);
        }
        *command = (struct command){.length = 0};
    }
}

static void plan_nothing(void *context)
{
    (void)context;
}

int main(void)
{
    static const struct hal_client client = {
        .lay_isr = bringup_train_lay_isr, .tick_isr = bringup_inputs_isr, .plan_isr = plan_nothing};
    struct command command = {.length = 0};
    struct hal_line_byte byte;
    bringup_part_take_reset();
    bringup_measure_oscillator();
    hal_board_init();
    bringup_capture_start();
    hal_run_start(&client);
    bringup_cycles_start();
    say_ready();
    for (;;) {
        while (hal_line_read(&byte)) {
            take(&command, &byte);
        }
        bringup_outputs_watch();
        hal_board_idle(hal_time_now() + (uint64_t)WATCH_MS * TICKS_PER_MS);
    }
}
