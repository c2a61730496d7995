/* strdup, stat */
#define _DEFAULT_SOURCE

#include "serve_flash.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base_crc32.h"
#include "infile.h"
#include "outfile.h"

enum {
    MARK_BYTES = 4,
    CRC_BYTES = 4,
    FLASH_BYTES = HAL_FLASH_AREAS * HAL_FLASH_AREA_BYTES,
    IMAGE_BYTES = FLASH_BYTES + MARK_BYTES + CRC_BYTES,
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
static bool sync_file(const struct serve_hold *hold, const struct outfile *file)
{
    if (serve_hold_sync(hold, file->part)) {
        return true;
    }
    complain("%s: cannot be brought to the disk (%s); name a file on another one", file->path, strerror(errno));
    return false;
}

static void write_content(struct outfile *file, const struct host_machine *machine, const char *mark)
{
    uint8_t end[MARK_BYTES + CRC_BYTES];
    const uint8_t *flash = (const uint8_t *)machine->flash;
    put_end(end, flash, mark);
    put_bytes(file, flash, FLASH_BYTES);
    put_bytes(file, end, sizeof end);
}

bool serve_flash_save(struct serve_flash *flash, const struct host_machine *machine)
{
    struct outfile file;
    if (!outfile_open(&file, flash->path)) {
        return false;
    }
    serve_hold_next(&flash->hold, file.stream);
    write_content(&file, machine, flash->kind->flash_mark);
    bool good = outfile_close(&file) && sync_file(&flash->hold, &file) && outfile_publish(&file);
    outfile_discard(&file);
    serve_hold_end(&flash->hold, flash->path, good);
    return good;
}

void serve_flash_init(struct serve_flash *flash, const struct serve_kind *kind)
{
    *flash = (struct serve_flash){.kind = kind};
    serve_hold_init(&flash->hold);
}

enum exit_status serve_hold_complain(const char *path, int error)
{
    complain("%s: cannot be opened (%s); name a file in a folder that exists and may be written", path,
             strerror(error));
    return EXIT_USAGE;
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
        return serve_hold_complain(path, ENOMEM);
    }
    enum exit_status held = serve_hold_take(&flash->hold, path, flash->kind->tool);
    if (held != EXIT_DONE) {
        return held;
    }
    bool there = stat(path, &status) == 0;
    if (there && !S_ISREG(status.st_mode)) {
        complain("%s: not a plain file; name another one", path);
        return EXIT_USAGE;
    }
    if (!there || status.st_size == 0) {
        return serve_flash_save(flash, machine) ? EXIT_DONE : EXIT_USAGE;
    }
    return load_file(flash, machine);
}

void serve_flash_close(struct serve_flash *flash)
{
    serve_hold_release(&flash->hold);
    free(flash->path);
    serve_flash_init(flash, flash->kind);
}
