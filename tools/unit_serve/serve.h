/*
 * `serve`: units on one line, in real time, for whoever connects.
 *
 * One loop: it sleeps until a client, the user or a unit has something to do, lets the units catch up with the clock,
 * gives them what has come, and passes on what they say. Without work it sleeps without end.
 */
#ifndef SERVE_H
#define SERVE_H

#include "complain.h"
#include "serve_kind.h"
#include "serve_options.h"

/* Serves units of a kind until SIGINT, SIGTERM or SIGHUP. */
enum exit_status serve_run(const struct serve_kind *kind, const struct serve_options *options);

#endif
