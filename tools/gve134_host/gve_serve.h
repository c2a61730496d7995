/*
 * `gve134-host serve`.
 */
#ifndef GVE_SERVE_H
#define GVE_SERVE_H

#include "complain.h"

/* What `serve --help` prints. */
extern const char gve_serve_usage[];

/* Does what follows `serve` on the command line. */
enum exit_status gve_serve(int count, char *const arguments[]);

#endif
