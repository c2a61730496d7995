/*
 * gve134-host: the language of the GVE134 unit as its firmware reads it, for tools/gve134 and for tests. Subcommands
 * check and commands; answers are JSON on standard output, complaints one line on standard error (complain.h).
 */
#include <string.h>

#include "complain.h"
#include "gve_check.h"
#include "parent.h"

int main(int argc, char *argv[])
{
    parent_bind();
    complain_as(argc > 0 ? argv[0] : "gve134-host");
    if (argc == 3 && strcmp(argv[1], "check") == 0) {
        return (int)gve_check_file(argv[2]);
    }
    if (argc == 2 && strcmp(argv[1], "commands") == 0) {
        return (int)gve_check_commands();
    }
    complain("write gve134-host check FILE (- is standard input) or gve134-host commands");
    return EXIT_USAGE;
}
