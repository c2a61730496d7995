/*
 * How the run ends, and what is said against the program on the way, with time, place and function of what the
 * processor does.
 */
#ifndef REPORT_H
#define REPORT_H

#include <stdint.h>

#include "clock.h"
#include "image.h"

enum report_end {
    REPORT_RUNS,
    REPORT_TIME,    /* --for is over */
    REPORT_REACHED, /* --end-at was reached */
    REPORT_POWER_CUT,
    REPORT_FAILED, /* the program did what the part does not do, or the model not */
};

enum {
    REPORT_TEXT_BYTES_MAX = 512,
    REPORT_WARNINGS_SHOWN = 20
};

struct report {
    struct clock *clock;
    const struct image *image;
    const uint32_t *at; /* the instruction that runs */
    enum report_end end;
    char text[REPORT_TEXT_BYTES_MAX]; /* of REPORT_FAILED */
    unsigned warnings;
};

/* Ends the run. The first end counts. */
void report_finish(struct report *report, enum report_end end, const char *text);

/* Ends the run because of what the program does at present. */
__attribute__((format(printf, 2, 3))) void report_fail(struct report *report, const char *format, ...);

/* Tells of something that is surely not meant. */
__attribute__((format(printf, 2, 3))) void report_warn(struct report *report, const char *format, ...);

#endif
