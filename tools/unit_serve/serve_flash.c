/* flock, dirname */
#define _DEFAULT_SOURCE

#include "serve_flash.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base_crc32.h"
#include "infile.h"
#include "outfile.h"

enum {
    MARK_BYTES = 4,
    CRC_BYTES = 4,
    FLASH_BYTES = HAL_FLASH_AREAS * HAL_FLASH_AREA_BYTES,
    IMAGE_BYTES = FLASH_BYTES + MARK_BYTES + CRC_BYTES,
    FILE_MODE = 0666, /* less what the umask takes */
};

static void put_end(uint8_t end[MARK_BYTES + CRC_BYTES], const uint8_t *flash, const char *mark)
{
    uint32_t crc = crc32_append(0, flash, FLASH_BYTES);
    memcpy(end, mark, MARK_BYTES);
    for (unsigned i = 0; i < CRC_BYTES; i++) {
        end[MARK_BYTES + i] = (uint8_t)(crc >> (8U * i));
    }
}

/* Null, or what is wrong. */
static const char *judge(const struct infile *file, const char *mark)
{
    uint8_t end[MARK_BYTES + CRC_BYTES];
    if (file->length != IMAGE_BYTES) {
        return "its size is wrong";
    }
    put_end(end, file->bytes, mark);
    if (memcmp(end, file->bytes + FLASH_BYTES, sizeof end) == 0) {
        return NULL;
    }
    bool same_kind = memcmp(end, file->bytes + FLASH_BYTES, MARK_BYTES) == 0;
    return same_kind ? "it is damaged" : "it is damaged, or of another kind of unit";
}

static void put_bytes(struct outfile *file, const uint8_t *bytes, uint32_t length)
{
    for (uint32_t done = 0; done < length;) {
        uint32_t left = length - done;
        uint32_t part = left < OUTFILE_RESERVE_BYTES_MAX ? left : OUTFILE_RESERVE_BYTES_MAX;
        char *at = outfile_reserve(file, part);
        memcpy(at, bytes + done, part);
        outfile_commit(file, at + part);
        done += part;
    }
}

/* False after a complaint. */
static bool sync_file(int fd, const char *path)
{
    if (fsync(fd) == 0) {
        return true;
    }
    complain("%s: cannot be brought to the disk (%s); name a file on another one", path, strerror(errno));
    return false;
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

static void write_content(struct outfile *file, const struct host_machine *machine, const char *mark)
{
    uint8_t end[MARK_BYTES + CRC_BYTES];
    const uint8_t *flash = (const uint8_t *)machine->flash;
    put_end(end, flash, mark);
    put_bytes(file, flash, FLASH_BYTES);
    put_bytes(file, end, sizeof end);
}

/* The new file is locked before it is in place, so that there is no moment without a lock. */
bool serve_flash_save(struct serve_flash *flash, const struct host_machine *machine)
{
    struct outfile file;
    if (!outfile_open(&file, flash->path)) {
        return false;
    }
    int fd = fcntl(fileno(file.stream), F_DUPFD_CLOEXEC, 0);
    (void)flock(fd, LOCK_EX | LOCK_NB);
    write_content(&file, machine, flash->kind->flash_mark);
    bool good = outfile_close(&file) && sync_file(fd, flash->path) && outfile_publish(&file);
    outfile_discard(&file);
    if (good) {
        sync_folder(flash->path);
    }
    int old = good ? flash->fd : fd;
    flash->fd = good ? fd : flash->fd;
    if (old >= 0) {
        (void)close(old);
    }
    return good;
}

void serve_flash_init(struct serve_flash *flash, const struct serve_kind *kind)
{
    *flash = (struct serve_flash){.kind = kind, .fd = -1};
}

static enum exit_status complain_of_open(const char *path, int error)
{
    complain("%s: cannot be opened (%s); name a file in a folder that exists and may be written", path,
             strerror(error));
    return EXIT_USAGE;
}

static bool is_in_place(int fd, const char *path)
{
    struct stat opened;
    struct stat named;
    return fstat(fd, &opened) == 0 && stat(path, &named) == 0 && opened.st_dev == named.st_dev &&
           opened.st_ino == named.st_ino;
}

/* A file that another program has just replaced is locked in vain: then again. */
static enum exit_status lock_file(struct serve_flash *flash)
{
    for (;;) {
        flash->fd = open(flash->path, O_RDONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK, FILE_MODE);
        if (flash->fd < 0) {
            return complain_of_open(flash->path, errno);
        }
        if (flock(flash->fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            complain("%s: another %s serve uses it; end that one, or name another file", flash->path,
                     flash->kind->tool);
            return EXIT_USAGE;
        }
        if (is_in_place(flash->fd, flash->path)) {
            return EXIT_DONE;
        }
        (void)close(flash->fd);
    }
}

static enum exit_status load_file(const struct serve_flash *flash, struct host_machine *machine)
{
    struct infile file;
    if (!infile_read(&file, flash->path)) {
        return EXIT_USAGE;
    }
    const char *wrong = judge(&file, flash->kind->flash_mark);
    if (wrong == NULL) {
        memcpy(machine->flash, file.bytes, FLASH_BYTES);
    } else {
        complain("%s: not the flash of a unit (%s); name another file, or remove it to begin with an erased one",
                 flash->path, wrong);
    }
    infile_discard(&file);
    return wrong == NULL ? EXIT_DONE : EXIT_USAGE;
}

enum exit_status serve_flash_open(struct serve_flash *flash, struct host_machine *machine, const char *path)
{
    struct stat status;
    if (path == NULL) {
        return EXIT_DONE;
    }
    flash->path = strdup(path);
    if (flash->path == NULL) {
        return complain_of_open(path, ENOMEM);
    }
    enum exit_status locked = lock_file(flash);
    if (locked != EXIT_DONE) {
        return locked;
    }
    bool plain = fstat(flash->fd, &status) == 0 && S_ISREG(status.st_mode);
    if (plain && status.st_size == 0) {
        return serve_flash_save(flash, machine) ? EXIT_DONE : EXIT_USAGE;
    }
    if (!plain) {
        complain("%s: not a plain file; name another one", path);
        return EXIT_USAGE;
    }
    return load_file(flash, machine);
}

void serve_flash_close(struct serve_flash *flash)
{
    if (flash->fd >= 0) {
        (void)close(flash->fd);
    }
    free(flash->path);
    serve_flash_init(flash, flash->kind);
}
