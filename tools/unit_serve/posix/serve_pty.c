/* Ptys. */
#define _GNU_SOURCE

#include "serve_pty.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

#define PTY_FOLDER "/dev/pts/"

void serve_pty_init(struct serve_pty *pty)
{
    *pty = (struct serve_pty){.terminal = -1};
}

static void never_wait(int fd)
{
    (void)fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) | O_NONBLOCK);
    (void)fcntl(fd, F_SETFD, FD_CLOEXEC);
}

/* Both sides of a pty that passes every byte as it is. */
static bool open_sides(struct serve_pty *pty, int *fd)
{
    struct termios settings;
    *fd = posix_openpt(O_RDWR | O_NOCTTY);
    if (*fd < 0 || grantpt(*fd) != 0 || unlockpt(*fd) != 0 || ptsname_r(*fd, pty->device, sizeof pty->device) != 0) {
        return false;
    }
    never_wait(*fd);
    pty->terminal = open(pty->device, O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (pty->terminal < 0 || tcgetattr(pty->terminal, &settings) != 0) {
        return false;
    }
    cfmakeraw(&settings);
    return tcsetattr(pty->terminal, TCSANOW, &settings) == 0;
}

/* Whether a path is a link to a pty that is no more, or to this one by chance: its number is free again. */
static bool is_stale(const char *path, const char *device)
{
    char target[SERVE_DEVICE_BYTES];
    ssize_t length = readlink(path, target, sizeof target - 1U);
    if (length < 0) {
        return false;
    }
    target[length] = '\0';
    return strncmp(target, PTY_FOLDER, strlen(PTY_FOLDER)) == 0 &&
           (strcmp(target, device) == 0 || access(target, F_OK) != 0);
}

static bool leads_here(const struct serve_pty *pty)
{
    char target[SERVE_DEVICE_BYTES];
    ssize_t length = readlink(pty->link, target, sizeof target - 1U);
    return length > 0 && (size_t)length == strlen(pty->device) && memcmp(target, pty->device, (size_t)length) == 0;
}

enum exit_status serve_pty_open(struct serve_pty *pty, const char *link, int *fd)
{
    if (!open_sides(pty, fd)) {
        complain("--pty %s: no pty can be made (%s); end other programs, or use --tcp", link, strerror(errno));
        return EXIT_CONNECTION;
    }
    if (is_stale(link, pty->device)) {
        (void)unlink(link);
    }
    if (symlink(pty->device, link) != 0) {
        bool taken = errno == EEXIST; /* as a TCP port can be; else the path is no place for any file */
        const char *advice = taken ? "remove it if no other program uses it, or name another path"
                                   : "name a path in a folder that exists and may be written";
        complain("--pty %s: the link cannot be made (%s); %s", link, strerror(errno), advice);
        return taken ? EXIT_CONNECTION : EXIT_USAGE;
    }
    pty->link = link;
    return EXIT_DONE;
}

void serve_pty_close(struct serve_pty *pty)
{
    if (pty->link != NULL && leads_here(pty)) {
        (void)unlink(pty->link);
    }
    if (pty->terminal >= 0) {
        (void)close(pty->terminal);
    }
    serve_pty_init(pty);
}
