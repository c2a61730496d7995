/*
 * Warnings: what the unit accepts and runs, but what is surely not meant.
 *
 * Each rule looks at the commands after the last reset. What depends on the course of the program is judged by its
 * flow; what a rule cannot know for sure it leaves alone.
 */
#ifndef LINT_H
#define LINT_H

#include "flow.h"
#include "listing.h"
#include "problem.h"

/* Adds all warnings about a program that has no errors. */
void lint_find(const struct listing *listing, struct problems *problems);

/* The rules that follow paths through the program. */
void lint_find_paths(const struct flow *flow, struct problems *problems);

/* The rule about compound moves. */
void lint_find_compounds(const struct flow *flow, struct problems *problems);

/* Adds a warning about a command: its text, and then these words. */
void lint_add(struct problems *problems, const struct listing_command *command, const char *rule, const char *words);

#endif
