/* flock, dirname */
#define _DEFAULT_SOURCE

#include "serve_hold.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    FILE_MODE = 0666, /* less what the umask takes */
};

void serve_hold_init(struct serve_hold *hold)
{
    *hold = (struct serve_hold){.fd = -1, .next = -1};
}

static bool is_in_place(int fd, const char *path)
{
    struct stat opened;
    struct stat named;
    return fstat(fd, &opened) == 0 && stat(path, &named) == 0 && opened.st_dev == named.st_dev &&
           opened.st_ino == named.st_ino;
}

/* A file that another program has just replaced is locked in vain: then again. */
enum exit_status serve_hold_take(struct serve_hold *hold, const char *path, const char *tool)
{
    for (;;) {
        hold->fd = open(path, O_RDONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK, FILE_MODE);
        if (hold->fd < 0) {
            return serve_hold_complain(path, errno);
        }
        if (flock(hold->fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            complain("%s: another %s serve uses it; end that one, or name another file", path, tool);
            return EXIT_USAGE;
        }
        if (is_in_place(hold->fd, path)) {
            return EXIT_DONE;
        }
        (void)close(hold->fd);
    }
}

/* Before it is in place, so that there is no moment without a lock. */
void serve_hold_next(struct serve_hold *hold, FILE *stream)
{
    hold->next = fcntl(fileno(stream), F_DUPFD_CLOEXEC, 0);
    (void)flock(hold->next, LOCK_EX | LOCK_NB);
}

bool serve_hold_sync(const struct serve_hold *hold, const char *part)
{
    (void)part;
    return fsync(hold->next) == 0;
}

/* Brings a new name in a folder to the disk. */
static void sync_folder(const char *path)
{
    char *copy = strdup(path);
    int fd = copy == NULL ? -1 : open(dirname(copy), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd >= 0) {
        (void)fsync(fd);
        (void)close(fd);
    }
    free(copy);
}

void serve_hold_end(struct serve_hold *hold, const char *path, bool good)
{
    int old = good ? hold->fd : hold->next;
    if (good) {
        sync_folder(path);
        hold->fd = hold->next;
    }
    if (old >= 0) {
        (void)close(old);
    }
    hold->next = -1;
}

void serve_hold_release(struct serve_hold *hold)
{
    if (hold->fd >= 0) {
        (void)close(hold->fd);
    }
    serve_hold_init(hold);
}
