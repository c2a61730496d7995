#include "commands.h"

#include <stdio.h>
#include <string.h>

#include "parent.h"

bool commands_is_help(const char *argument)
{
    return strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0;
}

enum exit_status commands_print(const char *text)
{
    (void)fputs(text, stdout);
    return finish_output();
}

static enum exit_status run(const struct commands *commands, const char *name, int count, char *const arguments[])
{
    for (size_t i = 0; i < commands->count; i++) {
        const struct command *command = &commands->list[i];
        if (strcmp(name, command->name) == 0 && count >= command->least && count <= command->most) {
            return command->run(count, arguments);
        }
    }
    if (commands_is_help(name)) {
        return commands_print(commands->usage);
    }
    complain("%s", commands->hint);
    return EXIT_USAGE;
}

int commands_main(const struct commands *commands, int argc, char *argv[])
{
    parent_bind();
    complain_as(argc > 0 ? argv[0] : commands->program);
    return (int)run(commands, argc > 1 ? argv[1] : "", argc - 2, argv + 2);
}
