/* A file that is open cannot be replaced here: what is locked is one beside it, which goes when it is closed. */
#include "serve_hold.h"

#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <windows.h>

#define SUFFIX ".lock"

void serve_hold_init(struct serve_hold *hold)
{
    *hold = (struct serve_hold){.fd = -1, .next = -1};
}

enum exit_status serve_hold_take(struct serve_hold *hold, const char *path, const char *tool)
{
    char name[MAX_PATH];
    int length = snprintf(name, sizeof name, "%s" SUFFIX, path);
    if (length < 0 || (size_t)length >= sizeof name) {
        return serve_hold_complain(path, ENAMETOOLONG);
    }
    HANDLE file = CreateFileA(name, GENERIC_WRITE, 0, NULL, OPEN_ALWAYS, FILE_FLAG_DELETE_ON_CLOSE, NULL);
    if (file == INVALID_HANDLE_VALUE) {
        if (GetLastError() != ERROR_SHARING_VIOLATION) {
            return serve_hold_complain(path, ENOENT);
        }
        complain("%s: another %s serve uses it; end that one, or name another file", path, tool);
        return EXIT_USAGE;
    }
    hold->fd = _open_osfhandle((intptr_t)file, _O_BINARY);
    return EXIT_DONE;
}

void serve_hold_next(struct serve_hold *hold, FILE *stream)
{
    (void)hold;
    (void)stream;
}

bool serve_hold_sync(const struct serve_hold *hold, const char *part)
{
    (void)hold;
    int fd = _open(part, _O_RDWR | _O_BINARY);
    bool good = fd >= 0 && _commit(fd) == 0;
    if (fd >= 0) {
        (void)_close(fd);
    }
    return good;
}

void serve_hold_end(struct serve_hold *hold, const char *path, bool good)
{
    (void)hold;
    (void)path;
    (void)good;
}

void serve_hold_release(struct serve_hold *hold)
{
    if (hold->fd >= 0) {
        (void)_close(hold->fd);
    }
    serve_hold_init(hold);
}
