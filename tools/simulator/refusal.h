/*
 * What the parser refused, in words for the person who wrote the program.
 */
#ifndef REFUSAL_H
#define REFUSAL_H

#include "problem.h"
#include "source.h"

enum {
    REFUSAL_LISTED_MAX = 1000
};

/* Finds all errors of a text and adds the first thousand; returns how many more there are. What follows from a comment
 * of another language, up to the end of its line, is left out. */
uint32_t refusal_find(const struct source *text, struct problems *problems);

#endif
