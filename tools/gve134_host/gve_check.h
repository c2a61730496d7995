/*
 * `check`: what the unit would refuse of a vector file, as one JSON object.
 */
#ifndef GVE_CHECK_H
#define GVE_CHECK_H

#include <stdbool.h>

#include "complain.h"
#include "infile.h"

/* Checks a file; `-` is standard input. */
enum exit_status gve_check_file(const char *path);

/* Whether a file that has been read is without errors. False after a complaint about the first one. */
bool gve_check_is_good(const struct infile *file);

/* Prints the table of the commands. */
enum exit_status gve_check_commands(void);

#endif
