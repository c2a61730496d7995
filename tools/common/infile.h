/*
 * An input file as a whole in memory.
 */
#ifndef INFILE_H
#define INFILE_H

#include <stdbool.h>
#include <stdint.h>

struct infile {
    const char *path;
    uint8_t *bytes;  /* one byte of 0 follows the last */
    uint32_t length; /* bytes */
};

/* Reads a file, `-` is standard input. False after a complaint. */
bool infile_read(struct infile *file, const char *path);

/* The same without a byte order mark (UTF-8), and without an end of file of DOS and blanks after the last line. */
bool infile_read_text(struct infile *file, const char *path);

/* The line, from 1, of the byte at an offset, and its column, from 1. */
uint32_t infile_line(const struct infile *file, uint32_t offset);
uint32_t infile_column(const struct infile *file, uint32_t offset);

void infile_discard(struct infile *file);

#endif
