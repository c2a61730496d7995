/*
 * The program: a 32-bit ARM ELF file with its symbols.
 */
#ifndef IMAGE_H
#define IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "infile.h"
#include "memory.h"

struct image {
    struct infile file;
    uint32_t ram_end[2]; /* where the data of the program ends in SRAM and in CCM; 0: none there */
};

/* Reads the file and puts its segments into the flash (and RAM, if they are to be loaded there). False after a
 * complaint. */
bool image_load(struct image *image, struct memory *memory, const char *path);

/* Puts bytes over a constant, given as SYMBOL=HEXBYTES. False after a complaint. */
bool image_set(const struct image *image, struct memory *memory, const char *text);
void image_discard(struct image *image);

/* A symbol by its name: its value and size. False: there is none. */
bool image_find_symbol(const struct image *image, const char *name, uint32_t *value, uint32_t *bytes);

/* The name of the function that an address lies in, or "?". */
const char *image_function_at(const struct image *image, uint32_t address);

#endif
