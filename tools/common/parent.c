#define _POSIX_C_SOURCE 200809L

#include "parent.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <unistd.h>

void parent_bind(void)
{
    const char *parent = getenv("RKM04_PARENT");
    if (parent == NULL) {
        return;
    }
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
    /* It may have ended before that: then this is the child of another one by now. */
    if (getppid() != (pid_t)strtol(parent, NULL, 10)) {
        _exit(EXIT_FAILURE);
    }
}
