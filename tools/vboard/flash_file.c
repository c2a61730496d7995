#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "complain.h"
#include "flash.h"
#include "outfile.h"

bool flash_load(struct flash *flash, const char *path)
{
    FILE *file = path == NULL ? NULL : fopen(path, "rb");
    if (path == NULL || (file == NULL && errno == ENOENT)) {
        return true;
    }
    bool good = file != NULL && fread(flash->wires.memory->flash, 1, MEMORY_FLASH_BYTES, file) == MEMORY_FLASH_BYTES &&
                fgetc(file) == EOF;
    if (file != NULL) {
        (void)fclose(file);
    }
    if (!good) {
        complain("%s: not the content of a flash of %u bytes; delete it to begin with an erased one", path,
                 (unsigned)MEMORY_FLASH_BYTES);
    }
    return good;
}

bool flash_save(struct flash *flash, const char *path)
{
    struct outfile file;
    stale_look_through_cache(&flash->stale, flash->wires.memory->flash, false);
    if (!outfile_open(&file, path)) {
        return false;
    }
    for (uint32_t at = 0; outfile_is_open(&file) && at < MEMORY_FLASH_BYTES; at += OUTFILE_RESERVE_BYTES_MAX) {
        char *room = outfile_reserve(&file, OUTFILE_RESERVE_BYTES_MAX);
        memcpy(room, flash->wires.memory->flash + at, OUTFILE_RESERVE_BYTES_MAX);
        outfile_commit(&file, room + OUTFILE_RESERVE_BYTES_MAX);
    }
    bool good = outfile_close(&file) && outfile_publish(&file);
    outfile_discard(&file);
    return good;
}
