/*
 * The commands in words: what each does, and what may stand after its letter. Letters, forms and ranges come from the
 * firmware's own table; only the words are here.
 */
#ifndef WORDS_H
#define WORDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What the command does, in two or three words. */
const char *words_meaning(unsigned opcode);

/* How many commands have this letter. */
unsigned words_commands_of(uint8_t letter);

/* Writes what must follow the letter, which has a command, as text with a terminator. */
void words_put_wanted(uint8_t letter, char *text, size_t room);

#endif
