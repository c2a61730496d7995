/*
 * rkm04-host: the unit's firmware on the host backend, for tools/rkm04 and for tests. Subcommands sim, serve, check,
 * opcodes and bench; answers are JSON on standard output, complaints one line on standard error (complain.h).
 */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "bench.h"
#include "check.h"
#include "complain.h"
#include "opcodes.h"
#include "options.h"
#include "parent.h"
#include "rkm04_serve.h"
#include "sim.h"

static enum exit_status command_sim(int count, char *const arguments[])
{
    struct options options;
    enum exit_status status = options_read(&options, count, arguments);
    return status == EXIT_DONE ? sim_run(&options) : status;
}

static bool is_help(const char *argument)
{
    return strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0;
}

static enum exit_status print_text(const char *text)
{
    (void)fputs(text, stdout);
    return finish_output();
}

static enum exit_status command_serve(int count, char *const arguments[])
{
    if (count == 1 && is_help(arguments[0])) {
        return print_text(rkm04_serve_usage);
    }
    return rkm04_serve(count, arguments);
}

static enum exit_status command_check(int count, char *const arguments[])
{
    if (count != 1) {
        complain("check wants one file (- is standard input); write rkm04-host check FILE");
        return EXIT_USAGE;
    }
    return check_file(arguments[0]);
}

static enum exit_status command_alone(const char *name, int count, enum exit_status (*command)(void))
{
    if (count != 0) {
        complain("%s wants nothing after it; write rkm04-host %s", name, name);
        return EXIT_USAGE;
    }
    return command();
}

static enum exit_status run_command(const char *name, int count, char *const arguments[])
{
    if (strcmp(name, "sim") == 0) {
        return command_sim(count, arguments);
    }
    if (strcmp(name, "serve") == 0) {
        return command_serve(count, arguments);
    }
    if (strcmp(name, "check") == 0) {
        return command_check(count, arguments);
    }
    if (strcmp(name, "opcodes") == 0) {
        return command_alone(name, count, opcodes_print);
    }
    if (strcmp(name, "bench") == 0) {
        return command_alone(name, count, bench_print);
    }
    if (is_help(name)) {
        return print_text(options_usage);
    }
    complain("'%s' is no subcommand; write sim, serve, check, opcodes, bench or --help", name);
    return EXIT_USAGE;
}

int main(int argc, char *argv[])
{
    parent_bind();
    complain_as(argc > 0 ? argv[0] : "rkm04-host");
    if (argc < 2) {
        complain("nothing to do; write sim, serve, check, opcodes, bench or --help");
        return EXIT_USAGE;
    }
    return (int)run_command(argv[1], argc - 2, argv + 2);
}
