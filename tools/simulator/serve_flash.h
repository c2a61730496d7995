/*
 * The flash of a unit in a file: its bytes, then "RKM4" and their CRC-32, low byte first.
 */
#ifndef SERVE_FLASH_H
#define SERVE_FLASH_H

#include <stdbool.h>

#include "complain.h"
#include "host_machine.h"

/* Reads the file; one that is not there is made, of the flash as it is. EXIT_DONE, or after a complaint EXIT_USAGE. */
enum exit_status serve_flash_load(struct host_machine *machine, const char *path);

/* Writes the file, whole or not at all. False after a complaint. */
bool serve_flash_save(const struct host_machine *machine, const char *path);

#endif
