/*
 * `check`: what the unit would refuse of a vector file, as one JSON object.
 */
#ifndef GVE_CHECK_H
#define GVE_CHECK_H

#include "complain.h"

/* Checks a file; `-` is standard input. */
enum exit_status gve_check_file(const char *path);

/* Prints the table of the commands. */
enum exit_status gve_check_commands(void);

#endif
