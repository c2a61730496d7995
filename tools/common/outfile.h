/*
 * An output file that is there whole or not at all: it grows as FILE.part and gets its name when everything has been
 * written. A device, a pipe or whatever else is no plain file is written directly.
 *
 * Errors of writing are kept and told when the file is closed. Memory: one buffer, while the file is open. All
 * functions do nothing with a file that was not opened.
 */
#ifndef OUTFILE_H
#define OUTFILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* The most that may be reserved at a time. */
enum {
    OUTFILE_RESERVE_BYTES_MAX = 4096
};

struct outfile {
    const char *path; /* null: not opened */
    char *part;       /* what it is called while it grows; null: written directly */
    FILE *stream;
    char *buffer;
    size_t used;
    int error; /* errno of the first write that failed; 0: none */
};

/* Opens a file; a null path leaves it not opened, which is no error. False after a complaint. */
bool outfile_open(struct outfile *file, const char *path);

bool outfile_is_open(const struct outfile *file);

/* Room for at least `bytes` more; what has been written there counts once outfile_commit gets its end. */
char *outfile_reserve(struct outfile *file, size_t bytes);
void outfile_commit(struct outfile *file, const char *end);

/* Writes what is left and closes. False after a complaint if anything was not written. */
bool outfile_close(struct outfile *file);

/* Gives a closed file its name. False after a complaint. */
bool outfile_publish(struct outfile *file);

/* Lets go of everything; a file that has not been published vanishes. */
void outfile_discard(struct outfile *file);

#endif
