/*
 * The answers that a simulation tells of: those with values, and those that refuse. An answer without either is only
 * counted. Memory: an entry for each, on the heap, up to GVE_TOLD_MAX; more are counted.
 */
#ifndef GVE_TOLD_H
#define GVE_TOLD_H

#include <stdbool.h>
#include <stdint.h>

#include "gve_file.h"

enum {
    GVE_TOLD_MAX = 10000,
    GVE_TOLD_TEXT_BYTES = 72,
};

/* What has come as one answer, up to its CR. */
struct gve_told_text {
    uint64_t tick; /* of its CR */
    uint32_t length;
    char bytes[GVE_TOLD_TEXT_BYTES];
};

struct gve_told_answer {
    struct gve_file_line line; /* that it answers; number 0: none */
    bool wrong;                /* a refusal, or none of an answer's form */
    const char *reason;        /* why a probing ends with it; else null */
    struct gve_told_text text;
};

struct gve_told {
    struct gve_told_answer *list;
    uint32_t count;
    uint32_t more;  /* for which there is no room */
    uint32_t wrong; /* of all of them */
};

struct gve_told gve_told_none(void);
void gve_told_add(struct gve_told *told, const struct gve_told_answer *answer);

/* Prints "answers":[{"line","address","command","ms","answer","refused","reason"},...],"answers_more":0,"refused":0 */
void gve_told_print(const struct gve_told *told);

void gve_told_discard(struct gve_told *told);

#endif
