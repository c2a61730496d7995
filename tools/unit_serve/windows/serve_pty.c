#include "serve_pty.h"

#include <stddef.h>

void serve_pty_init(struct serve_pty *pty)
{
    *pty = (struct serve_pty){.terminal = -1};
}

enum exit_status serve_pty_open(struct serve_pty *pty, const char *link, int *fd)
{
    (void)pty;
    *fd = -1;
    complain("--pty %s: there are no ptys on Windows; use --tcp", link);
    return EXIT_USAGE;
}

void serve_pty_close(struct serve_pty *pty)
{
    (void)pty;
}
