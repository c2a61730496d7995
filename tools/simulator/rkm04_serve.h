/*
 * `rkm04-host serve`.
 */
#ifndef RKM04_SERVE_H
#define RKM04_SERVE_H

#include "complain.h"

/* What `serve --help` prints. */
extern const char rkm04_serve_usage[];

/* Does what follows `serve` on the command line. */
enum exit_status rkm04_serve(int count, char *const arguments[]);

#endif
