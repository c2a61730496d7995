/*
 * For mutators: a command of the table, written into an input.
 */
#ifndef FUZZ_COMMANDS_H
#define FUZZ_COMMANDS_H

#include <stddef.h>
#include <stdint.h>

/* Puts one command somewhere after the first `head` bytes, with a number at an end of its range, in between or just
 * beyond. Returns the new size; the same if there is no room. */
size_t fuzz_insert_command(uint8_t *data, size_t size, size_t max_size, size_t head, unsigned seed);

#endif
