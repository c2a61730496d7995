/*
 * `positioning-host serve`.
 */
#ifndef POS_SERVE_H
#define POS_SERVE_H

#include "complain.h"

/* What `serve --help` prints. */
extern const char pos_serve_usage[];

/* Does what follows `serve` on the command line. */
enum exit_status pos_serve(int count, char *const arguments[]);

#endif
