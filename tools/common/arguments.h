/*
 * A command line of options, each with its value after it or without one, read by a table into a struct of the caller.
 * What is wrong is complained of in one line.
 */
#ifndef ARGUMENTS_H
#define ARGUMENTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "complain.h"

/* Reads a value into the caller's struct. False after a complaint. */
typedef bool argument_reader(void *options, const char *value);

enum argument_kind {
    ARGUMENT_TEXT,   /* into a const char * */
    ARGUMENT_FLAG,   /* without a value: into a bool */
    ARGUMENT_NUMBER, /* into a uint64_t */
    ARGUMENT_OTHER,  /* by a reader */
};

/* A number with up to so many decimals, in units of the last of them. */
struct argument_number {
    unsigned decimals;
    uint64_t least;
    uint64_t most;   /* up to 10^18 */
    uint64_t factor; /* what one unit is in the member */
};

struct argument {
    const char *name;
    enum argument_kind kind;
    size_t offset; /* of the member, but for ARGUMENT_OTHER */
    struct argument_number number;
    argument_reader *read;
};

/* Rows of a table; `type` is the caller's struct without the word struct. */
#define ARGUMENT_TEXT_ROW(type, option, member)                                                                        \
    {.name = (option), .kind = ARGUMENT_TEXT, .offset = offsetof(struct type, member)}
#define ARGUMENT_FLAG_ROW(type, option, member)                                                                        \
    {.name = (option), .kind = ARGUMENT_FLAG, .offset = offsetof(struct type, member)}
#define ARGUMENT_OTHER_ROW(option, reader) {.name = (option), .kind = ARGUMENT_OTHER, .read = (reader)}

struct argument_table {
    const struct argument *rows;
    size_t count;
    /* What is said, after the option's name, of one that the table does not have, and of a value that is missing. */
    const char *unknown;
    const char *missing;
    bool takes_empty; /* an empty value is a value, which its reader may refuse; else it is missing */
};

/* EXIT_DONE, or EXIT_USAGE after a complaint. */
enum exit_status arguments_read(const struct argument_table *table, void *options, int count, char *const arguments[]);

/* Reads a number that is all of a text. False: it is none, or out of its range. */
bool arguments_read_number(const char *text, struct argument_number range, uint64_t *number);

#endif
