/*
 * A file that one program alone uses, and that is replaced as a whole: locks and ways to the disk of whatever system
 * this is, posix/ or windows/.
 */
#ifndef SERVE_HOLD_H
#define SERVE_HOLD_H

#include <stdbool.h>
#include <stdio.h>

#include "complain.h"

struct serve_hold {
    int fd;   /* what is locked; -1: nothing */
    int next; /* what is to take its place, locked too; -1: nothing */
};

void serve_hold_init(struct serve_hold *hold);

/* Locks a file. It may have been made for that, and is empty then. EXIT_DONE, or EXIT_USAGE after a complaint, which
 * names the tool that has it. */
enum exit_status serve_hold_take(struct serve_hold *hold, const char *path, const char *tool);

/* Locks the one that is being written, where locks belong to files. */
void serve_hold_next(struct serve_hold *hold, FILE *stream);

/* Brings what has been written, and is closed, to the disk. False: errno. */
bool serve_hold_sync(const struct serve_hold *hold, const char *part);

/* It is in place, or has come to nothing. */
void serve_hold_end(struct serve_hold *hold, const char *path, bool good);

void serve_hold_release(struct serve_hold *hold);

/* Says that a file cannot be opened, and why. EXIT_USAGE. */
enum exit_status serve_hold_complain(const char *path, int error);

#endif
