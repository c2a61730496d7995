/*
 * The subcommands of a program: NAME [ARGUMENT ...].
 */
#ifndef COMMANDS_H
#define COMMANDS_H

#include <stdbool.h>
#include <stddef.h>

#include "complain.h"

struct command {
    const char *name;
    int least; /* arguments after it */
    int most;
    enum exit_status (*run)(int count, char *const arguments[]);
};

struct commands {
    const char *program; /* where the system does not tell it */
    const char *usage;   /* what --help prints */
    const char *hint;    /* what a wrong call is told to write */
    const struct command *list;
    size_t count;
};

/* Whether an argument asks for help. */
bool commands_is_help(const char *argument);

enum exit_status commands_print(const char *text);

/* What main does: binds the program to its parent, and runs the command that is named. */
int commands_main(const struct commands *commands, int argc, char *argv[]);

#endif
