/* stat: whether a path names a plain file. */
#define _POSIX_C_SOURCE 200809L

#include "outfile.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "complain.h"
#include "replace.h"

enum {
    BUFFER_BYTES = 1 << 18
};

static bool is_special(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && !S_ISREG(status.st_mode);
}

static char *name_part(const char *path)
{
    static const char suffix[] = ".part";
    size_t length = strlen(path);
    char *part = malloc(length + sizeof suffix);
    if (part != NULL) {
        memcpy(part, path, length);
        memcpy(part + length, suffix, sizeof suffix);
    }
    return part;
}

static void complain_of(const struct outfile *file, int error)
{
    complain("%s: cannot be written (%s); name a file in a folder that exists, may be written and has room", file->path,
             strerror(error));
}

bool outfile_open(struct outfile *file, const char *path)
{
    *file = (struct outfile){.path = path};
    if (path == NULL) {
        return true;
    }
    bool special = is_special(path);
    file->part = special ? NULL : name_part(path);
    file->buffer = malloc(BUFFER_BYTES);
    if (file->buffer == NULL || (file->part == NULL && !special)) {
        complain_of(file, ENOMEM);
        outfile_discard(file);
        return false;
    }
    file->stream = fopen(special ? path : file->part, "wb");
    if (file->stream == NULL) {
        complain_of(file, errno);
        free(file->part);
        file->part = NULL; /* it is not ours to remove */
        outfile_discard(file);
        return false;
    }
    (void)setvbuf(file->stream, NULL, _IONBF, 0);
    return true;
}

bool outfile_is_open(const struct outfile *file)
{
    return file->stream != NULL;
}

static void outfile_flush(struct outfile *file)
{
    if (file->error == 0 && fwrite(file->buffer, 1, file->used, file->stream) != file->used) {
        file->error = errno != 0 ? errno : EIO;
    }
    file->used = 0;
}

char *outfile_reserve(struct outfile *file, size_t bytes)
{
    if (file->used + bytes > BUFFER_BYTES) {
        outfile_flush(file);
    }
    return file->buffer + file->used;
}

void outfile_commit(struct outfile *file, const char *end)
{
    file->used = (size_t)(end - file->buffer);
}

bool outfile_close(struct outfile *file)
{
    if (!outfile_is_open(file)) {
        return true;
    }
    outfile_flush(file);
    if (fclose(file->stream) != 0 && file->error == 0) {
        file->error = errno;
    }
    file->stream = NULL;
    if (file->error != 0) {
        complain_of(file, file->error);
    }
    return file->error == 0;
}

bool outfile_publish(struct outfile *file)
{
    if (file->part == NULL) {
        return true;
    }
    if (replace_file(file->part, file->path) != 0) {
        complain_of(file, errno);
        return false;
    }
    free(file->part);
    file->part = NULL;
    return true;
}

void outfile_discard(struct outfile *file)
{
    if (outfile_is_open(file)) {
        (void)fclose(file->stream);
    }
    if (file->part != NULL) {
        (void)remove(file->part);
    }
    free(file->part);
    free(file->buffer);
    *file = (struct outfile){.path = NULL};
}
