#define _POSIX_C_SOURCE 200809L

#include "serve_signal.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stddef.h>
#include <string.h>
#include <unistd.h>

#include "complain.h"

/* The one thing that the handler can know. */
static volatile sig_atomic_t wake_fd = -1;

static void on_signal(int number)
{
    int error = errno;
    (void)number;
    (void)!write((int)wake_fd, "", 1);
    errno = error;
}

static void set_handler(int number, void (*handler)(int))
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = handler;
    (void)sigaction(number, &action, NULL);
}

int serve_signal_catch(void)
{
    int ends[2];
    if (pipe(ends) != 0) {
        complain("no pipe can be made (%s); close other programs", strerror(errno));
        return -1;
    }
    wake_fd = ends[1];
    (void)fcntl(ends[1], F_SETFL, O_NONBLOCK);
    set_handler(SIGINT, on_signal);
    set_handler(SIGTERM, on_signal);
    set_handler(SIGHUP, on_signal);
    set_handler(SIGPIPE, SIG_IGN);
    set_handler(SIGTTIN, SIG_IGN);
    return ends[0];
}
