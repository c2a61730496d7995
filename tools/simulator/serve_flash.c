/* access: whether there is a file. */
#define _POSIX_C_SOURCE 200809L

#include "serve_flash.h"

#include <string.h>
#include <unistd.h>

#include "base_crc32.h"
#include "infile.h"
#include "outfile.h"

enum {
    MARK_BYTES = 4,
    CRC_BYTES = 4,
    FLASH_BYTES = HAL_FLASH_AREAS * HAL_FLASH_AREA_BYTES,
    IMAGE_BYTES = FLASH_BYTES + MARK_BYTES + CRC_BYTES,
};

static const uint8_t mark[MARK_BYTES] = {'R', 'K', 'M', '4'};

static void put_end(uint8_t end[MARK_BYTES + CRC_BYTES], const uint8_t *flash)
{
    uint32_t crc = crc32_append(0, flash, FLASH_BYTES);
    memcpy(end, mark, sizeof mark);
    for (unsigned i = 0; i < CRC_BYTES; i++) {
        end[MARK_BYTES + i] = (uint8_t)(crc >> (8U * i));
    }
}

/* Null, or what is wrong. */
static const char *judge(const struct infile *file)
{
    uint8_t end[MARK_BYTES + CRC_BYTES];
    if (file->length != IMAGE_BYTES) {
        return "its size is wrong";
    }
    put_end(end, file->bytes);
    return memcmp(end, file->bytes + FLASH_BYTES, sizeof end) == 0 ? NULL : "it is damaged";
}

enum exit_status serve_flash_load(struct host_machine *machine, const char *path)
{
    struct infile file;
    if (access(path, F_OK) != 0) {
        return serve_flash_save(machine, path) ? EXIT_DONE : EXIT_USAGE;
    }
    if (!infile_read(&file, path)) {
        return EXIT_USAGE;
    }
    const char *wrong = judge(&file);
    if (wrong == NULL) {
        memcpy(machine->flash, file.bytes, FLASH_BYTES);
    } else {
        complain("%s: not the flash of a unit (%s); name another file, or remove it to begin with an erased one", path,
                 wrong);
    }
    infile_discard(&file);
    return wrong == NULL ? EXIT_DONE : EXIT_USAGE;
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

bool serve_flash_save(const struct host_machine *machine, const char *path)
{
    struct outfile file;
    uint8_t end[MARK_BYTES + CRC_BYTES];
    if (!outfile_open(&file, path)) {
        return false;
    }
    const uint8_t *flash = (const uint8_t *)machine->flash;
    put_end(end, flash);
    put_bytes(&file, flash, FLASH_BYTES);
    put_bytes(&file, end, sizeof end);
    bool good = outfile_close(&file) && outfile_publish(&file);
    outfile_discard(&file);
    return good;
}
