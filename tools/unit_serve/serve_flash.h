/*
 * The flash of a unit in a file: its bytes, then four characters that name the kind of unit and the CRC-32 of the
 * bytes, low byte first.
 *
 * Whenever the program ends, by a kill or with the machine's power too, the file has the old bytes or the new ones:
 * they are written beside it, brought to the disk, and put in its place. The file that is in place is locked, so
 * that no other program of this kind uses it.
 */
#ifndef SERVE_FLASH_H
#define SERVE_FLASH_H

#include <stdbool.h>

#include "complain.h"
#include "host_machine.h"
#include "serve_hold.h"
#include "serve_kind.h"

struct serve_flash {
    const struct serve_kind *kind;
    char *path;             /* null: no file */
    struct serve_hold hold; /* of the file that is in place */
};

/* No file. */
void serve_flash_init(struct serve_flash *flash, const struct serve_kind *kind);

/* Locks the file and reads it (a null path: no file); one that is not there, or empty, is made of the flash as it is.
 * EXIT_DONE, or after a complaint what else. */
enum exit_status serve_flash_open(struct serve_flash *flash, struct host_machine *machine, const char *path);

/* Writes the file, whole or not at all. False after a complaint. */
bool serve_flash_save(struct serve_flash *flash, const struct host_machine *machine);

/* Unlocks it. */
void serve_flash_close(struct serve_flash *flash);

#endif
