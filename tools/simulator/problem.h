/*
 * What there is to say about a program: errors and warnings, each with the character that it is about.
 */
#ifndef PROBLEM_H
#define PROBLEM_H

#include <stdbool.h>
#include <stdint.h>

struct problem {
    uint32_t offset;
    uint32_t order;   /* of its finding */
    unsigned flag;    /* the unit's, 1 or 2; 0: a warning */
    const char *rule; /* a short name */
    char *message;
};

struct problems {
    struct problem *list;
    uint32_t count;
    uint32_t room;
    bool is_short; /* of memory: something is missing */
};

/* Appends one; the format is printf's. */
__attribute__((format(printf, 5, 6))) void problems_add(struct problems *problems, uint32_t offset, unsigned flag,
                                                        const char *rule, const char *format, ...);

/* In the order of the text; those of one character as they were found. */
void problems_sort(struct problems *problems);

void problems_discard(struct problems *problems);

#endif
